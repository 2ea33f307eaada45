#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "model/material.h"
#include "scene/scene.h"

namespace clothbrdf {

/// Reads a scene file (data-schemas/scene.schema.json). A material that is a path is taken from the
/// scene file's folder. Refused as material files are, with InputError in one line that names the
/// file, the JSON pointer, the value and what is allowed; what is wrong with a material file
/// follows the scene's field that names it. What contradicts itself although each value is allowed
/// is found by find_problem of scene/planner.h.
Scene read_scene(const std::filesystem::path& path);

/// The same from text; `name` stands for the file's name in errors, `folder` is that of its
/// materials.
Scene parse_scene(std::string_view text, const std::string& name,
                  const std::filesystem::path& folder);

/// Reads a file that may be either: a scene where it has the key "materials".
std::variant<Material, Scene> read_material_or_scene(const std::filesystem::path& path);

}  // namespace clothbrdf
