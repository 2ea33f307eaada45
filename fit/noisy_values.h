#pragma once

#include <cstdint>

#include "fit/options.h"
#include "fit/rows.h"

namespace clothbrdf {

/// The values of a table that would be measured of a material: what the model says at the samples
/// above the horizon (and valid ones, where `valid` is not empty: a flag a cell), with independent
/// Gaussian noise of the weighting's kind: relative, absolute, or of the logarithm. Not clipped.
/// The same bits for the same seed on every platform with the same mathematical library. Holds
/// references.
ValueSource measured_values(const Observations& observations, const TableSpec& spec,
                            const std::vector<unsigned char>& valid, const ModelValues& model,
                            Weighting weighting, double noise, std::uint64_t seed);

}  // namespace clothbrdf
