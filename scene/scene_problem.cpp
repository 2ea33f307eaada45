#include <cmath>
#include <string>

#include "model/parameters.h"
#include "scene/planner.h"

namespace clothbrdf {
namespace {

constexpr double kQuarter = 90;
constexpr double kTurn = 360;

std::string at(const std::string& list, std::size_t index, const std::string& field) {
  return "/" + list + "/" + std::to_string(index) + "/" + field;
}

std::string range_text(const AngleRange& range) {
  if (range.low == range.high) return number_text(range.low);
  return "[" + number_text(range.low) + ", " + number_text(range.high) + "]";
}

std::optional<SceneProblem> direction_problem(const DirectionRange& range, const std::string& list,
                                              std::size_t index) {
  const AngleRange& theta = range.theta_deg;
  const AngleRange& phi = range.phi_deg;
  // Written so that NaN is a problem.
  if (!(theta.low >= 0 && theta.low <= theta.high && theta.high <= kQuarter)) {
    return SceneProblem{at(list, index, "theta_deg"), range_text(theta),
                        "an angle from 0 to 90 degrees (above the horizon), or [lowest, highest]"};
  }
  const bool finite = std::isfinite(phi.low) && std::isfinite(phi.high);
  if (!(finite && phi.low <= phi.high && phi.high <= phi.low + kTurn)) {
    return SceneProblem{at(list, index, "phi_deg"), range_text(phi),
                        "an angle in degrees, or [lowest, highest] at most 360 apart"};
  }
  return std::nullopt;
}

// Whether azimuths of two ranges can be half a turn apart.
bool can_be_opposite(const AngleRange& a, const AngleRange& b) {
  const double low = b.low - a.high - kTurn / 2;
  const double high = b.high - a.low - kTurn / 2;
  return std::floor(high / kTurn) >= std::ceil(low / kTurn);
}

bool mirrors_at_grazing(const Material& material) {
  return material.reflectance == Reflectance::kMicrofacet && material.weights.specular > 0 &&
         (material.warp.refractive_index > 1 || material.weft.refractive_index > 1);
}

std::optional<SceneProblem> radiance_problem(const Scene& scene, std::size_t index) {
  const std::vector<double>& radiance = scene.lights[index].radiance;
  constexpr double kMost = 1e30;
  for (const double value : radiance) {
    if (!(value >= 0 && value <= kMost)) {
      return SceneProblem{at("lights", index, "radiance"), number_text(value),
                          "numbers from 0 to 1e+30"};
    }
  }
  for (const Material& material : scene.materials) {
    if (radiance.size() != 1 && radiance.size() != material.channel_count()) {
      return SceneProblem{at("lights", index, "radiance"),
                          std::to_string(radiance.size()) + " values",
                          "one, or as many as each material has channels: " +
                              std::to_string(material.channel_count())};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<SceneProblem> find_problem(const Scene& scene) {
  if (!(scene.tolerance >= 0 && scene.tolerance <= 1)) {
    return SceneProblem{"/tolerance", number_text(scene.tolerance),
                        "a fraction of the brightest value, from 0 to 1"};
  }
  const auto empty = [](const char* list) {
    return SceneProblem{std::string("/") + list, "an empty list", "at least one"};
  };
  if (scene.materials.empty()) return empty("materials");
  if (scene.lights.empty()) return empty("lights");
  if (scene.eyes.empty()) return empty("eyes");
  if (scene.rotations_deg.empty()) return empty("rotations_deg");
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    if (const auto problem = find_problem(scene.materials[k])) {
      return SceneProblem{"/materials/" + std::to_string(k) + problem->pointer, problem->value,
                          problem->allowed};
    }
  }
  bool lit = false;
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    if (auto problem = direction_problem(scene.lights[k].from, "lights", k)) return problem;
    if (auto problem = radiance_problem(scene, k)) return problem;
    for (const double value : scene.lights[k].radiance) lit = lit || value > 0;
  }
  if (!lit) {
    return SceneProblem{"/lights", "radiance 0 of all", "at least one light that is not dark"};
  }
  for (std::size_t k = 0; k < scene.eyes.size(); ++k) {
    if (auto problem = direction_problem(scene.eyes[k], "eyes", k)) return problem;
  }
  for (std::size_t k = 0; k < scene.rotations_deg.size(); ++k) {
    if (!std::isfinite(scene.rotations_deg[k])) {
      return SceneProblem{"/rotations_deg/" + std::to_string(k),
                          number_text(scene.rotations_deg[k]), "finite numbers"};
    }
  }
  if (const std::size_t count = scene.reach().combinations(); count > kMostCombinations) {
    return SceneProblem{"/rotations_deg",
                        std::to_string(count) + " combinations of a light, an eye and a rotation",
                        "at most " + std::to_string(kMostCombinations)};
  }
  bool mirrors = false;
  for (const Material& material : scene.materials)
    mirrors = mirrors || mirrors_at_grazing(material);
  for (std::size_t e = 0; mirrors && e < scene.eyes.size(); ++e) {
    for (const SceneLight& light : scene.lights) {
      const DirectionRange& eye = scene.eyes[e];
      if (eye.theta_deg.high < kQuarter || light.from.theta_deg.high < kQuarter) continue;
      if (!can_be_opposite(light.from.phi_deg, eye.phi_deg)) continue;
      return SceneProblem{at("eyes", e, "theta_deg"), range_text(eye.theta_deg),
                          "below 90 degrees: with a light opposite that reaches the horizon too, "
                          "the surface's reflection has no largest value"};
    }
  }
  return std::nullopt;
}

}  // namespace clothbrdf
