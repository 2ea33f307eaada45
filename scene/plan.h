#pragma once

#include <string>
#include <vector>

#include "model/effects.h"
#include "model/material.h"
#include "table/reach.h"

namespace clothbrdf {

/// An effect that a scene can do without.
struct LeftOut {
  std::string effect;  ///< as in --effects, without "no-": "scatter", "internal:2"
  std::string what;    ///< for people: "layers 3 to 6"
  double bound = 0;    ///< no pair of the scene's directions errs by more, fraction of brightest
};

/// What leaving out saves, 0 to 1, as predicted.
struct Saving {
  double evaluation = 0;  ///< of the work for a pair of directions
  double cells = 0;       ///< of the cells of a table of equal resolution, above the horizon
  double total = 0;       ///< of the work for a table
};

/// What must be simulated of one material.
struct MaterialPlan {
  Material material;
  Effects effects;                ///< to evaluate it with
  std::vector<std::string> kept;  ///< names of effects, with their limits
  std::vector<LeftOut> left_out;
  double bound = 0;      ///< of all that is left out: the sum of theirs
  double brightest = 0;  ///< of this material
  Saving saving;
};

/// What must be simulated of a scene, and how much is proven to be lost with the rest.
struct Plan {
  std::string scene;
  double tolerance = 0;
  /// Largest f cos(theta_i) radiance over materials, directions and channels, in the lights' unit:
  /// a value that is reached, at most 0.1 % below the true maximum.
  double brightest = 0;
  double brightest_at_most = 0;  ///< proven: no value of the scene is larger
  double bound = 0;              ///< the largest of the materials'
  std::vector<MaterialPlan> materials;
  Reach reach;  ///< the directions of which this is true
};

}  // namespace clothbrdf
