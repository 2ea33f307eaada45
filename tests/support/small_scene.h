#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

/// A light and an eye that hardly move, and silk under these names: planned at once, since without
/// a tolerance there are no bounds to find.
inline nlohmann::json small_scene(const std::vector<std::string>& names) {
  nlohmann::json scene = {
      {"name", "small"},
      {"lights", {{{"theta_deg", 30}, {"phi_deg", {0, 10}}, {"radiance", {3, 2, 1}}}}},
      {"eyes", {{{"theta_deg", {20, 25}}, {"phi_deg", 180}}}},
      {"tolerance", 0}};
  for (const std::string& name : names) {
    nlohmann::json material = nlohmann::json::parse(read_file(preset("silk")));
    material["name"] = name;
    scene["materials"].push_back(material);
  }
  return scene;
}

/// Writes a scene into a folder; its name.
inline std::string written(const TemporaryFolder& folder, const nlohmann::json& scene,
                           const std::string& name = "scene.json") {
  write_file(folder / name, scene.dump());
  return (folder / name).string();
}

/// What a run that was refused, with exit code 2, said.
inline std::string refusal(const Arguments& arguments) {
  const Outcome outcome = run_program(arguments);
  CAPTURE(arguments);
  CHECK(not_a_refusal(outcome, 2) == "");
  return outcome.err;
}

}  // namespace clothbrdf::test
