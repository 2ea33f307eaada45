#pragma once

#include <cmath>

namespace clothbrdf {

// The curve of sRGB (IEC 61966-2-1), whose primaries and white are those of Rec. 709. The standard
// rounds its constants: the two ends of the curve's straight part miss each other by 3e-8.

/// Light, 0 to 1, of an encoded channel, 0 to 1 (a byte divided by 255). Outside, the curve goes
/// on: below as its straight part, above as its power.
inline double srgb_to_linear(double encoded) {
  constexpr double kStraight = 0.04045;
  if (encoded <= kStraight) return encoded / 12.92;
  return std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The inverse of srgb_to_linear, to 1e-7.
inline double linear_to_srgb(double linear) {
  constexpr double kStraight = 0.0031308;
  if (linear <= kStraight) return linear * 12.92;
  return 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace clothbrdf
