#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/format.h"
#include "preview/sheet.h"
#include "table/reached_cells.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/read_picture.h"
#include "tests/support/small_scene.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

const std::filesystem::path kScenes = CLOTHBRDF_SOURCE_DIR "/examples/scenes";

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

  json grazing = small_scene({"warp"});
  grazing["lights"][0] = grazing["eyes"][0] = {{"theta_deg", {0, 90}}};
  CHECK_THAT(refusal({"plan", written(folder, grazing)}),
             ContainsSubstring("scene.json: /eyes/0/theta_deg: "));
}

TEST_CASE("a scene has at most 10000 combinations of a light, an eye and a rotation") {
  const TemporaryFolder folder;
  json scene = small_scene({"warp"});
  scene["rotations_deg"] = std::vector<double>(100);
  scene["eyes"] = std::vector<json>(101, scene["eyes"][0]);
  CHECK_THAT(refusal({"plan", written(folder, scene)}),
             ContainsSubstring("scene.json: /rotations_deg: 10100 combinations of a light, an eye "
                               "and a rotation is not allowed: at most 10000"));
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

TEST_CASE("a table for a scene has the bits of the whole table where the scene reaches") {
  const TemporaryFolder folder;
  json scene = small_scene({"silk"});
  scene["lights"][0]["theta_deg"] = {10, 60};
  const std::string file = written(folder, scene);
  const std::string of_scene = (folder / "scene.exr").string();
  const std::string of_cloth = (folder / "cloth.exr").string();
  for (const char* grid : {"halfdiff4d:12x8x12x8", "inout:4x12x4x12", "halfdiff3d:18x18x18"}) {
    output_of({"tabulate", file, "-o", of_scene, "--grid", grid});
    output_of({"tabulate", preset("silk").string(), "-o", of_cloth, "--grid", grid});
    const Table part = format_for(of_scene).read(of_scene);
    const Table whole = format_for(of_cloth).read(of_cloth);
    REQUIRE(part.spec().reach);
    std::vector<std::uint8_t> reached(part.spec().cell_count(), 1);
    ReachedCells(part.spec().grid(), *part.spec().reach).restrict(reached);
    std::size_t same = 0;
    std::size_t zero = 0;
    for (std::size_t cell = 0; cell < reached.size(); ++cell) {
      const bool is_reached = reached[cell] != 0;
      CHECK(part.valid(cell) == (is_reached && whole.valid(cell)));
      for (std::size_t c = 0; c < 3; ++c) {
        REQUIRE(part.value(cell, c) == (is_reached ? whole.value(cell, c) : 0));
      }
      (is_reached ? same : zero) += 1;
    }
    INFO(grid);
    CHECK(same > 0);
    CHECK(zero > 0);
  }
}

TEST_CASE("commands that read a table know which cells are for the scene") {
  const TemporaryFolder folder;
  const std::string file = written(folder, small_scene({"silk"}));
  const std::string table = (folder / "t.exr").string();
  const std::string grid = "halfdiff3d:30x30x60";
  const std::string said = output_of({"tabulate", file, "-o", table, "--grid", grid});
  const json info = json_of({"info", table});
  const auto reached = info["cells"]["reached"].get<std::size_t>();
  CHECK(info["cells"]["valid"] <= reached);
  CHECK(reached < info["cells"]["all"]);
  CHECK(info["reach"]["eyes"][0]["theta_deg"] == json{20, 25});
  CHECK_THAT(said, ContainsSubstring(" cells are for the scene, the others hold 0)"));

  const json check = json_of({"check", table});
  CHECK(check["masked"] == 0);
  CHECK(check["not_reached"] > 0);
  CHECK(check["albedo"].empty());
  CHECK(check["problems"].empty());
  CHECK_THAT(output_of({"check", table}), ContainsSubstring("cells above the horizon are not for"));

  const std::string picture = (folder / "t.png").string();
  output_of(
      {"preview", table, "-o", picture, "--size", "32", "--light", "30,0", "--eye", "22,180"});
  const std::vector<std::uint8_t> codes = read_png(picture).values;
  std::size_t blue = 0;
  for (std::size_t p = 0; p + 2 < codes.size(); p += 3) {
    blue += codes[p + 2] > 100 && 2 * codes[p] < codes[p + 2] ? 1 : 0;
  }
  CHECK(blue > 100);

  // A format without a description cannot mark them, and says so.
  const std::string merl = (folder / "t.binary").string();
  CHECK_THAT(output_of({"tabulate", file, "-o", merl}),
             ContainsSubstring("which this format cannot tell from values"));
  output_of({"convert", table, (folder / "u.alta").string()});
  CHECK(json_of({"info", (folder / "u.alta").string()})["cells"] == info["cells"]);
  CHECK_THAT(json_of({"convert", table, merl})["lost"].dump(), ContainsSubstring("-1, the mark"));
  // Of a coarser grid the margin reaches farther: nothing is known there, and nothing is wrong.
  for (const char* name : {"v.alta", "v.exr"}) {
    const std::string coarse = (folder / name).string();
    output_of({"convert", table, coarse, "--grid", "halfdiff3d:10x10x15"});
    const json found = json_of({"check", coarse});
    CHECK(found["problems"].empty());
    CHECK(found["masked"] > 0);
    CHECK(json_of({"info", coarse})["cells"]["valid"] > 0);
  }
  CHECK_THAT(
      json_of({"convert", table, (folder / "u.bsdf").string(), "--size", "100000"})["lost"].dump(),
      ContainsSubstring("the scene: no longer told apart"));
}

}  // namespace clothbrdf::test
