#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/exr.h"
#include "formats/material_json.h"
#include "formats/plan_json.h"
#include "formats/scene_json.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

const std::string kCoat = CLOTHBRDF_SOURCE_DIR "/examples/scenes/black_wool_coat.json";

Outcome passed(const Arguments& arguments, const std::string& input = "") {
  Outcome outcome = run_program(arguments, {.input = input});
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome;
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

}  // namespace

TEST_CASE("plan says what is kept and left out, as text, as JSON and in a file") {
  const TemporaryFolder folder;
  const std::string file = (folder / "plan.json").string();
  const Outcome text = passed({"plan", kCoat, "-o", file});
  CHECK_THAT(text.out, ContainsSubstring("left out"));
  CHECK_THAT(text.out, ContainsSubstring("internal"));
  const json plan = json::parse(passed({"plan", kCoat, "--json"}).out);
  for (const char* key : {"kept", "left_out", "bound", "tolerance", "brightest"}) {
    INFO(key);
    CHECK(plan.contains(key));
  }
  CHECK(plan["bound"] <= plan["tolerance"]);
  CHECK(read_plan(file).materials.size() == 1);
}

TEST_CASE("eval --plan evaluates what the plan keeps, of the plan's material only") {
  const TemporaryFolder folder;
  const std::string plan_file = (folder / "plan.json").string();
  const std::string material_file = (folder / "wool.json").string();
  passed({"plan", kCoat, "-o", plan_file});
  const Plan plan = read_plan(plan_file);
  const Material& wool = plan.materials[0].material;
  write(material_file, material_to_json(wool));
  const Outcome outcome = passed({"eval", material_file, "--plan", plan_file}, "30 10 45 200\n");
  const json f = json::parse(outcome.out)["f_r"];
  const Components exact = ClothModel<double>(wool, plan.materials[0].effects)
                               .evaluate(pair_geometry<double>({30, 10, 45, 200}, 0.0));
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(f["total"][c].get<double>() == exact.total(c));
    CHECK(f["internal"][c].get<double>() == 0);
  }
  const Outcome other = run_program({"eval", preset("silk").string(), "--plan", plan_file});
  CHECK(other.exit_code == 2);
  CHECK_THAT(other.err, ContainsSubstring("black wool"));
  const Outcome both =
      run_program({"eval", material_file, "--plan", plan_file, "--effects", "specular"});
  CHECK(both.exit_code == 2);
  CHECK_THAT(both.err, ContainsSubstring("--effects"));
}

TEST_CASE("tabulate of a scene writes each cloth with the effects of its plan") {
  const TemporaryFolder folder;
  const std::string table = (folder / "coat.exr").string();
  const Outcome outcome = passed({"tabulate", kCoat, "-o", table, "--grid", "halfdiff4d:6x4x6x6"});
  CHECK_THAT(outcome.out, ContainsSubstring("left out: internal"));
  const Table read = exr_format().read(table);
  CHECK(!read.spec().provenance.effects.internal);
  CHECK(read.spec().provenance.effects.specular);

  // Two cloths: two files, named after them.
  json scene = json::parse(std::ifstream(kCoat));
  scene["materials"].push_back(scene["materials"][0]);
  scene["materials"][1]["name"] = "other";
  scene["output"] = (folder / "both.exr").string();
  const std::string two = (folder / "two.json").string();
  write(two, scene.dump());
  passed({"tabulate", two, "--grid", "halfdiff4d:4x4x4x4"});
  CHECK(std::filesystem::exists(folder / "both_black_wool.exr"));
  CHECK(std::filesystem::exists(folder / "both_other.exr"));
}

TEST_CASE("tabulate of a scene of tolerance 0 has the values of the material's table") {
  const TemporaryFolder folder;
  json scene = json::parse(std::ifstream(kCoat));
  scene["tolerance"] = 0;
  const std::string file = (folder / "scene.json").string();
  write(file, scene.dump());
  const Material wool = read_scene(file).materials[0];
  const std::string material_file = (folder / "wool.json").string();
  write(material_file, material_to_json(wool));
  const std::string of_scene = (folder / "scene.exr").string();
  const std::string of_material = (folder / "material.exr").string();
  for (const char* grid : {"halfdiff4d:6x4x6x6", "inout:4x6x4x6", "halfdiff3d:9x9x9"}) {
    passed({"tabulate", file, "-o", of_scene, "--grid", grid});
    passed({"tabulate", material_file, "-o", of_material, "--grid", grid});
    const Table a = exr_format().read(of_scene);
    const Table b = exr_format().read(of_material);
    CHECK(std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end()));
  }
}

TEST_CASE("scenes that contradict themselves end plan and tabulate with exit code 2") {
  const TemporaryFolder folder;
  json scene = json::parse(std::ifstream(kCoat));
  scene["lights"][0]["theta_deg"] = {0, 90};
  scene["eyes"][0]["theta_deg"] = {0, 90};
  const std::string file = (folder / "scene.json").string();
  write(file, scene.dump());
  for (const Arguments& arguments :
       {Arguments{"plan", file}, Arguments{"tabulate", file, "-o", (folder / "a.exr").string()}}) {
    const Outcome outcome = run_program(arguments);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, ContainsSubstring("/eyes/0/theta_deg"));
  }
  CHECK(!std::filesystem::exists(folder / "a.exr"));
}

}  // namespace clothbrdf::test
