#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace clothbrdf {

/// How lobes become a reflectance (model.md, section 7).
enum class Reflectance {
  kMicrofacet,  ///< normalised lobes, V-cavity shadowing: reciprocal, what other renderers need
  kPaper,       ///< eqs. 1, 4 and 5 read literally: not reciprocal, unbounded at grazing incidence
};

/// Which walks through the yarn layers the internal component counts (model.md, section 5).
enum class Paths {
  kAll,     ///< every walk that leaves through the top
  kSingle,  ///< eq. 4: one reflection, at the far side of layer k
};

/// One yarn: filament yarns are narrow along (a << b), span yarns round (a ~ b). Ranges:
/// model/parameters.h.
template <class T>
struct BasicYarn {
  std::array<T, 2>
      lobe_axes{};  ///< semi-axes of the facet-direction solid: along the yarn, across it
  std::vector<T>
      absorption;        ///< absorbance of one layer at normal incidence, natural log, per channel
  int layers = 0;        ///< stacked yarn layers
  T refractive_index{};  ///< of the yarn against air
  T scatter{};           ///< directionality lost per event
  std::optional<T>
      scatter_limit;  ///< radius of the circle that scatter tends to; the wider axis where absent

  bool operator==(const BasicYarn&) const = default;
};

/// Weights k_s, k_i, k_d of the three components.
template <class T>
struct BasicWeights {
  T specular{};
  T internal{};
  T diffuse{};

  bool operator==(const BasicWeights&) const = default;
};

/// A woven cloth: two yarns at right angles, averaged by their share of the surface (paper,
/// sections 3.3 and 4).
template <class T>
struct BasicMaterial {
  std::string name;
  std::string description;  ///< what it is and where its numbers come from, for people
  Reflectance reflectance = Reflectance::kMicrofacet;
  Paths paths = Paths::kAll;
  BasicWeights<T> weights;
  T diffuse_path =
      T(1);  ///< light's path in the yarn before it leaves as diffuse, in layer thicknesses
  T warp_fraction = T(0.5);            ///< share of the surface that shows warp
  T rotation_deg = T(0);               ///< of both yarns, counter-clockwise seen from the normal
  BasicYarn<T> warp;                   ///< along y at rotation 0
  BasicYarn<T> weft;                   ///< along x at rotation 0
  std::vector<double> wavelengths_nm;  ///< of the channels; empty means linear R, G, B (Rec. 709)

  std::size_t channel_count() const { return warp.absorption.size(); }
  bool operator==(const BasicMaterial&) const = default;
};

using Yarn = BasicYarn<double>;
using Weights = BasicWeights<double>;
using Material = BasicMaterial<double>;

}  // namespace clothbrdf
