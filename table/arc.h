#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/degrees.h"
#include "table/interval.h"

namespace clothbrdf {

// Internal to table/: azimuths, radians.

inline constexpr double kHalfTurn = std::numbers::pi;
/// Bounds that meet may be apart by this: more than all roundings together.
inline constexpr double kArcRounding = 1e-9;

/// Whether they share a number, or nearly.
inline bool meet(const Interval& a, const Interval& b) {
  return a.low <= b.high + kArcRounding && b.low <= a.high + kArcRounding;
}

/// Azimuths up to `half` to both sides of `middle`, which lies in [-pi, pi].
struct Arc {
  double middle = 0;
  double half = kHalfTurn;

  bool all_around() const { return half >= kHalfTurn; }
  bool meets(const Arc& other) const {
    const double apart = std::abs(middle - other.middle);
    return std::min(apart, 2 * kHalfTurn - apart) <= half + other.half + kArcRounding;
  }
};

inline Arc arc(const Interval& azimuths) {
  const double half = (azimuths.high - azimuths.low) / 2;
  if (half >= kHalfTurn - kArcRounding) return {};
  return {std::remainder((azimuths.low + azimuths.high) / 2, 2 * kHalfTurn), half};
}

/// How far azimuths of one arc are from those of another.
inline Arc operator-(const Arc& a, const Arc& b) {
  if (a.half + b.half >= kHalfTurn) return {};
  const double middle = a.middle - b.middle;
  const double turns = middle > kHalfTurn ? 1 : middle < -kHalfTurn ? -1 : 0;
  return {middle - turns * 2 * kHalfTurn, a.half + b.half};
}

/// Directions from the origin to the points of a rectangle.
inline Arc azimuths_of(Interval x, Interval y) {
  const bool left = x.low <= kArcRounding;
  const bool right = x.high >= -kArcRounding;
  double turned = 0;
  if (left && right) {
    if (y.low <= kArcRounding && y.high >= -kArcRounding) return {};
    // Above or below the origin: seen from a quarter of a turn on.
    turned = y.low > 0 ? kRightAngle : -kRightAngle;
    const Interval before = x;
    x = y.low > 0 ? y : -y;
    y = turned > 0 ? -before : before;
  } else if (left) {
    turned = kHalfTurn;
    x = -x;
    y = -y;
  }
  const double low = std::atan2(y.low, y.low < 0 ? x.low : x.high);
  const double high = std::atan2(y.high, y.high > 0 ? x.low : x.high);
  const double middle = turned + (low + high) / 2;
  return {middle > kHalfTurn ? middle - 2 * kHalfTurn : middle, (high - low) / 2};
}

}  // namespace clothbrdf
