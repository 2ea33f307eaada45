#pragma once

#include <cstddef>
#include <span>

namespace clothbrdf {

/// The correction of a node value at which linear interpolation between nodes has the least squared
/// error, rather than none at the nodes (to second order): -(h1^2 - h1 h2 + h2^2) / 12 times the
/// second derivative. No correction next to values of 0, where directions go below the horizon; at
/// most a twentieth of the value.
///
/// h_before, h_after: distances of the neighbours; any unit.
float prefiltered(float before, float value, float after, double h_before, double h_after);

/// Applies it along the rows (periodic, first and last row the same) and the columns of a slice,
/// values[row][column], square.
void prefilter_slice(std::span<float> values, std::size_t side);

/// Applies it between slices at the nodes theta, values[theta][...]; the first and last stay.
void prefilter_between(std::span<float> values, std::span<const float> theta);

}  // namespace clothbrdf
