#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Checks a file in which something is wrong: the whole report on standard output, one line of it on
// standard error, exit code 1. Returns the report.
std::string check_report(const std::string& file) {
  const Outcome outcome = run_program({"check", file});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 1);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  CHECK(outcome.err.starts_with("clothbrdf: " + file + ": "));
  CHECK_THAT(outcome.out, ContainsSubstring("  WRONG "));
  CHECK_THAT(outcome.out, ContainsSubstring("largest albedo"));
  CHECK_THAT(outcome.out, !ContainsSubstring("nothing wrong"));

  const Outcome as_json = run_program({"check", "--json", file});
  CHECK(as_json.exit_code == 1);
  CHECK(as_json.err == outcome.err);
  const json told = json::parse(as_json.out);
  CHECK(!told["problems"].empty());
  CHECK(outcome.err.find(told["problems"][0].get<std::string>()) != std::string::npos);
  return outcome.out;
}

}  // namespace

TEST_CASE("check finds nothing wrong in the presets' tables") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.exr").string();
  for (const char* name : {"silk", "cotton", "tamamushi", "silk_paper"}) {
    output_of({"tabulate", preset(name).string(), "--grid", "halfdiff4d:16x8x16x16", "-o", file});
    INFO(name);
    const std::string text = output_of({"check", file});
    CHECK_THAT(text, ContainsSubstring("nothing wrong\n"));
    CHECK_THAT(text, ContainsSubstring("halfdiff4d:16x8x16x16, 32,768 cells of 3 channels\n"));
  }
}

TEST_CASE("check --json tells all that was looked at") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.exr").string();
  output_of({"tabulate", preset("silk").string(), "--grid", "inout:3x4x3x4", "-o", file});
  const json told = json_of({"check", file});
  CHECK(told["file"] == file);
  CHECK(told["grid"] == "inout:3x4x3x4");
  CHECK(told["cells"] == 144);
  CHECK(told["below_horizon"] == 0);
  CHECK(told["masked"] == 0);
  for (const char* flaw : {"not_finite", "negative", "below_horizon_not_zero"}) {
    CHECK(told[flaw]["count"] == 0);
    CHECK(!told[flaw].contains("worst"));
  }
  CHECK(told["reciprocity"]["promised"] == true);
  CHECK(told["reciprocity"]["by_construction"] == false);
  CHECK(told["reciprocity"]["compared"] == 66);
  CHECK(told["reciprocity"]["allowed"].get<double>() < 0x1p-21);
  CHECK(told["albedo"].size() == 13);
  CHECK(told["albedo"][12]["theta_i"] == 60);
  CHECK(told["largest_albedo"]["albedo"].get<double>() > 0.4);
  CHECK(told["notes"].empty());
  CHECK(told["problems"].empty());
}

TEST_CASE("check finds a value that is no number, and a negative one") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.exr").string();
  const Table clean = preset_table("cotton", halfdiff3d(6, 6, 6));
  write_table(with_value(clean, 9, 1, kNan), file);
  CHECK_THAT(check_report(file),
             ContainsSubstring("not finite: 1 values; the first is nan in G at " +
                               clean.spec().grid().place(9)));
  write_table(with_value(clean, 9, 2, -0.25), file);
  CHECK_THAT(check_report(file),
             ContainsSubstring("negative: 1 values; the lowest is -0.25 in B at "));
  write_table(with_value(with_value(clean, 9, 2, -0.25), 8, 0, kNan), file);
  check_report(file);
  CHECK_THAT(run_program({"check", file}).err, ContainsSubstring(" (and 1 more)\n"));
}

TEST_CASE("check finds a reciprocity break, of half floats only one beyond their rounding") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.exr").string();
  const Table clean = preset_table("silk", inout(3, 4, 3, 4));
  const std::size_t cell =
      clean.spec().grid().cell_of(direction(30.0, 90.0), direction(60.0, 0.0)).value();
  write_table(with_value(clean, cell, 0, clean.value(cell, 0) * 1.0001), file);
  CHECK_THAT(check_report(file), ContainsSubstring("reciprocity: f(wi,wo) and f(wo,wi) differ by"));
  const WriteOptions half{.half = true, .compress = false, .workers = 1};
  write_table(with_value(clean, cell, 0, clean.value(cell, 0) * 1.0001), file, half);
  CHECK_THAT(output_of({"check", file}), ContainsSubstring("nothing wrong"));
  write_table(with_value(clean, cell, 0, clean.value(cell, 0) * 1.01), file, half);
  CHECK(run_program({"check", file}).exit_code == 1);
}

TEST_CASE("check says of the paper's convention that it is not reciprocal, and does not mind") {
  const TemporaryFolder folder;
  const std::string file = (folder / "table.exr").string();
  output_of({"tabulate", preset("cotton_paper").string(), "--grid", "inout:3x4x3x4", "-o", file});
  CHECK_THAT(output_of({"check", file}), ContainsSubstring("not reciprocal: f(wi,wo)"));
}

TEST_CASE("check finds more light out than in") {
  const TemporaryFolder folder;
  json material = json::parse(read_file(preset("cotton")));
  material["weights"]["diffuse"] = 100;
  write_file(folder / "bright.json", material.dump());
  const std::string file = (folder / "table.exr").string();
  output_of({"tabulate", (folder / "bright.json").string(), "--grid", "halfdiff4d:12x6x12x12", "-o",
             file});
  const std::string report = check_report(file);
  CHECK_THAT(report, ContainsSubstring("albedo: "));
  CHECK_THAT(report, ContainsSubstring(" is above 1.01\n"));
}

TEST_CASE(
    "check holds a material's evaluations to extended precision where numbers get difficult") {
  const std::string silk = preset("silk").string();
  const std::string text = output_of({"check", silk});
  CHECK_THAT(text, ContainsSubstring("hard pairs of directions, against extended precision"));
  const json told = json_of({"check", silk});
  CHECK(told["evaluations"].size() == 4);
  for (const json& evaluation : told["evaluations"]) {
    CAPTURE(evaluation.dump());
    CHECK(evaluation["worst_share"] > 0);
    CHECK(evaluation["worst_share"] <= 1);
    CHECK(evaluation["values"] > 400);
    CHECK_THAT(text, ContainsSubstring(evaluation["evaluation"].get<std::string>()));
  }
}

TEST_CASE("check refuses what it cannot read") {
  const TemporaryFolder folder;
  CHECK(not_a_refusal(run_program({"check", (folder / "none.exr").string()}), 2) == "");
  write_file(folder / "no.json", "{}");
  CHECK(not_a_refusal(run_program({"check", (folder / "no.json").string()}), 2) == "");
  CHECK(not_a_refusal(run_program({"check"}), 2) == "");
  CHECK(not_a_refusal(run_program({"check", "a.exr", "b.exr"}), 2) == "");
  CHECK(not_a_refusal(run_program({"check", "a.exr", "--threads", "0"}), 2) == "");
}

}  // namespace clothbrdf::test
