#pragma once

#include <algorithm>
#include <cmath>

namespace clothbrdf {

/// All numbers from low to high. Ends are rounded to nearest, not outwards: whoever states a bound
/// widens the result by more than all roundings together (kRounding of the planner, kArcRounding).
struct Interval {
  double low = 0;
  double high = 0;

  double width() const { return high - low; }
  double middle() const { return low + (high - low) / 2; }
  /// The largest |value|.
  double magnitude() const { return std::max(-low, high); }
  /// The smallest |value|.
  double least_magnitude() const { return std::max({0.0, low, -high}); }
};

inline Interval operator+(const Interval& a, const Interval& b) {
  return {a.low + b.low, a.high + b.high};
}

inline Interval operator-(const Interval& a, const Interval& b) {
  return {a.low - b.high, a.high - b.low};
}

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }

inline Interval operator*(const Interval& a, const Interval& b) {
  if (a.low >= 0 && b.low >= 0) return {a.low * b.low, a.high * b.high};
  const auto [low, high] =
      std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}

/// The smallest that holds both.
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

inline Interval squared(const Interval& a) {
  const double least = a.least_magnitude();
  const double most = a.magnitude();
  return {least * least, most * most};
}

/// Cosines of all angles from low to high, radians.
inline Interval cosines(const Interval& angles) {
  constexpr double kPi = 3.14159265358979323846;
  const auto holds_multiple = [&](double offset) {  // of 2 pi, beyond offset
    return std::floor((angles.high - offset) / (2 * kPi)) >=
           std::ceil((angles.low - offset) / (2 * kPi));
  };
  const double from = std::cos(angles.low);
  const double to = std::cos(angles.high);
  return {holds_multiple(kPi) ? -1 : std::min(from, to),
          holds_multiple(0) ? 1 : std::max(from, to)};
}

}  // namespace clothbrdf
