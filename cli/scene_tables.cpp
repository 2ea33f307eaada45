#include "cli/scene_tables.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "cli/file_options.h"
#include "scene/planner.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

// Letters, digits, '-', '_' and all beyond ASCII; as much as leaves room in a file's name.
std::string safe_name(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  std::string safe;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool first_of_character = (byte & 0xC0U) != 0x80U;
    if (safe.size() >= kLongest && first_of_character) break;
    safe += byte >= 0x80U || std::isalnum(byte) != 0 || c == '-' ? c : '_';
  }
  return safe.empty() ? "material" : safe;
}

std::vector<std::string> suffixes(const std::vector<Material>& materials) {
  std::set<std::string> taken;
  std::vector<std::string> all;
  for (const Material& material : materials) {
    const std::string name = safe_name(material.name);
    std::string suffix = name;
    for (int number = 2; !taken.insert(suffix).second; ++number) {
      suffix = name + "_" + std::to_string(number);
    }
    all.push_back("_" + suffix);
  }
  return all;
}

}  // namespace

void check_scene(const Scene& scene, const std::string& file) {
  if (const std::optional<SceneProblem> problem = find_problem(scene)) {
    throw InputError(file + ": " + problem->pointer + ": " + problem->value +
                     " is not allowed: " + problem->allowed);
  }
}

std::vector<ClothTables> scene_tables(const Scene& scene, const std::vector<std::string>& names) {
  if (scene.materials.size() == 1) return {{scene.materials.front(), {}, names, {}, scene.reach()}};
  const std::vector<std::string> endings = suffixes(scene.materials);
  std::vector<ClothTables> cloths;
  for (const Material& material : scene.materials) {
    ClothTables cloth{material, {}, {}, {}, scene.reach()};
    for (const std::string& name : names) {
      cloth.names.push_back(with_suffix(name, endings[cloths.size()]));
    }
    cloths.push_back(cloth);
  }
  return cloths;
}

void plan_tables(const Scene& scene, std::vector<ClothTables>& cloths, const Workers& workers) {
  const Plan plan = make_plan(scene, workers);
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    cloths[i].effects = plan.materials[i].effects;
    cloths[i].plan = plan.materials[i];
  }
}

}  // namespace clothbrdf
