#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "model/directions.h"
#include "model/effects.h"
#include "model/layers.h"
#include "model/lobe.h"
#include "model/material.h"

namespace clothbrdf {

/// The part of f_r that depends on where light and eye are, apart from the half vector and
/// cos_theta_d: S of model.md section 7, V-cavity shadowing over 4 cos cos (microfacet), or 1 /
/// cos_theta_i (paper). Both directions above the horizon. The microfacet form neither cancels nor
/// overflows early; it is at most 1 / (2 cos_theta_d^2). Without shadowing G is 1. Error: 2 eps.
template <class T>
T directional_factor(Reflectance reflectance, const T& h_n, const T& cos_theta_d,
                     const T& cos_theta_i, const T& cos_theta_o, bool shadowing = true) {
  if (reflectance == Reflectance::kPaper) return T(1) / cos_theta_i;
  if (!shadowing) return T(1) / (T(4) * cos_theta_i * cos_theta_o);
  const bool i_lower = cos_theta_i < cos_theta_o;
  const T& low = i_lower ? cos_theta_i : cos_theta_o;
  const T& high = i_lower ? cos_theta_o : cos_theta_i;
  const T unshadowed = T(1) / (T(2) * low);
  const T shadowed = h_n / cos_theta_d;
  return (shadowed < unshadowed ? shadowed : unshadowed) / (T(2) * high);
}

/// Colour of light that has travelled through the yarn: rho (paper, section 3.3; diffuse_path in
/// layer thicknesses). Error: 2 eps times the condition number.
template <class T>
T diffuse_colour(const T& absorption, const T& diffuse_path) {
  using std::exp;
  return exp(-absorption * diffuse_path);
}

/// f of the diffuse component in a channel, the same for all directions above the horizon, by the
/// shares of the surface of warp and weft (model.md section 7; paper, eq. 5). Error: 4 eps times
/// the condition number.
template <class T>
T diffuse_reflectance(const BasicMaterial<T>& material, const std::array<T, 2>& shares,
                      std::size_t channel) {
  const auto colour = [&](const BasicYarn<T>& yarn) {
    return diffuse_colour(yarn.absorption[channel], material.diffuse_path);
  };
  const T sum = material.weights.diffuse *
                (shares[0] * colour(material.warp) + shares[1] * colour(material.weft));
  return material.reflectance == Reflectance::kMicrofacet ? T(sum / pi<T>()) : sum;
}

/// One lobe of a yarn: its axes, and what its height is divided by (Z, or 1 for the paper's
/// convention).
template <class T>
struct Lobe {
  LobeAxes<T> axes;
  T norm;
};

/// f_r in 1/sr (the cosine is not in), one value a channel.
template <class T>
struct BasicComponents {
  std::vector<T> specular;
  std::vector<T> internal;
  std::vector<T> diffuse;

  T total(std::size_t channel) const {
    return specular[channel] + internal[channel] + diffuse[channel];
  }
};
using Components = BasicComponents<double>;

/// A yarn of a cloth, ready to be evaluated.
template <class T>
struct PreparedYarn {
  BasicYarn<T> yarn;
  bool warp;                   ///< lies along the warp
  T share;                     ///< of the surface
  PathSet paths;               ///< that count
  std::vector<Lobe<T>> lobes;  ///< index j: E = 2 j + 1 events
};

/// A cloth, ready to be evaluated at any pair of directions. What does not depend on the directions
/// is done once. The material must be valid (check_material); an invalid one gives undefined
/// values.
template <class T>
class ClothModel {
 public:
  explicit ClothModel(const BasicMaterial<T>& material, const Effects& effects = {})
      : material_(apply_effects(material, effects)), effects_(effects) {
    // Equal values may still carry different derivatives.
    equal_yarns_ = !kCarriesDerivative<T> && material_.warp == material_.weft;
    const T warp = material_.warp_fraction;
    const T weft = T(1) - warp;
    shares_ = {warp, weft};
    if (!effects.second_yarn) shares_[warp < weft ? 0 : 1] = T(0);
    if (equal_yarns_ && !effects.anisotropy && effects.second_yarn) {
      add(material_.warp, true, T(1));  // turning them makes no difference
    } else {
      if (kCarriesDerivative<T> || shares_[0] != T(0)) add(material_.warp, true, shares_[0]);
      if (kCarriesDerivative<T> || shares_[1] != T(0)) add(material_.weft, false, shares_[1]);
    }
    equal_yarns_ = equal_yarns_ && yarns_.size() > 1;
  }

