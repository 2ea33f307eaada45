#pragma once

#include <array>
#include <cmath>

#include "model/scalar.h"

namespace clothbrdf {

/// The facet-direction solid (paper, section 3.1, figs. 7-10): an ellipsoid over the surface point
/// with semi-axes a along the yarn, b across it and 1 along the normal.
///
/// Reading (figs. 7-10): it touches the surface point from above, as the sphere does that draws a
/// cosine lobe.
template <class T>
struct LobeAxes {
  T along;   ///< a, [1e-6, 1]
  T across;  ///< b, [1e-6, 1]
};

/// alpha: distance from the surface point to the far side of the solid in direction h, over the
/// solid's height. h is a unit vector: along the yarn, across it, along the normal (>= 0). In [0,
/// 1/h_n]; 1 at the normal; 0 at the horizon. Paper, eq. 1. Error: 4 eps times the condition
/// number, at most 3.
template <class T>
T lobe_height(const T& h_along, const T& h_across, const T& h_n, const LobeAxes<T>& axes) {
  const T u = h_along / axes.along;
  const T v = h_across / axes.across;
  return h_n / (u * u + v * v + h_n * h_n);
}

/// Mean of lobe_height over the azimuth of h, for the elevation given by its sine and cosine.
/// Error: 4 eps.
template <class T>
T lobe_azimuthal_mean(const T& sin_theta_h, const T& cos_theta_h, const LobeAxes<T>& axes) {
  using std::sqrt;
  const T s2 = sin_theta_h * sin_theta_h;
  const T a = axes.along * cos_theta_h;
  const T b = axes.across * cos_theta_h;
  return cos_theta_h * axes.along * axes.across / (sqrt(s2 + a * a) * sqrt(s2 + b * b));
}

/// Mean of lobe_height over azimuths of h from `from` to `to`, radians from the yarn's direction, 0
/// < to - from <= pi. Error: 8 eps times the condition number.
template <class T>
T lobe_azimuthal_mean(const T& sin_theta_h, const T& cos_theta_h, const LobeAxes<T>& axes,
                      const T& from, const T& to) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T u = sin_theta_h / axes.along;
  const T v = sin_theta_h / axes.across;
  const T p = sqrt(u * u + cos_theta_h * cos_theta_h);
  const T q = sqrt(v * v + cos_theta_h * cos_theta_h);
  // The integral of 1 / (p^2 cos^2 + q^2 sin^2) is atan2(q sin, p cos) / (p q). The difference of
  // two of these angles is that of the vectors (p cos, q sin), which does not cancel.
  T turned = atan2(T(p * q * sin(to - from)),
                   T(p * p * cos(from) * cos(to) + q * q * sin(from) * sin(to)));
  if (turned < T(0)) turned += T(2) * pi<T>();
  return cos_theta_h * turned / (p * q * (to - from));
}

/// Carlson's R_D(x, y, z) for x, y >= 0 (not both 0), z > 0, by duplication (DLMF 19.36).
/// Templated, unlike the libraries' versions, so that automatic differentiation passes through;
/// checked against Boost.Math. Error: 4 eps.
template <class T>
T carlson_rd(T x, T y, T z) {
  using std::abs;
  using std::pow;
  using std::sqrt;
  const T start = (x + y + T(3) * z) / T(5);
  const T dx = start - x;
  const T dy = start - y;
  T spread = abs(start - z);
  for (const T& side : {T(abs(dx)), T(abs(dy))}) spread = side > spread ? side : spread;
  // The series below is cut at the eighth order; stopping this early leaves the derivative exact
  // too.
  const T tolerance = pow(machine_epsilon<T>(), T(1) / T(6));
  T mean = start;
  T sum = T(0);
  T scale = T(1);
  while (scale * spread > tolerance * mean) {
    const T rx = sqrt(x);
    const T ry = sqrt(y);
    const T rz = sqrt(z);
    const T lambda = rx * (ry + rz) + ry * rz;
    sum += scale / (rz * (z + lambda));
    scale /= T(4);
    x = (x + lambda) / T(4);
    y = (y + lambda) / T(4);
    z = (z + lambda) / T(4);
    mean = (mean + lambda) / T(4);
  }
  const T u = scale * dx / mean;
  const T v = scale * dy / mean;
  const T w = -(u + v) / T(3);
  const T uv = u * v;
  const T w2 = w * w;
  const T e2 = uv - T(6) * w2;
  const T e3 = (T(3) * uv - T(8) * w2) * w;
  const T e4 = T(3) * (uv - w2) * w2;
  const T e5 = uv * w2 * w;
  const T series = T(1) - T(3) * e2 / T(14) + e3 / T(6) + T(9) * e2 * e2 / T(88) -
                   T(3) * e4 / T(22) - T(9) * e2 * e3 / T(52) + T(3) * e5 / T(26) -
                   e2 * e2 * e2 / T(16) + T(3) * e3 * e3 / T(40) + T(3) * e2 * e4 / T(20) +
                   T(45) * e2 * e2 * e3 / T(272) - T(9) * (e3 * e4 + e2 * e5) / T(68);
  return T(3) * sum + scale * series / (mean * sqrt(mean));
}

/// Z: integral of lobe_height * h_n over the hemisphere of h. In (0, 2 pi / 3]; at a = b = 1 it is
/// 2 pi / 3. Error: 6 eps.
template <class T>
T lobe_integral(const LobeAxes<T>& axes) {
  const T a = axes.along;
  const T b = axes.across;
  return T(2) * pi<T>() / T(3) * a * b * carlson_rd(T(a * a), T(b * b), T(1));
}

}  // namespace clothbrdf
