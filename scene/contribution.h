#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "model/reflectance.h"
#include "scene/angle_box.h"
#include "scene/walk_bounds.h"

namespace clothbrdf {

/// Which part of f_r cos(theta_i) is to be bounded: all of it, or what goes (or changes) with one
/// effect.
struct Quantity {
  enum class Kind {
    kWhole,
    kSpecular,
    kDiffuse,
    kSmallerYarn,
    kLayers,           ///< beyond `kept`
    kInterreflection,  ///< of more than `kept` events
    kNearSide,
    kScatter,
    kColour,
    kFresnelAngle,  ///< against `cos_theta_d`
    kAnisotropy,
    kShadowing,
  };
  Kind kind = Kind::kWhole;
  int kept = 0;
  double cos_theta_d = 1;
};

/// Bounds of |quantity| of a cloth over boxes of directions, in 1/sr. What the cloth's model leaves
/// out already is not in them. Remembers path sums: not for several threads.
class Contribution {
 public:
  /// Keeps a reference to the model.
  Contribution(const ClothModel<double>& model, const Quantity& quantity);

  /// Of the largest channel, each times its radiance: `low`, what no pair of the box falls below in
  /// it, and `high`, what none exceeds in any. One radiance a channel.
  Interval operator()(const AngleBox& box, std::span<const double> radiance);

 private:
  /// A yarn's walks, of one channel, by cells of cos_theta_d.
  struct Paths {
    double sign = 1;
    std::unordered_map<std::uint32_t, WalkBounds> cells;
  };
  struct YarnPart {
    const PreparedYarn<double>* yarn;
    LobeGroup surface;
    std::vector<LobeGroup> groups;
    std::vector<Paths> channels;
    // Of the box at hand.
    Interval surface_density;
    std::vector<Interval> densities;
    Interval surface_weight;
  };

  void take_densities(YarnPart& part, const GeometryBounds& g) const;
  Interval surface_weight(const YarnPart& part, const Interval& x) const;
  WalkBounds walks(const YarnPart& part, std::size_t channel, const Interval& x) const;
  WalkBounds walks_in_cells(YarnPart& part, std::size_t channel, const Interval& x);
  Interval directional(std::size_t channel, const Interval& x);
  double constant(std::size_t channel) const;

  const ClothModel<double>& model_;
  Quantity quantity_;
  bool has_surface_;
  bool has_walks_;
  std::vector<YarnPart> parts_;
  std::vector<double> constants_;          // [channel]
  std::vector<std::vector<double>> grey_;  // [yarn][channel], absorption without colour
};

}  // namespace clothbrdf
