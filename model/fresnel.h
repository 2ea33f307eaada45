#pragma once

#include <cmath>

namespace clothbrdf {

/// What happens at one interface between air and yarn.
template <class T>
struct Interface {
  T reflected;    ///< r, [0, 1]
  T transmitted;  ///< t = 1 - r to the last digit, both free of cancellation
  T cos_theta_t;  ///< inside the yarn
};

/// Unpolarised Fresnel reflection of a dielectric: incidence cosine in [0, 1], refractive index in
/// [1, 3]. Index 1 reflects nothing, at cosine 0 too (reading). Total at cosine 0 otherwise. Paper,
/// section 3.1: the reflectance r of eq. 1. The forms are model.md section 4's: t = 1 - r would
/// lose 9 digits at grazing, g - x four at an index near 1. Error: 4 eps of each number.
///
/// Reading: the incidence angle is the one to the facet (the half vector), not to the cloth's
/// normal.
template <class T>
Interface<T> fresnel(const T& cos_theta_d, const T& refractive_index) {
  using std::sqrt;
  const T& x = cos_theta_d;
  const T& n = refractive_index;
  const T m = (n - T(1)) * (n + T(1));
  const T g = sqrt(m + x * x);
  const T q = g + x;
  if (!(q > T(0))) return {T(0), T(1), T(0)};
  const T a = m / (q * q);
  const T b = (x * q - T(1)) / (x * m / q + T(1));
  const T r = a * a * (T(1) + b * b) / T(2);
  if (r < T(0.5)) return {r, T(1) - r, g / n};
  const T p = n / (n * n * x + g);
  const T t = T(2) * x * g * (T(1) / (q * q) + p * p);
  return {T(1) - t, t, g / n};
}

}  // namespace clothbrdf
