#include <nlohmann/json.hpp>

#include "tests/catch.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

std::string info(const Arguments& arguments) {
  Arguments all = {"info"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Outcome outcome = run_program(all);
  CHECK(outcome.err == "");
  REQUIRE(outcome.exit_code == 0);
  return outcome.out;
}

json info_json(const std::string& file) { return json::parse(info({"--json", file})); }

void made_table(const Arguments& arguments) {
  Arguments all = {"tabulate"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  REQUIRE(run_program(all).exit_code == 0);
}

}  // namespace

TEST_CASE("info tells of a material what its yarns are") {
  const std::string file = preset("silk").string();
  const json told = info_json(file);
  CHECK(told["file"] == file);
  CHECK(told["channels"] == 3);
  CHECK(told["material"] == json::parse(read_file(file)));
  for (const char* yarn : {"warp", "weft"}) CHECK(told["diffuse_colour"][yarn].size() == 3);
  CHECK_THAT(info({file}), ContainsSubstring("\n  weights:\n    specular: 1\n"));
}

TEST_CASE("info says of the paper's convention what it is not") {
  CHECK_THAT(info_json(preset("silk_paper").string())["note"].get<std::string>(),
             ContainsSubstring("not reciprocal"));
  CHECK_THAT(info({preset("cotton_paper").string()}), ContainsSubstring("not reciprocal"));
}

TEST_CASE("info tells of an EXR table its axes, channels, cells and material") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.exr").string();
  made_table({preset("silk").string(), "--grid", "halfdiff4d:6x4x5x10", "--effects",
              "internal,diffuse", "-o", file});
  const json told = info_json(file);
  CHECK(told["file"] == file);
  CHECK(told["format"] == "EXR");
  CHECK(told["grid"] == "halfdiff4d:6x4x5x10");
  CHECK(told["value"] == "f_r, 1/sr, without the cosine");
  REQUIRE(told["axes"].size() == 4);
  CHECK(told["axes"][1]["name"] == "phi_h");
  CHECK(told["axes"][1]["cells"] == 4);
  CHECK(told["axes"][1]["from_deg"] == 0);
  CHECK(told["axes"][1]["to_deg"] == 180);
  CHECK(told["axes"][1]["first_value_at_deg"] == 22.5);
  CHECK(told["axes"][1]["last_value_at_deg"] == 157.5);
  CHECK(told["cells"]["all"] == 1200);
  CHECK(told["cells"]["valid"].get<int>() > 600);
  CHECK(told["cells"]["valid"].get<int>() < 1200);
  CHECK(told["cells"]["rule"] == "point");
  REQUIRE(told["channels"].size() == 3);
  for (const json& channel : told["channels"]) {
    CHECK(channel["lowest"].get<double>() > 0);
    CHECK(channel["lowest"] < channel["mean"]);
    CHECK(channel["mean"] < channel["highest"]);
    CHECK(channel["not_finite"] == 0);
  }
  CHECK(told["channels"][0]["name"] == "R");
  CHECK_THAT(told["made_by"].get<std::string>(), ContainsSubstring("clothbrdf "));
  CHECK(told["effects"] == "internal, diffuse");
  json material = json::parse(read_file(preset("silk")));
  material.erase("$schema");
  json held = told["material"];
  held.erase("$schema");
  CHECK(held == material);

  const std::string text = info({file});
  CHECK_THAT(text, ContainsSubstring("\ngrid: halfdiff4d:6x4x5x10\n"));
  CHECK_THAT(text, ContainsSubstring("\n  name phi_h, cells 4, "));
  CHECK_THAT(text, ContainsSubstring("\n  name B, lowest "));
}

TEST_CASE("info tells of a MERL table what the file can hold") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.binary").string();
  made_table({preset("silk").string(), "-o", file});
  const json told = info_json(file);
  CHECK(told["format"] == "MERL");
  CHECK(told["grid"] == "halfdiff3d:90x90x180");
  CHECK(told["axes"].size() == 3);
  CHECK(told["cells"]["all"] == 1'458'000);
  CHECK(told["channels"].size() == 3);
  CHECK(!told.contains("material"));
  CHECK(!told.contains("made_by"));
  CHECK_THAT(info({file}), ContainsSubstring("\nformat: MERL\n"));
}

}  // namespace clothbrdf::test
