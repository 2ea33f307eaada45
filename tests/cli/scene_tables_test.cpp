#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "formats/format.h"
#include "formats/material_json.h"
#include "formats/plan_json.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

const std::filesystem::path kScenes = CLOTHBRDF_SOURCE_DIR "/examples/scenes";

// A light and an eye that hardly move: planned at once.
json small_scene(const std::vector<std::string>& names) {
  json scene = {{"name", "small"},
                {"lights", {{{"theta_deg", 30}, {"phi_deg", {0, 10}}, {"radiance", {3, 2, 1}}}}},
                {"eyes", {{{"theta_deg", {20, 25}}, {"phi_deg", 180}}}},
                {"tolerance", 0}};  // no bounds: sanitizers take minutes for them
  for (const std::string& name : names) {
    json material = json::parse(read_file(preset("silk")));
    material["name"] = name;
    scene["materials"].push_back(material);
  }
  return scene;
}

std::string written(const TemporaryFolder& folder, const json& scene,
                    const std::string& name = "scene.json") {
  write_file(folder / name, scene.dump());
  return (folder / name).string();
}

std::string refusal(const Arguments& arguments) {
  const Outcome outcome = run_program(arguments);
  CAPTURE(arguments);
  CHECK(not_a_refusal(outcome, 2) == "");
  return outcome.err;
}

std::set<std::string> tables(const TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (find_format(entry.path()) != nullptr) names.insert(entry.path().filename().string());
  }
  return names;
}

}  // namespace

TEST_CASE("tables of several cloths have the cloths' names, fit for files and told apart") {
  const TemporaryFolder folder;
  const std::string scene =
      written(folder, small_scene({"warp", "a/b c", "warp", "warp_2", "", "玉虫"}));
  const std::string said =
      output_of({"tabulate", scene, "-o", (folder / "silk.exr").string(), "-o",
                 (folder / "silk.alta").string(), "--grid", "inout:2x4x2x4", "--dry-run"});
  CHECK(tables(folder).empty());
  for (const char* name : {"warp", "a_b_c", "warp_2", "warp_2_2", "material", "玉虫"}) {
    for (const char* ending : {".exr", ".alta"}) {
      CHECK_THAT(said,
                 ContainsSubstring((folder / ("silk_" + std::string(name) + ending)).string()));
    }
  }
}

TEST_CASE("the table of one cloth has the name as it is given") {
  const TemporaryFolder folder;
  json scene = small_scene({"warp"});
  scene["output"] = {(folder / "a.exr").string(), (folder / "b.exr").string()};
  const std::string file = written(folder, scene);
  output_of({"tabulate", file, "--grid", "inout:2x4x2x4"});
  CHECK(tables(folder) == std::set<std::string>{"a.exr", "b.exr"});
  // -o stands in place of the scene's own.
  output_of({"tabulate", file, "-o", (folder / "c.exr").string(), "--grid", "inout:2x4x2x4"});
  CHECK(tables(folder) == std::set<std::string>{"a.exr", "b.exr", "c.exr"});
}

TEST_CASE("tabulate of a scene says what it leaves out, and writes nothing in a dry run") {
  const TemporaryFolder folder;
  const std::string coat = (kScenes / "black_wool_coat.json").string();
  const std::string table = (folder / "coat.exr").string();
  const json plan = json_of({"plan", coat});
  const Arguments dry = {"tabulate", coat, "-o", table, "--dry-run"};
  const std::string said = output_of(dry);
  CHECK(folder.entry_count() == 0);
  CHECK_THAT(said, ContainsSubstring("not written (dry run)"));
  CHECK_THAT(said,
             ContainsSubstring("left out: " + plan["left_out"][0]["effect"].get<std::string>()));
  CHECK_THAT(said, ContainsSubstring("% of the scene's brightest)"));
  const json told = json_of(dry);
  CHECK(told["material"] == "black wool");
  CHECK(told["effects"] == plan["materials"][0]["effects"]);
  CHECK(told["bound"] == plan["bound"]);
}

