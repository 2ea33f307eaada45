#pragma once

#include <span>

namespace clothbrdf {

/// The slope of the straight line through points (x, y) by least squares. Two points or more, not
/// all of the same x.
double fitted_slope(std::span<const double> x, std::span<const double> y);

}  // namespace clothbrdf
