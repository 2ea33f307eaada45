#pragma once

#include <algorithm>

#include "model/material.h"

namespace clothbrdf::test {

/// How much a lobe magnifies the rounding of directions: h has the error of wi + wo over its
/// length, and the density sees h over the axis. At least 1.
inline double lobe_condition(const Material& material, double cos_theta_d) {
  const auto& warp = material.warp.lobe_axes;
  const auto& weft = material.weft.lobe_axes;
  const double narrowest = std::min({warp[0], warp[1], weft[0], weft[1]});
  return std::max(1.0, 1 / (narrowest * cos_theta_d));
}

}  // namespace clothbrdf::test
