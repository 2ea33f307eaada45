#include "scene/lit_boxes.h"

#include <algorithm>
#include <cmath>

#include "model/scalar.h"

namespace clothbrdf {
namespace {

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180;

// Wider by more than radians are rounded.
Interval radians(const AngleRange& degrees) {
  constexpr double kRounding = 1e-14;
  return {degrees.low * kRadiansPerDegree - kRounding,
          degrees.high * kRadiansPerDegree + kRounding};
}

Interval theta(const AngleRange& degrees) {
  const Interval wide = radians(degrees);
  return {std::max(0.0, wide.low), std::min(pi<double>() / 2, wide.high)};
}

Interval turned(const AngleRange& degrees, double rotation_deg) {
  // Reduced first: a rotation of many turns would be lost in its own rounding.
  const double turn = std::remainder(rotation_deg, 360);
  const double low = std::remainder(degrees.low, 360);
  return radians({low - turn, low - turn + (degrees.high - degrees.low)});
}

}  // namespace

LitBoxes::LitBoxes(const Scene& scene, const Material& material) {
  for (const SceneLight& light : scene.lights) {
    std::vector<double> radiance = light.radiance;
    if (radiance.size() == 1) radiance.assign(material.channel_count(), radiance.front());
    radiance_.push_back(std::move(radiance));
  }
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    const DirectionRange& from = scene.lights[k].from;
    for (const DirectionRange& to : scene.eyes) {
      for (const double rotation : scene.rotations_deg) {
        const double turn =
            std::remainder(rotation, 360) + std::remainder(material.rotation_deg, 360);
        boxes_.push_back({{{theta(from.theta_deg), turned(from.phi_deg, turn), theta(to.theta_deg),
                            turned(to.phi_deg, turn)}},
                          radiance_[k]});
      }
    }
  }
}

DirectionPair pair_in(const AngleBox& box, const std::array<double, 4>& shares) {
  std::array<double, 4> degrees;
  for (std::size_t a = 0; a < 4; ++a)
    degrees[a] = (box.angles[a].low + shares[a] * box.angles[a].width()) / kRadiansPerDegree;
  return {degrees[0], degrees[1], degrees[2], degrees[3]};
}

}  // namespace clothbrdf
