#pragma once

#include <optional>
#include <string>

#include "scene/plan.h"
#include "scene/scene.h"
#include "support/progress.h"

namespace clothbrdf {

/// A contradiction in a scene: JSON pointer of the field, its value and what is allowed.
struct SceneProblem {
  std::string pointer;
  std::string value;
  std::string allowed;
};

/// The first contradiction; none in a scene that can be planned.
std::optional<SceneProblem> find_problem(const Scene& scene);

/// The cheapest set of effects whose summed bounds stay within the scene's tolerance. Throws
/// std::invalid_argument for a scene with a problem, WorkError where nothing of the scene is lit,
/// Cancelled.
Plan make_plan(const Scene& scene, Workers workers);

}  // namespace clothbrdf