  /// The material less the effects that are off, where a material can do without them.
  const BasicMaterial<T>& material() const { return material_; }
  const Effects& effects() const { return effects_; }
  std::size_t channel_count() const { return material_.channel_count(); }

  /// Those that count, the warp first: both, or one where the other has no share or is left out, or
  /// where they are equal and have no direction.
  std::span<const PreparedYarn<T>> yarns() const { return yarns_; }

  /// Whether there are two, and equal.
  bool equal_yarns() const { return equal_yarns_; }

  /// The incidence cosine of the Fresnel terms and path lengths.
  T incidence_cosine(const T& cos_theta_d) const {
    return effects_.cos_theta_d ? T(*effects_.cos_theta_d) : cos_theta_d;
  }

  /// directional_factor of this cloth.
  T factor(const T& h_n, const T& cos_theta_d, const T& cos_theta_i, const T& cos_theta_o) const {
    return directional_factor(material_.reflectance, h_n, cos_theta_d, cos_theta_i, cos_theta_o,
                              effects_.shadowing);
  }

  /// Height of a lobe of a yarn in the direction of the half vector; without anisotropy its mean
  /// over the half vector's azimuth.
  T height(const PreparedYarn<T>& yarn, const LobeAxes<T>& axes, const T& h_weft, const T& h_warp,
           const T& h_n) const {
    using std::sqrt;
    if (!effects_.anisotropy) {
      return lobe_azimuthal_mean(T(sqrt(h_weft * h_weft + h_warp * h_warp)), h_n, axes);
    }
    return yarn.warp ? lobe_height(h_warp, T(-h_weft), h_n, axes)
                     : lobe_height(h_weft, h_warp, h_n, axes);
  }

  /// f of the diffuse component, the same for all directions above the horizon.
  T diffuse(std::size_t channel) const { return diffuse_reflectance(material_, shares_, channel); }

  /// f_r, component by component; 0 where a direction is on or below the horizon. Model.md section
  /// 7; paper, eqs. 1, 4, 5.
  BasicComponents<T> evaluate(const PairGeometry<T>& g) const {
    const std::size_t channels = channel_count();
    BasicComponents<T> f{std::vector<T>(channels, T(0)), std::vector<T>(channels, T(0)),
                         std::vector<T>(channels, T(0))};
    if (!g.above_horizon()) return f;
    const T scale = factor(g.h_n, g.cos_theta_d, g.cos_theta_i, g.cos_theta_o);
    std::vector<T> density;
    std::vector<T> weights;
    for (const PreparedYarn<T>& yarn : yarns_) {
      const Interface<T> interface =
          fresnel(incidence_cosine(g.cos_theta_d), yarn.yarn.refractive_index);
      density.clear();
      for (const Lobe<T>& lobe : yarn.lobes) {
        density.push_back(height(yarn, lobe.axes, g.h_weft, g.h_warp, g.h_n) / lobe.norm);
      }
      weights.assign(yarn.lobes.size(), T(0));
      for (std::size_t c = 0; c < channels; ++c) {
        path_weights(yarn.yarn, yarn.paths, interface, yarn.yarn.absorption[c],
                     std::span<T>(weights));
        T internal = T(0);
        for (std::size_t j = 1; j < weights.size(); ++j) internal += weights[j] * density[j];
        f.specular[c] += yarn.share * weights[0] * density[0];
        f.internal[c] += yarn.share * internal;
      }
    }
    for (std::size_t c = 0; c < channels; ++c) {
      f.specular[c] *= material_.weights.specular * scale;
      f.internal[c] *= material_.weights.internal * scale;
      f.diffuse[c] = diffuse(c);
    }
    return f;
  }

 private:
  void add(const BasicYarn<T>& yarn, bool warp, const T& share) {
    const PathSet paths = path_set(material_.paths, effects_, yarn.layers);
    if (equal_yarns_ && !yarns_.empty()) {
      yarns_.push_back({yarn, warp, share, paths, yarns_[0].lobes});
      return;
    }
    std::vector<Lobe<T>> lobes;
    for (int j = 0; j < lobe_count(yarn, paths); ++j) {
      const LobeAxes<T> axes = lobe_axes(yarn, j);
      lobes.push_back(
          {axes, material_.reflectance == Reflectance::kMicrofacet ? lobe_integral(axes) : T(1)});
    }
    yarns_.push_back({yarn, warp, share, paths, std::move(lobes)});
  }

  BasicMaterial<T> material_;
  Effects effects_;
  bool equal_yarns_;
  std::array<T, 2> shares_;  // of warp and weft, 0 where left out
  std::vector<PreparedYarn<T>> yarns_;
};

}  // namespace clothbrdf
