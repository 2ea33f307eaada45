#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
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
/// overflows early; it is at most 1 / (2 cos_theta_d^2).
template <class T>
T directional_factor(Reflectance reflectance, const T& h_n, const T& cos_theta_d,
                     const T& cos_theta_i, const T& cos_theta_o) {
  if (reflectance == Reflectance::kPaper) return T(1) / cos_theta_i;
  const bool i_lower = cos_theta_i < cos_theta_o;
  const T& low = i_lower ? cos_theta_i : cos_theta_o;
  const T& high = i_lower ? cos_theta_o : cos_theta_i;
  const T unshadowed = T(1) / (T(2) * low);
  const T shadowed = h_n / cos_theta_d;
  return (shadowed < unshadowed ? shadowed : unshadowed) / (T(2) * high);
}

/// Colour of light that has travelled through the yarn: rho (paper, section 3.3; diffuse_path in
/// layer thicknesses).
template <class T>
T diffuse_colour(const T& absorption, const T& diffuse_path) {
  using std::exp;
  return exp(-absorption * diffuse_path);
}

/// f of the diffuse component in a channel, the same for all directions above the horizon (model.md
/// section 7; paper, eq. 5).
template <class T>
T diffuse_reflectance(const BasicMaterial<T>& material, std::size_t channel) {
  const auto colour = [&](const BasicYarn<T>& yarn) {
    return diffuse_colour(yarn.absorption[channel], material.diffuse_path);
  };
  const T sum =
      material.weights.diffuse * (material.warp_fraction * colour(material.warp) +
                                  (T(1) - material.warp_fraction) * colour(material.weft));
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
  T share;                     ///< of the surface
  std::vector<Lobe<T>> lobes;  ///< index j: E = 2 j + 1 events
};

/// A cloth, ready to be evaluated at any pair of directions. What does not depend on the directions
/// is done once. The material must be valid (check_material); an invalid one gives undefined
/// values.
template <class T>
class ClothModel {
 public:
  explicit ClothModel(const BasicMaterial<T>& material, const Effects& effects = {})
      : material_(apply_effects(material, effects)),
        yarns_{{{material_.warp, material_.warp_fraction, {}},
                {material_.weft, T(1) - material_.warp_fraction, {}}}} {
    yarns_[0].lobes = prepare_lobes(material_.warp);
    // Equal values may still carry different derivatives.
    const bool same = !kCarriesDerivative<T> && material_.warp == material_.weft;
    yarns_[1].lobes = same ? yarns_[0].lobes : prepare_lobes(material_.weft);
  }

  /// The material less the effects that are off.
  const BasicMaterial<T>& material() const { return material_; }
  std::size_t channel_count() const { return material_.channel_count(); }

  /// Warp, weft.
  const std::array<PreparedYarn<T>, 2>& yarns() const { return yarns_; }

  /// h of the cloth in a yarn's own frame: along it, across it. Yarn 0 is the warp.
  static std::array<T, 2> in_yarn_frame(std::size_t yarn, const T& h_weft, const T& h_warp) {
    return yarn == 0 ? std::array<T, 2>{h_warp, -h_weft} : std::array<T, 2>{h_weft, h_warp};
  }

  /// f of the diffuse component, the same for all directions above the horizon.
  T diffuse(std::size_t channel) const { return diffuse_reflectance(material_, channel); }

  /// f_r, component by component; 0 where a direction is on or below the horizon. Model.md section
  /// 7; paper, eqs. 1, 4, 5.
  BasicComponents<T> evaluate(const PairGeometry<T>& g) const {
    const std::size_t channels = channel_count();
    BasicComponents<T> f{std::vector<T>(channels, T(0)), std::vector<T>(channels, T(0)),
                         std::vector<T>(channels, T(0))};
    if (!g.above_horizon()) return f;
    const T factor = directional_factor(material_.reflectance, g.h_n, g.cos_theta_d, g.cos_theta_i,
                                        g.cos_theta_o);
    std::vector<T> density;
    std::vector<T> weights;
    for (std::size_t y = 0; y < yarns_.size(); ++y) {
      const PreparedYarn<T>& yarn = yarns_[y];
      const auto [along, across] = in_yarn_frame(y, g.h_weft, g.h_warp);
      const Interface<T> interface = fresnel(g.cos_theta_d, yarn.yarn.refractive_index);
      density.clear();
      for (const Lobe<T>& lobe : yarn.lobes) {
        density.push_back(lobe_height(along, across, g.h_n, lobe.axes) / lobe.norm);
      }
      weights.assign(yarn.lobes.size(), T(0));
      for (std::size_t c = 0; c < channels; ++c) {
        path_weights(yarn.yarn, material_.paths, interface, yarn.yarn.absorption[c],
                     std::span<T>(weights));
        T internal = T(0);
        for (std::size_t j = 1; j < weights.size(); ++j) internal += weights[j] * density[j];
        f.specular[c] += yarn.share * weights[0] * density[0];
        f.internal[c] += yarn.share * internal;
      }
    }
    for (std::size_t c = 0; c < channels; ++c) {
      f.specular[c] *= material_.weights.specular * factor;
      f.internal[c] *= material_.weights.internal * factor;
      f.diffuse[c] = diffuse(c);
    }
    return f;
  }

 private:
  std::vector<Lobe<T>> prepare_lobes(const BasicYarn<T>& yarn) const {
    std::vector<Lobe<T>> lobes;
    for (int j = 0; j < lobe_count(yarn, material_.paths); ++j) {
      const LobeAxes<T> axes = lobe_axes(yarn, j);
      lobes.push_back(
          {axes, material_.reflectance == Reflectance::kMicrofacet ? lobe_integral(axes) : T(1)});
    }
    return lobes;
  }

  BasicMaterial<T> material_;
  std::array<PreparedYarn<T>, 2> yarns_;
};

}  // namespace clothbrdf
