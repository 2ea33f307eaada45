#pragma once

#include <array>
#include <cmath>

#include "model/degrees.h"

namespace clothbrdf {

/// A unit vector of the cloth frame: x = weft at rotation 0, y = warp, z = normal.
template <class T>
using Vector3 = std::array<T, 3>;

/// The unit vector at an elevation from the normal and an azimuth from x, degrees. Error: 2 eps.
template <class T>
Vector3<T> direction(const T& theta_deg, const T& phi_deg) {
  const SinCos<T> theta = sincosd(theta_deg);
  const SinCos<T> phi = sincosd(phi_deg);
  return {theta.sin * phi.cos, theta.sin * phi.sin, theta.cos};
}

/// A vector turned about the normal, counter-clockwise seen from it. Error: 2 eps times the
/// condition number.
template <class T>
Vector3<T> turned(const Vector3<T>& v, const SinCos<T>& turn) {
  return {v[0] * turn.cos - v[1] * turn.sin, v[0] * turn.sin + v[1] * turn.cos, v[2]};
}

/// A pair of directions in degrees, away from the cloth: wi to the light, wo to the eye. theta from
/// the normal [0, 180], phi counter-clockwise from x, any finite value.
template <class T>
struct BasicDirectionPair {
  T theta_i;
  T phi_i;
  T theta_o;
  T phi_o;

  bool operator==(const BasicDirectionPair&) const = default;
};
using DirectionPair = BasicDirectionPair<double>;

/// All that the model needs to know of a pair of directions.
template <class T>
struct PairGeometry {
  T h_weft;       ///< half vector along the weft yarn, [-1, 1]
  T h_warp;       ///< half vector along the warp yarn, [-1, 1]
  T h_n;          ///< half vector along the normal, cos(theta_h)
  T cos_theta_d;  ///< angle between the half vector and either direction, [0, 1]
  T cos_theta_i;
  T cos_theta_o;

  /// Below the horizon, or on it, every reflectance is 0.
  bool above_horizon() const { return cos_theta_i > T(0) && cos_theta_o > T(0); }
};

/// From angles that are taken as exact; `rotation_deg` is the rotation of the weave. wi + wo is
/// never formed: it cancels near the opposite azimuth and narrow lobes magnify what is lost
/// (model.md, section 2). Error: 8 eps times the condition number, of each number.
template <class T>
PairGeometry<T> pair_geometry(const BasicDirectionPair<T>& pair, const T& rotation_deg) {
  using std::sqrt;
  const SinCos<T> i = sincosd(pair.theta_i);
  const SinCos<T> o = sincosd(pair.theta_o);

  Rounded<T> delta = two_difference(reduce_turns(pair.phi_o), reduce_turns(pair.phi_i));
  delta.value = reduce_turns(delta.value);
  T h_x;
  T h_y;
  if (delta.value > T(90) || delta.value < T(-90)) {
    const T near_opposite = (delta.value + T(delta.value > T(0) ? -180 : 180)) + delta.error;
    const T half = sincosd(T(near_opposite / T(2))).sin;
    Rounded<T> sum = two_sum(pair.theta_i, pair.theta_o);
    Rounded<T> difference = two_difference(pair.theta_i, pair.theta_o);
    for (Rounded<T>* angle : {&sum, &difference}) {
      angle->value /= T(2);
      angle->error /= T(2);
    }
    h_x = T(2) * sincosd(sum).cos * sincosd(difference).sin + T(2) * o.sin * half * half;
    h_y = -o.sin * sincosd(near_opposite).sin;
  } else {
    const SinCos<T> d = sincosd(delta);
    h_x = i.sin + o.sin * d.cos;
    h_y = o.sin * d.sin;
  }
  const T h_z = i.cos + o.cos;
  const T length = sqrt(h_x * h_x + h_y * h_y + h_z * h_z);
  if (!(length > T(0))) return {T(0), T(0), T(1), T(0), i.cos, o.cos};

  Rounded<T> psi = two_difference(reduce_turns(pair.phi_i), reduce_turns(rotation_deg));
  psi.value = reduce_turns(psi.value);
  const SinCos<T> turn = sincosd(psi);
  return {(h_x * turn.cos - h_y * turn.sin) / length,
          (h_x * turn.sin + h_y * turn.cos) / length,
          h_z / length,
          length / T(2),
          i.cos,
          o.cos};
}

/// From unit vectors. Error: 8 eps times the condition number, of each number. f_r is then accurate
/// to 1e-13 + 2 eps / (narrowest axis * cos_theta_d): the sum wi + wo cancels for nearly opposite
/// directions.
template <class T>
PairGeometry<T> pair_geometry(const Vector3<T>& wi, const Vector3<T>& wo, const T& rotation_deg) {
  using std::sqrt;
  const Vector3<T> sum = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
  const T length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  if (!(length > T(0))) return {T(0), T(0), T(1), T(0), wi[2], wo[2]};
  const SinCos<T> turn = sincosd(rotation_deg);
  return {(sum[0] * turn.cos + sum[1] * turn.sin) / length,
          (sum[1] * turn.cos - sum[0] * turn.sin) / length,
          sum[2] / length,
          length / T(2),
          wi[2],
          wo[2]};
}

/// cos(theta_i) and cos(theta_o).
template <class T>
struct IncidenceCosines {
  T i;
  T o;
};

/// The two incidence cosines from half/difference angles: phi_d is the azimuth of the light around
/// the half vector, 0 where it leans away from the normal (Rusinkiewicz; MERL's convention). Error:
/// 2 eps times the condition number.
template <class T>
IncidenceCosines<T> incidence_cosines(const SinCos<T>& theta_h, const SinCos<T>& theta_d,
                                      const T& cos_phi_d) {
  const T even = theta_h.cos * theta_d.cos;
  const T odd = theta_h.sin * theta_d.sin * cos_phi_d;
  return {even - odd, even + odd};
}

}  // namespace clothbrdf
