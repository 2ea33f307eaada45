#pragma once

#include <cmath>
#include <numbers>

#include "model/scalar.h"

namespace clothbrdf {

inline constexpr double kRightAngle = std::numbers::pi / 2;  ///< radians
inline constexpr double kRadian = std::numbers::pi / 180;    ///< one degree, radians

/// Sine and cosine of one angle.
template <class T>
struct SinCos {
  T sin;
  T cos;
};

/// A rounded result and the rounding error it left behind: value + error is exact.
template <class T>
struct Rounded {
  T value;
  T error;
};

/// a + b without error (Knuth's TwoSum); exact for IEEE scalars unless the sum overflows.
template <class T>
Rounded<T> two_sum(const T& a, const T& b) {
  const T sum = a + b;
  const T b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a - b without error.
template <class T>
Rounded<T> two_difference(const T& a, const T& b) {
  return two_sum(a, T(-b));
}

/// Error: 2 eps.
template <class T>
T degrees_to_radians(const T& degrees) {
  return degrees * (pi<T>() / T(180));
}

/// The angle minus the nearest whole number of turns, exactly: [-180, 180] degrees. Any finite
/// angle.
template <class T>
T reduce_turns(const T& degrees) {
  if constexpr (kCarriesDerivative<T>) {
    T reduced = degrees;
    reduced.a = reduce_turns(degrees.a);
    return reduced;
  } else {
    using std::remainder;
    return remainder(degrees, T(360));
  }
}

/// Sine and cosine of an angle in degrees that is taken as exact. Any finite angle. Error: 1 eps,
/// also beside 90 degrees, where cos(x * pi / 180) has lost three digits (model.md, section 2).
template <class T>
SinCos<T> sincosd(const T& degrees) {
  using std::cos;
  using std::sin;
  T rest = reduce_turns(degrees);
  int quarter = 0;
  for (; rest > T(45); rest -= T(90)) ++quarter;
  for (; rest < T(-45); rest += T(90)) --quarter;
  const T radians = degrees_to_radians(rest);
  const T s = sin(radians);
  const T c = cos(radians);
  switch (((quarter % 4) + 4) % 4) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

/// sincosd(angle.value + angle.error): the rounding error is put back to first order. Error: 2 eps.
template <class T>
SinCos<T> sincosd(const Rounded<T>& angle) {
  const SinCos<T> rounded = sincosd(angle.value);
  const T e = degrees_to_radians(angle.error);
  return {rounded.sin + rounded.cos * e, rounded.cos - rounded.sin * e};
}

}  // namespace clothbrdf
