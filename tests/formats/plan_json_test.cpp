#include "formats/plan_json.h"

#include <nlohmann/json.hpp>

#include "formats/material_json.h"
#include "formats/schema_check.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

// Two cloths of one scene, with limits and values that differ, and numbers that no short decimal
// has.
Plan two_cloths() {
  MaterialPlan silk;
  silk.material = read_material(preset("silk"));
  silk.effects.layers = 2;
  silk.effects.events = 5;
  silk.effects.scatter = false;
  silk.effects.cos_theta_d = 0.1 + 0.2;
  silk.kept = {"specular", "internal:2", "interreflection:5", "shadowing"};
  silk.left_out = {{"internal:2", "layers 3 to 4", 1.0 / 3000},
                   {"scatter", "scattering", 1.0 / 7000},
                   {"fresnel_angle=0.30000000000000004", "the angle", 1e-300},
                   {"diffuse", "light without direction", 0}};
  silk.bound = 1.0 / 3000 + 1.0 / 7000;
  silk.brightest = 12.345678901234567;
  silk.saving = {1.0 / 3, 0, 1};

  MaterialPlan cotton;
  cotton.material = read_material(preset("cotton"));
  cotton.effects.layers = 4;
  cotton.effects.interreflection = false;
  cotton.effects.cos_theta_d = 0.5;
  cotton.kept = {"internal:4", "diffuse", "specular"};
  cotton.left_out = {{"interreflection", "paths of three and more reflections", 0.0005},
                     {"internal:4", "layers 5 to 6", 1.0 / 9000},
                     {"fresnel_angle=0.5", "the angle", 0.001},
                     {"scatter", "scattering", 0.002}};
  cotton.bound = 0.004;
  cotton.brightest = 2.0 / 3;
  cotton.saving = {1.0 / 9, 0.5, 0.25};

  Plan plan{"two cloths", 0.005, 12.345678901234567, 12.35, 0.004, {silk, cotton}, {}};
  plan.reach.lights = {{{0, 60}, {-30.5, 1.0 / 3}}, {{30, 30}, {0, 360}}};
  plan.reach.eyes = {{{0, 0.1}, {1e6, 1e6 + 1}}};
  plan.reach.rotations_deg = {0, -45, 1.0 / 7};
  return plan;
}

void check_same(const std::vector<LeftOut>& a, const std::vector<LeftOut>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].effect == b[i].effect);
    CHECK(a[i].what == b[i].what);
    CHECK(a[i].bound == b[i].bound);
  }
}

void check_same(const MaterialPlan& a, const MaterialPlan& b) {
  CHECK(a.material == b.material);
  CHECK(a.effects == b.effects);
  CHECK(a.kept == b.kept);
  check_same(a.left_out, b.left_out);
  CHECK(a.bound == b.bound);
  CHECK(a.brightest == b.brightest);
  CHECK(a.saving.evaluation == b.saving.evaluation);
  CHECK(a.saving.cells == b.saving.cells);
  CHECK(a.saving.total == b.saving.total);
}

// What the file of two_cloths is refused with once a value, at a pointer, is another one.
std::string plan_refusal(const std::string& pointer, const json& value) {
  json file = json::parse(plan_to_json(two_cloths()));
  file[json::json_pointer(pointer)] = value;
  try {
    parse_plan(file.dump(), "plan.json");
  } catch (const InputError& error) {
    std::string message = error.what();
    CHECK(message.find_first_of("\r\n") == std::string::npos);
    return message;
  }
  return "";
}

}  // namespace

TEST_CASE("every field of a plan reads back from its file to the same bits") {
  const Plan plan = two_cloths();
  const Plan read = parse_plan(plan_to_json(plan), "plan.json");
  CHECK(read.scene == plan.scene);
  CHECK(read.tolerance == plan.tolerance);
  CHECK(read.brightest == plan.brightest);
  CHECK(read.brightest_at_most == plan.brightest_at_most);
  CHECK(read.bound == plan.bound);
  REQUIRE(read.materials.size() == plan.materials.size());
  for (std::size_t i = 0; i < plan.materials.size(); ++i) {
    check_same(read.materials[i], plan.materials[i]);
  }
  CHECK(read.reach == plan.reach);
}

TEST_CASE("a plan file says of all cloths together what some need, and what none does") {
  const json file = json::parse(plan_to_json(two_cloths()));
  CHECK_NOTHROW(check_against_schema(file, "plan.schema.json", "plan.json"));
  CHECK(file["kept"] ==
        json({"specular", "internal:4", "interreflection:5", "shadowing", "diffuse"}));
  // Of limits that of the layers that both can do without; a value that differs is not told.
  CHECK(file["left_out"] ==
        json({{{"effect", "internal:4"}, {"what", "layers 5 to 6"}, {"bound", 1.0 / 3000}},
              {{"effect", "scatter"}, {"what", "scattering"}, {"bound", 0.002}},
              {{"effect", "fresnel_angle"}, {"what", "the angle"}, {"bound", 0.001}}}));
  CHECK(file["saving"]["evaluation"] == (1.0 / 3 + 1.0 / 9) / 2);
  CHECK(file["saving"]["cells"] == 0.25);
  CHECK(file["saving"]["total"] == 0.625);
}

TEST_CASE("a plan file of one cloth says of all cloths what it says of that one") {
  Plan plan = two_cloths();
  plan.materials.pop_back();
  const json file = json::parse(plan_to_json(plan));
  for (const char* key : {"kept", "left_out", "saving"}) {
    CHECK(file[key] == file["materials"][0][key]);
  }
}

TEST_CASE("a plan file is refused in one line with pointer, value and what is allowed") {
  const auto starts = [](const std::string& pointer, const json& value, const std::string& start) {
    const std::string message = plan_refusal(pointer, value);
    CAPTURE(message, start);
    CHECK(message.starts_with("plan.json: " + start));
  };
  starts("/bond", 1, "/bond: unknown key (did you mean \"bound\"?)");
  starts("/tolerance", 2, "/tolerance: 2 is not allowed: a number from 0 to 1");
  starts("/brightest", "NaN", "/brightest: \"NaN\" is not allowed: a number of at least 0");
  starts("/materials", json::array(), "/materials: [] is not allowed");
  starts("/materials/1/effects", {"gloss"}, "/materials/1/effects: 'gloss' is not an effect");
  starts("/materials/0/effects", {"no-fresnel_angle=2"}, "/materials/0/effects: ");
  starts("/materials/1/material/warp/layers", -1, "/materials/1/material: /warp/layers: -1 ");
  starts("/materials/0/saving/cells", 1.5, "/materials/0/saving/cells: 1.5 is not allowed");
  starts("/reach/lights/0/theta_deg", {60, 0}, "/reach/lights/0/theta_deg: [60,0] is not allowed");
  starts("/reach/lights/1/theta_deg", {0, 91}, "/reach/lights/1/theta_deg/1: 91 is not allowed");
  starts("/reach/eyes/0/phi_deg", {0, 361}, "/reach/eyes/0/phi_deg: [0,361] is not allowed");
  starts("/reach/rotations_deg", json::array(), "/reach/rotations_deg: [] is not allowed");
}

}  // namespace clothbrdf::test
