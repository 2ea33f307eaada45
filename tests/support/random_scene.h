#pragma once

#include <algorithm>

#include "scene/scene.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {

/// From a fixed direction to a hemisphere without its last degrees; every third an only angle.
inline DirectionRange random_range(RandomInputs& draw, double highest_theta) {
  const auto range = [&](double low, double high, double widest) {
    const double from = draw.uniform(low, high);
    if (draw.chance(0.3)) return AngleRange{from, from};
    return AngleRange{from, std::min(high, from + draw.uniform(0, widest))};
  };
  return {range(0, highest_theta, 60),
          draw.chance(0.3) ? AngleRange{0, 360} : range(-180, 180, 180)};
}

inline Scene random_scene(RandomInputs& draw) {
  Scene scene;
  scene.name = "random";
  scene.materials = {draw.material({})};
  for (int k = draw.integer(1, 3); k > 0; --k) {
    const auto radiance = [&] { return draw.log_uniform(0.1, 10); };
    scene.lights.push_back({random_range(draw, 85), {radiance(), radiance(), radiance()}});
  }
  for (int k = draw.integer(1, 2); k > 0; --k) scene.eyes.push_back(random_range(draw, 80));
  if (draw.chance(0.3)) scene.rotations_deg = {0, 45, draw.uniform(-400, 400)};
  scene.tolerance = draw.log_uniform(1e-4, 0.2);
  return scene;
}

/// A pair of a scene, in the frame of the cloth at a rotation, and the light's radiance.
struct ScenePair {
  DirectionPair pair;
  double rotation_deg;
  const SceneLight* light;
};

inline ScenePair random_pair(RandomInputs& draw, const Scene& scene) {
  const auto one_of = [&](const auto& list) -> const auto& {
    return list[static_cast<std::size_t>(draw.integer(0, static_cast<int>(list.size()) - 1))];
  };
  const auto in = [&](const AngleRange& range) { return draw.uniform(range.low, range.high); };
  const SceneLight& light = one_of(scene.lights);
  const DirectionRange& eye = one_of(scene.eyes);
  return {{in(light.from.theta_deg), in(light.from.phi_deg), in(eye.theta_deg), in(eye.phi_deg)},
          one_of(scene.rotations_deg),
          &light};
}

}  // namespace clothbrdf::test
