#pragma once

#include <string>
#include <vector>

#include "model/material.h"
#include "table/reach.h"

namespace clothbrdf {

/// Light that comes from anywhere in a range of directions.
struct SceneLight {
  DirectionRange from;
  /// Radiance times solid angle, any unit, [0, 1e30]: one value for all channels, or one a channel.
  std::vector<double> radiance = {1};

  bool operator==(const SceneLight&) const = default;
};

/// What will be seen: cloths, where lights and eyes can be in their frame, and the error that is
/// tolerable. Plain data; what a file may say is in data-schemas/scene.schema.json.
struct Scene {
  std::string name;
  std::string description;          ///< for people
  std::vector<Material> materials;  ///< all that is seen in that light
  std::vector<SceneLight> lights;
  std::vector<DirectionRange> eyes;
  std::vector<double> rotations_deg = {0};  ///< of the cloth, on top of each material's own
  /// Largest error of f cos(theta_i) radiance in any channel, as a fraction of the largest of it in
  /// the scene; [0, 1].
  double tolerance = 0;
  std::vector<std::string> outputs;  ///< tables to write where the command names none

  Reach reach() const {
    Reach reach{{}, eyes, rotations_deg};
    for (const SceneLight& light : lights) reach.lights.push_back(light.from);
    return reach;
  }
};

}  // namespace clothbrdf
