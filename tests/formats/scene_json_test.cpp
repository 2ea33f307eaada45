#include "formats/scene_json.h"

#include <filesystem>
#include <string>

#include "formats/plan_json.h"
#include "scene/planner.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/random_scene.h"

namespace clothbrdf::test {
namespace {

const std::filesystem::path kScenes = CLOTHBRDF_SOURCE_DIR "/examples/scenes";

const std::string kMaterial =
    R"({"weights": {"specular": 1, "internal": 1, "diffuse": 0.3}, "warp": {"lobe_axes": [0.1, 0.4],
        "absorption": [0.1, 0.2, 0.3], "layers": 2, "refractive_index": 1.5}})";

// A scene with one key's text changed or added.
std::string scene_with(const std::string& key, const std::string& text) {
  std::vector<std::pair<std::string, std::string>> keys = {
      {"materials", "[" + kMaterial + "]"},
      {"lights", R"([{"theta_deg": [0, 60]}])"},
      {"eyes", R"([{"theta_deg": 30, "phi_deg": [10, 20]}])"},
      {"tolerance", "0.01"}};
  bool found = false;
  std::string all;
  for (auto& [name, value] : keys) {
    if (name == key) {
      value = text;
      found = true;
    }
  }
  if (!found && !key.empty()) keys.emplace_back(key, text);
  for (const auto& [name, value] : keys) {
    all.append(all.empty() ? "{\"" : ", \"").append(name).append("\": ").append(value);
  }
  return all + "}";
}

std::string complaint(const std::string& text) {
  try {
    parse_scene(text, "scene.json", ".");
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a scene file says where lights and eyes are, with defaults for the rest") {
  const Scene scene = parse_scene(scene_with("", ""), "scene.json", ".");
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].from == DirectionRange{{0, 60}, {0, 360}});
  CHECK(scene.lights[0].radiance == std::vector<double>{1});
  CHECK(scene.eyes == std::vector<DirectionRange>{{{30, 30}, {10, 20}}});
  CHECK(scene.rotations_deg == std::vector<double>{0});
  CHECK(scene.tolerance == 0.01);
  CHECK(scene.outputs.empty());
  CHECK(parse_scene(scene_with("output", "\"a.exr\""), "", ".").outputs ==
        std::vector<std::string>{"a.exr"});
  CHECK(parse_scene(scene_with("rotations_deg", "[0, -45]"), "", ".").rotations_deg ==
        std::vector<double>{0, -45});
}

TEST_CASE("the example scenes can be planned") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    INFO(entry.path());
    const Scene scene = read_scene(entry.path());
    CHECK(!find_problem(scene));
    CHECK(!scene.name.empty());
    CHECK(!scene.description.empty());
    ++scenes;
  }
  CHECK(scenes == 5);
}

TEST_CASE("a scene that contradicts itself is refused by a line that names the field") {
  const auto names = [](const std::string& key, const std::string& text, const std::string& field) {
    const std::string line = complaint(scene_with(key, text));
    INFO(line);
    CHECK(line.find("scene.json: " + field) == 0);
    CHECK(line.find('\n') == std::string::npos);
  };
  names("tolerance", "-0.1", "/tolerance");
  names("tolerance", "1.5", "/tolerance");
  names("tolerance", "\"NaN\"", "/tolerance");
  names("eyes", R"([{"theta_deg": 100}])", "/eyes/0/theta_deg");
  names("eyes", R"([{"theta_deg": [0, 91]}])", "/eyes/0/theta_deg");
  names("eyes", R"([{"theta_deg": [40, 30]}])", "/eyes/0/theta_deg");
  names("eyes", R"([{"phi_deg": 0}])", "/eyes/0");
  names("eyes", "[]", "/eyes");
  names("lights", R"([{"theta_deg": 10, "phi_deg": [0, 400]}])", "/lights/0/phi_deg");
  names("lights", R"([{"theta_deg": 10, "phi_deg": [20, 10]}])", "/lights/0/phi_deg");
  names("lights", R"([{"theta_deg": 10, "radiance": -1}])", "/lights/0/radiance");
  names("materials", R"(["nothing.json"])", "/materials/0");
  names("materials", R"([{"weights": {}}])", "/materials/0");
  names("rotations_deg", "[]", "/rotations_deg");
  names("shine", "1", "/shine");
  CHECK(complaint(scene_with("tolerance", "NaN")).find("scene.json: ") == 0);
}

TEST_CASE("a plan reads back from its file to the last bit") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 5; ++n) {
    Scene scene = random_scene(draw);
    scene.materials.push_back(draw.material({}));
    for (Material& material : scene.materials) material.name = "cloth " + std::to_string(n);
    const Plan plan = make_plan(scene, 2);
    const std::string text = plan_to_json(plan);
    const Plan read = parse_plan(text, "plan.json");
    CHECK(plan_to_json(read) == text);
    REQUIRE(read.materials.size() == 2);
    for (std::size_t m = 0; m < 2; ++m) {
      CHECK(read.materials[m].material == plan.materials[m].material);
      CHECK(read.materials[m].effects == plan.materials[m].effects);
      CHECK(read.materials[m].bound == plan.materials[m].bound);
    }
    CHECK(read.brightest == plan.brightest);
    CHECK(read.reach == plan.reach);
  }
}

}  // namespace clothbrdf::test
