#pragma once

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "model/reflectance.h"

namespace clothbrdf::test {

// A cloth of one channel as an array of numbers of any scalar.

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                           boost::multiprecision::et_off>;

/// Everything continuous of a cloth and a pair, flat: the yarns' five each, then what they share.
inline constexpr std::size_t kWeft = 5;
inline constexpr std::size_t kScatter = 4;
inline constexpr std::size_t kShared = 10;
inline constexpr std::size_t kCount = kShared + 10;
using Parameters = std::array<double, kCount>;
using Jet = ceres::Jet<double, static_cast<int>(kCount)>;

struct Variant {
  Reflectance reflectance;
  Paths paths;
  std::array<int, 2> layers;
};

/// Specular, internal, diffuse.
template <class T>
std::array<T, 3> components_at(const std::array<T, kCount>& p, const Variant& variant) {
  BasicMaterial<T> material;
  material.reflectance = variant.reflectance;
  material.paths = variant.paths;
  for (std::size_t y = 0; y < 2; ++y) {
    BasicYarn<T>& yarn = y == 0 ? material.warp : material.weft;
    const T* own = p.data() + y * kWeft;
    yarn.lobe_axes = {own[0], own[1]};
    yarn.absorption = {own[2]};
    yarn.layers = variant.layers[y];
    yarn.refractive_index = own[3];
    yarn.scatter = own[kScatter];
  }
  const T* shared = p.data() + kShared;
  material.weights = {shared[0], shared[1], shared[2]};
  material.diffuse_path = shared[3];
  material.warp_fraction = shared[4];
  material.rotation_deg = shared[5];
  const BasicDirectionPair<T> pair = {shared[6], shared[7], shared[8], shared[9]};
  const BasicComponents<T> f =
      ClothModel<T>(material).evaluate(pair_geometry<T>(pair, material.rotation_deg));
  return {f.specular[0], f.internal[0], f.diffuse[0]};
}

template <class T>
std::array<T, kCount> cast(const Parameters& p) {
  std::array<T, kCount> result;
  for (std::size_t k = 0; k < kCount; ++k) result[k] = T(p[k]);
  return result;
}

inline std::array<Jet, kCount> jets(const Parameters& p) {
  std::array<Jet, kCount> result;
  for (std::size_t k = 0; k < kCount; ++k) result[k] = Jet(p[k], static_cast<int>(k));
  return result;
}

/// Largest error of the Jet's derivatives, relative to the derivative plus the value of a component
/// (what is 25 digits below their sum does not count), every `stride`-th from `first` on. One-sided
/// where a parameter is 0 or a scatter rate is 1.
inline double worst_derivative(const Parameters& p, const Variant& variant, std::size_t first = 0,
                               std::size_t stride = 1) {
  const auto jet = components_at(jets(p), variant);
  const auto here = components_at(cast<Real>(p), variant);
  const Real negligible = (here[0] + here[1] + here[2]) * Real("1e-25");
  double worst = 0;
  for (std::size_t k = first; k < kCount; k += stride) {
    const auto at = [&](const Real& offset) {
      auto moved = cast<Real>(p);
      moved[k] += offset;
      return components_at(moved, variant);
    };
    const bool at_start = p[k] == 0;
    const bool at_end = k % kWeft == kScatter && k < kShared && p[k] > 1 - 1e-9;
    const bool one_sided = at_start || at_end;
    // Of second order: 1e-40 and 1e-36 times a third derivative.
    const Real step = !one_sided ? Real("1e-20") : at_end ? Real("-1e-18") : Real("1e-18");
    const auto ahead = at(step);
    const auto other = at(one_sided ? Real(2 * step) : Real(-step));
    for (std::size_t c = 0; c < 3; ++c) {
      const Real derivative =
          (one_sided ? Real(4 * ahead[c] - other[c] - 3 * here[c]) : Real(ahead[c] - other[c])) /
          (2 * step);
      const Real error = abs(Real(jet[c].v[static_cast<int>(k)] - derivative));
      const Real scale = abs(derivative) + abs(here[c]) + negligible;
      worst = std::max(worst, static_cast<double>(error / scale));
    }
  }
  return worst;
}

}  // namespace clothbrdf::test
