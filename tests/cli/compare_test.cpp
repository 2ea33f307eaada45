#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

void write_silk(const std::string& file, const Arguments& options) {
  Arguments all = {"tabulate", preset("silk").string(), "-o", file};
  all.insert(all.end(), options.begin(), options.end());
  output_of(all);
}

}  // namespace

TEST_CASE("compare finds a half-float table within half a unit of the last place") {
  const TemporaryFolder folder;
  const std::string a = (folder / "a.exr").string();
  const std::string b = (folder / "b.exr").string();
  write_silk(a, {"--grid", "halfdiff4d:10x6x10x10"});
  write_silk(b, {"--grid", "halfdiff4d:10x6x10x10", "--half"});
  const json told = json_of({"compare", a, b});
  CHECK(told["a"] == a);
  CHECK(told["b"] == b);
  CHECK(told["grid"] == "halfdiff4d:10x6x10x10");
  CHECK(told["only_a"] == 0);
  REQUIRE(told["channels"].size() == 3);
  const char* const names[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const json& channel = told["channels"][c];
    CHECK(channel["name"] == names[c]);
    for (const char* error : {"rms", "p99", "max"}) {
      INFO(error);
      CHECK(channel[error].get<double>() > 0);
      CHECK(channel[error].get<double>() <= 0x1p-11);
    }
    CHECK(channel["worst"]["a"] != channel["worst"]["b"]);
    CHECK_THAT(channel["worst"]["place"].get<std::string>(), ContainsSubstring("theta_h "));
  }
  const std::string text = output_of({"compare", a, b});
  CHECK(text.starts_with(b + " against " + a + ", at the nodes of halfdiff4d:10x6x10x10: "));
  for (const char* name : {"\n  R  ", "\n  G  ", "\n  B  "}) {
    CHECK_THAT(text, ContainsSubstring(name));
  }
}

TEST_CASE("compare takes tables of different grids, and says which cells only one has") {
  const TemporaryFolder folder;
  const std::string a = (folder / "a.exr").string();
  const std::string b = (folder / "b.exr").string();
  write_table(with_value(lambertian(halfdiff3d(8, 8, 8), 0.5), 3, 0, kNotMeasured), b);
  write_table(lambertian(halfdiff3d(8, 8, 8), 0.5), a);
  CHECK(json_of({"compare", a, b})["only_a"] == 1);
  CHECK_THAT(output_of({"compare", a, b}), ContainsSubstring("\n  1 more cells are in " + a));
  write_table(lambertian(inout(6, 8, 6, 8), 0.5), b);
  // Both hold the float nearest to one value.
  CHECK(json_of({"compare", a, b})["channels"][0]["max"].get<double>() < 1e-12);
}

TEST_CASE("compare refuses tables that have nothing in common, naming both") {
  const TemporaryFolder folder;
  const std::string a = (folder / "a.exr").string();
  const std::string b = (folder / "b.exr").string();
  const Table red = lambertian(halfdiff3d(4, 4, 4), 0.5);
  write_table(red, a);
  write_table(mapped(red, [](double) { return kNotMeasured; }), b);
  const Outcome no_cell = run_program({"compare", a, b});
  CHECK(not_a_refusal(no_cell, 2) == "");
  CHECK_THAT(no_cell.err, ContainsSubstring(a) && ContainsSubstring(b));
  CHECK(not_a_refusal(run_program({"compare", a, (folder / "none.exr").string()}), 2) == "");
  CHECK(not_a_refusal(run_program({"compare", a, preset("silk").string()}), 2) == "");
  CHECK(not_a_refusal(run_program({"compare", a}), 2) == "");
}

}  // namespace clothbrdf::test