TEST_CASE("what is wrong with a scene or its use is told in one line by the field or the option") {
  const TemporaryFolder folder;
  const std::string table = (folder / "t.exr").string();
  const std::string good = written(folder, small_scene({"warp"}), "good.json");
  const auto tabulate = [&](const Arguments& more) {
    Arguments arguments = {"tabulate", good};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return refusal(arguments);
  };
  CHECK_THAT(tabulate({}), ContainsSubstring("good.json: /output: missing"));
  CHECK_THAT(tabulate({"-o", table, "--effects", "specular"}),
             ContainsSubstring("--effects: not with a scene"));
  CHECK_THAT(tabulate({"-o", table, "--tolerance", "0.1"}),
             ContainsSubstring("--tolerance: not with a scene"));
  CHECK_THAT(tabulate({"-o", table, "--metric", "p99"}),
             ContainsSubstring("--metric: not with a scene"));
  CHECK_THAT(tabulate({"-o", table, "-o", table}), ContainsSubstring("is given twice"));
  CHECK_THAT(tabulate({"-o", "t.txt"}), ContainsSubstring("t.txt"));

  const auto with = [&](const std::string& pointer, const json& value) {
    json scene = small_scene({"warp"});
    scene[json::json_pointer(pointer)] = value;
    const std::string file = written(folder, scene);
    const std::string told = refusal({"plan", file});
    CHECK(refusal({"tabulate", file, "-o", table}) == told);
    const std::string start = "clothbrdf: " + file + ": ";
    CAPTURE(told);
    REQUIRE(told.starts_with(start));
    return told.substr(start.size());
  };
  CHECK(with("/eyes/0/theta_deg", 95) ==
        "/eyes/0/theta_deg: 95 is below the horizon; allowed are 0 to 90, from the cloth's "
        "normal\n");
  CHECK(with("/lights/0/theta_deg", {0, 91}).starts_with("/lights/0/theta_deg/1: 91 is below"));
  CHECK(with("/eyes/0/theta_deg", {30, 20}).starts_with("/eyes/0/theta_deg: [30,20]"));
  CHECK(with("/lights/0/radiance", {1, 2}).starts_with("/lights/0/radiance: 2 values"));
  CHECK(with("/lights/0/radiance", 0).starts_with("/lights: radiance 0 of all"));
  CHECK(with("/materials/0", "none.json")
            .starts_with("/materials/0: " + (folder / "none.json").string() +
                         ": there is no such file"));
  CHECK(with("/materials/0/warp/layers", -1).starts_with("/materials/0: /warp/layers: -1 "));
  CHECK(
      with("/tolerence", 0.1).starts_with("/tolerence: unknown key (did you mean \"tolerance\"?)"));
  CHECK(with("/rotations_deg", std::vector<double>(1025)).starts_with("/rotations_deg: "));
  CHECK(!std::filesystem::exists(table));
}

TEST_CASE("a scene has at most 10000 combinations of a light, an eye and a rotation") {
  const TemporaryFolder folder;
  json scene = small_scene({"warp"});
  scene["rotations_deg"] = std::vector<double>(100);
  scene["eyes"] = std::vector<json>(101, scene["eyes"][0]);
  CHECK_THAT(refusal({"plan", written(folder, scene)}),
             ContainsSubstring("scene.json: /rotations_deg: 100 with 1 lights and 101 eyes is not "
                               "allowed: at most 10000 combinations"));
}

TEST_CASE("without anisotropy a table is isotropic wherever the format can hold that") {
  const TemporaryFolder folder;
  const std::string silk = preset("silk").string();
  const auto spec = [&](const std::string& name, const Arguments& more) {
    const std::string file = (folder / name).string();
    Arguments arguments = {"tabulate", silk, "-o", file, "--effects", "no-anisotropy"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    output_of(arguments);
    return format_for(file).read(file).spec();
  };
  CHECK(spec("a.exr", {}).grid() == halfdiff3d());
  CHECK(spec("b.bsdf", {"--size", "100000"}).isotropic());
  CHECK(!spec("c.exr", {"--grid", "inout:2x4x2x4"}).isotropic());
  CHECK(spec("d.bin", {}).grid() == inout());  // UTIA has no other
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

}  // namespace clothbrdf::test
