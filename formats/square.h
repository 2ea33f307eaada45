#pragma once

#include <cmath>
#include <numbers>

#include "table/grid.h"

namespace clothbrdf {

/// A point of the unit square that stands for a direction above the horizon in RGL's files: x =
/// sqrt(2 theta / pi), y = (phi + pi) / (2 pi). The ends of y are one azimuth.
struct RglPoint {
  double x;
  double y;
};

/// Elevation, radians, [0, pi/2].
inline double square_theta(double x) { return x * x * (std::numbers::pi / 2); }

/// Azimuth, radians, [-pi, pi].
inline double square_phi(double y) { return (2 * y - 1) * std::numbers::pi; }

/// Without squares of small numbers: exact at the pole.
inline double elevation(const Vector3<double>& v) {
  return std::atan2(std::hypot(v[0], v[1]), v[2]);
}

inline double azimuth(const Vector3<double>& v) { return std::atan2(v[1], v[0]); }

inline double dot(const Vector3<double>& a, const Vector3<double>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double theta_to_square(double theta) { return std::sqrt(theta * (2 / std::numbers::pi)); }

/// Any azimuth, radians: wrapped into [0, 1).
inline double phi_to_square(double phi) {
  const double y = (phi + std::numbers::pi) / (2 * std::numbers::pi);
  return y - std::floor(y);
}

/// Unit vector at an elevation and azimuth in radians.
inline Vector3<double> direction_at(double theta, double phi) {
  const double s = std::sin(theta);
  return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}

}  // namespace clothbrdf
