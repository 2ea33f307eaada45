#pragma once

#include <cmath>

#include "tests/reference/worst_case.h"

namespace clothbrdf::test {

/// Above this exponent exp itself costs more than the rest: its argument's rounding is magnified X
/// times.
inline constexpr double kLargestExponent = 300;
inline constexpr double kPerExponent = 4e-16;

/// Model.md, section 9. X is the exponent of the yarn's strongest path, k = 1, which the deeper
/// ones cannot outweigh.
inline double hard_promise(std::size_t component, const Material& material, std::size_t channel,
                           const ReferenceValues& exact) {
  if (component == 0) return kPromise;
  double largest = 0;
  const double x = static_cast<double>(exact.cos_theta_d);
  for (const Yarn* yarn : {&material.warp, &material.weft}) {
    const double n = yarn->refractive_index;
    const double cos_theta_t = std::sqrt((n - 1) * (n + 1) + x * x) / n;
    const double exponent = component == 1 ? 2 * yarn->absorption[channel] / cos_theta_t
                                           : yarn->absorption[channel] * material.diffuse_path;
    largest = std::fmax(largest, exponent);
  }
  return largest < kLargestExponent ? kPromise : kPerExponent * largest;
}

}  // namespace clothbrdf::test
