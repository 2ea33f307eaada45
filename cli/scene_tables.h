#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/effects.h"
#include "model/material.h"
#include "scene/plan.h"
#include "scene/scene.h"
#include "support/progress.h"

namespace clothbrdf {

/// A cloth to make tables of, and their names.
struct ClothTables {
  Material material;
  Effects effects;
  std::vector<std::string> names;
  std::optional<MaterialPlan> plan = {};  ///< of a scene's cloth, once it is planned
  std::optional<Reach> reach = {};        ///< of a scene
};

/// Throws InputError, in one line that starts with the file's name, where a scene contradicts
/// itself.
void check_scene(const Scene& scene, const std::string& file);

/// The cloths of a scene, not planned yet, each with tables of its own: for one material the names
/// as they are, for several with "_" and the material's name before the ending. What a file's name
/// should not have becomes "_"; materials of one name are numbered from 2. Throws InputError for an
/// ending that is no table's.
std::vector<ClothTables> scene_tables(const Scene& scene, const std::vector<std::string>& names);

/// Plans the scene, and fills in what its cloths are to be evaluated with.
void plan_tables(const Scene& scene, std::vector<ClothTables>& cloths, const Workers& workers);

}  // namespace clothbrdf
