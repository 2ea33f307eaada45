#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/schema_check.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/read_picture.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

// Small enough for a second's work.
Arguments identify(const std::string& file, const Arguments& more) {
  Arguments all = {"identify", file, "--layers", "3:5", "--tie", "weft"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void check_report(const json& report) {
  CHECK_NOTHROW(check_against_schema(report, "identify_report.schema.json", "report"));
}

const json& parameter(const json& report, const std::string& name) {
  for (const json& p : report.at("parameters")) {
    if (p.at("name") == name) return p;
  }
  FAIL("no parameter " << name);
  return report;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("identify says what a table of a material would reveal") {
  const TemporaryFolder folder;
  const std::string file = (folder / "report.json").string();
  const Arguments small = {"--grid", "halfdiff3d:8x8x16", "--refits", "5", "--noise", "0.02",
                           "--fix",  "warp_fraction",     "-o",       file};
  const std::string text = output_of(identify(kSilk, small));
  CHECK(text.starts_with(kSilk + ": halfdiff3d:8x8x16, cells are points, "));
  for (const char* part :
       {"\n  noise       0.02, as given\n", " of 5 noisy tables converged\n", "predicted s.e.",
        "\n    warp.lobe_axes.0 ", "\n  layers      warp 4, weft 4", "\n  time "}) {
    CHECK_THAT(text, ContainsSubstring(part));
  }
  for (const std::string& line : lines_of(text)) {
    CHECK((line.size() <= 100 || line.starts_with(kSilk)));
  }
  const json report = json::parse(read_file(file));
  check_report(report);
  CHECK(report["noise"] == 0.02);
  CHECK(report["refits"] == 5);
  CHECK(report["layers"]["fewest"] == 3);
  CHECK(parameter(report, "warp_fraction")["verdict"] == "fixed");
  CHECK(parameter(report, "weft.scatter")["verdict"] == "tied");
  CHECK(parse_material(report["material"].dump(), "report") == read_material(kSilk));
}

TEST_CASE("identify looks at a table by way of the material that is fitted to it") {
  const TemporaryFolder folder;
  const std::string table = (folder / "silk.exr").string();
  output_of({"tabulate", kSilk, "-o", table, "--grid", "halfdiff3d:8x8x16"});
  const json report = json_of(identify(table, {"--reflectance", "microfacet", "--paths", "all",
                                               "--noise", "0.01", "--refits", "0"}));
  check_report(report);
  CHECK(report["grid"] == "halfdiff3d:8x8x16");
  CHECK(report["noise"] == 0.01);
  CHECK(report["refits"] == 0);
  CHECK(report["layers"]["warp"] == 4);
  for (const json& p : report["parameters"]) CHECK_FALSE(p.contains("observed"));
}

TEST_CASE("identify --sweep draws the map of how many layers can be told") {
  const TemporaryFolder folder;
  const std::string csv = (folder / "map.csv").string();
  const std::string png = (folder / "map.png").string();
  const Arguments sweep = identify(
      kSilk, {"--grid", "halfdiff3d:6x6x8", "--sweep", "absorption=0.05:2:3,noise=0.001:0.1:2"});
  const std::string printed = output_of(sweep);
  Arguments to_files = sweep;
  to_files.insert(to_files.end(), {"-o", csv, "-o", png});
  CHECK(output_of(to_files) == csv + ": 6 points\n" + png + ": 6 points\n");
  CHECK(read_file(csv) == printed);
  CHECK(read_png(png).width > 0);
  const std::vector<std::string> lines = lines_of(printed);
  REQUIRE(lines.size() == 7);
  CHECK(lines[0] == "absorption,noise,told_layers");

  const json map = json_of(sweep)["cells"];
  REQUIRE(map.size() == 6);
  // 0.05, sqrt(0.05 2), 2 and 0.001, 0.1, in some order.
  double absorptions = 0;
  double noises = 0;
  for (const json& cell : map) {
    absorptions += cell["absorption"].get<double>();
    noises += cell["noise"].get<double>();
    CHECK(cell["told_layers"] >= 0);
  }
  CHECK_THAT(absorptions, Catch::Matchers::WithinRel(2 * (2.05 + std::sqrt(0.1)), 1e-12));
  CHECK_THAT(noises, Catch::Matchers::WithinRel(3 * 0.101, 1e-12));
}

TEST_CASE("identify refuses what makes no sense, in one line") {
  const TemporaryFolder folder;
  const std::string table = (folder / "silk.exr").string();
  output_of({"tabulate", kSilk, "-o", table, "--grid", "halfdiff3d:4x4x4"});
  const std::string sweep = "absorption=0.05:2:3,noise=0.001:0.1:2";
  const std::string allowed = "absorption=LO:HI:N,noise=LO:HI:N, LO below HI";
  const std::string unused = (folder / "r.json").string();
  struct Bad {
    Arguments arguments;
    std::string told;
  };
  const std::vector<Bad> cases = {
      {{}, "FILE is required"},
      {{"silk.txt"}, "'.txt' is not that of a material or a table"},
      {{(folder / "none.json").string()}, "there is no such file"},
      {{table, "--grid", "inout"}, "--grid: not with a table"},
      {{table, "--cells", "point"}, "--cells: not with a table"},
      {{table, "--effects", "diffuse"}, "--effects: not with a table"},
      {{kSilk, "--paths", "all"}, "--paths: not with a material"},
      {{kSilk, "--reflectance", "both"}, "--reflectance: not with a material"},
      {{kSilk, "--grid", "cube"}, "--grid: 'cube' is not allowed"},
      {{kSilk, "--cells", "mean"}, "--cells: 'mean' is not allowed"},
      {{kSilk, "--effects", "gloss"}, "--effects: 'gloss' is not an effect"},
      {{kSilk, "--effects", "internal,no-scatter"}, "--effects: 'no-scatter' is not allowed"},
      {{kSilk, "--effects", "internal:4"}, "--effects: 'internal:4' is not allowed"},
      {{kSilk, "--fix", "gloss"}, "gloss"},
      {{kSilk, "--refits", "-1"}, "--refits: '-1' is not allowed: a whole number from 0 to"},
      {{kSilk, "--noise", "none"}, "--noise: 'none' is not allowed"},
      {{kSilk, "--starts", "3"}, "'--starts' is not an option of identify"},
      {{kSilk, "-o", (folder / "map.csv").string()}, "the ending '.csv' is not allowed: .json"},
      {{kSilk, "-o", kSilk}, kSilk + " is also read"},
      {{kSilk, "-o", unused, "-o", unused}, "is given twice"},
      {{kSilk, "--sweep", sweep, "-o", unused}, "the ending '.json' is not allowed: .csv"},
      {{kSilk, "--sweep", sweep, "--refits", "3"}, "--refits: not with --sweep"},
      {{kSilk, "--sweep", sweep, "--noise", "0.1"}, "--noise: not with --sweep"},
      {{kSilk, "--sweep", "noise=0.001:0.1:2"}, allowed},
      {{kSilk, "--sweep", sweep + ",noise=1:2:2"}, allowed},
      {{kSilk, "--sweep", sweep + ","}, allowed},
      {{kSilk, "--sweep", sweep + ":"}, allowed},
      {{kSilk, "--sweep", "absorption=2:1:2,noise=0.001:0.1:2"}, allowed},
      {{kSilk, "--sweep", "absorption=1:2,noise=0.001:0.1:2"}, allowed},
      {{kSilk, "--sweep", "absorption=0:2:2,noise=0.001:0.1:2"}, "--sweep: '0' is not allowed"},
      {{kSilk, "--sweep", "absorption=1:2:1,noise=0.001:0.1:2"}, "--sweep: '1' is not allowed"},
      {{kSilk, "--sweep", "gloss"}, allowed},
  };
  for (const auto& [arguments, told] : cases) {
    Arguments all = {"identify"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    CAPTURE(arguments);
    const Outcome outcome = run_program(all);
    CHECK(not_a_refusal(outcome, 2) == "");
    CHECK_THAT(outcome.err, ContainsSubstring(told));
  }
  CHECK(folder.entry_count() == 1);
}

}  // namespace clothbrdf::test
