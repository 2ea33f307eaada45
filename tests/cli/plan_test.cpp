#include <nlohmann/json.hpp>
#include <string>

#include "formats/exr.h"
#include "formats/material_json.h"
#include "formats/plan_json.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/small_scene.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

const std::string kCoat = CLOTHBRDF_SOURCE_DIR "/examples/scenes/black_wool_coat.json";

}  // namespace

TEST_CASE("plan says what is kept and left out, as text, as JSON and in a file") {
  const TemporaryFolder folder;
  const std::string file = (folder / "plan.json").string();
  const std::string text = output_of({"plan", kCoat, "-o", file});
  CHECK_THAT(text, ContainsSubstring("left out"));
  CHECK_THAT(text, ContainsSubstring("internal"));
  const json plan = json_of({"plan", kCoat});
  for (const char* key : {"kept", "left_out", "bound", "tolerance", "brightest"}) {
    INFO(key);
    CHECK(plan.contains(key));
  }
  CHECK(plan["bound"] <= plan["tolerance"]);
  CHECK(read_plan(file).materials.size() == 1);
}

TEST_CASE("plan writes what it prints, refuses other endings and its own scene") {
  const TemporaryFolder folder;
  const std::string scene = written(folder, small_scene({"warp", "weft"}));
  const std::string file = (folder / "plan.json").string();
  const std::string text = output_of({"plan", scene, "-o", file});
  CHECK(output_of({"plan", scene, "--json"}) == read_file(file));
  CHECK(output_of({"plan", scene, "--threads", "1"}) == text);
  for (const char* part :
       {"small\n  tolerance ", "\n  brightest ", " reached, at most ", "\n  bound ",
        "\n  material    warp\n", "\n  material    weft\n", "\n  kept ", "\n  saving "}) {
    CHECK_THAT(text, ContainsSubstring(part));
  }
  CHECK_THAT(refusal({"plan", scene, "-o", scene}), ContainsSubstring("is also read"));
  CHECK_THAT(refusal({"plan", scene, "-o", (folder / "plan.txt").string()}),
             ContainsSubstring("the ending '.txt' is not allowed: .json"));
  CHECK_THAT(refusal({"plan", preset("silk").string()}), ContainsSubstring("silk.json: /"));
}

TEST_CASE("eval --plan evaluates each cloth of a plan with the effects of its own") {
  const TemporaryFolder folder;
  Plan plan{"two", 0.1, 1, 1, 0, {}, {{{{0, 60}, {0, 360}}}, {{{0, 60}, {0, 360}}}, {0}}};
  Effects shallow;
  shallow.layers = 1;
  shallow.scatter = false;
  Effects surface;
  surface.internal = surface.diffuse = false;
  surface.shadowing = false;
  plan.materials = {{read_material(preset("silk")), shallow, {}, {}, 0, 1, {}},
                    {read_material(preset("tamamushi")), surface, {}, {}, 0, 1, {}}};
  const std::string file = (folder / "plan.json").string();
  write_file(file, plan_to_json(plan));
  const DirectionPair pair{30, 10, 45, 200};
  for (const MaterialPlan& material : plan.materials) {
    const std::string name = preset(material.material.name).string();
    const Outcome outcome =
        run_program({"eval", name, "--plan", file}, {.input = "30 10 45 200\n"});
    CAPTURE(name, outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json f = json::parse(outcome.out)["f_r"];
    const Components expected =
        ClothModel<double>(material.material, material.effects).evaluate(pair_geometry(pair, 0.0));
    CHECK(f["specular"].get<std::vector<double>>() == expected.specular);
    CHECK(f["internal"].get<std::vector<double>>() == expected.internal);
    CHECK(f["diffuse"].get<std::vector<double>>() == expected.diffuse);
  }
  CHECK(refusal({"eval", preset("linen").string(), "--plan", file}) ==
        "clothbrdf: " + preset("linen").string() + ": is no material of " + file +
            ", which plans: silk, tamamushi\n");
  CHECK_THAT(refusal({"eval", preset("silk").string(), "--plan", file, "--effects", "specular"}),
             ContainsSubstring("--effects: not with --plan"));
}

TEST_CASE("tabulate of a scene writes each cloth with the effects of its plan") {
  const TemporaryFolder folder;
  const std::string table = (folder / "coat.exr").string();
  const std::string said =
      output_of({"tabulate", kCoat, "-o", table, "--grid", "halfdiff4d:6x4x6x6"});
  CHECK_THAT(said, ContainsSubstring("left out: internal"));
  const Table read = exr_format().read(table);
  CHECK(!read.spec().provenance.effects.internal);
  CHECK(read.spec().provenance.effects.specular);

  // Two cloths: two files, named after them.
  json scene = json::parse(read_file(kCoat));
  scene["materials"].push_back(scene["materials"][0]);
  scene["materials"][1]["name"] = "other";
  scene["output"] = (folder / "both.exr").string();
  output_of({"tabulate", written(folder, scene), "--grid", "halfdiff4d:4x4x4x4"});
  CHECK(std::filesystem::exists(folder / "both_black_wool.exr"));
  CHECK(std::filesystem::exists(folder / "both_other.exr"));
}

}  // namespace clothbrdf::test
