#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/schema_check.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"
#include "tests/support/read_picture.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

// Of silk, small, with the conventions given: a second's work.
std::string silk_table(const TemporaryFolder& folder) {
  std::string file = (folder / "silk.exr").string();
  output_of({"tabulate", preset("silk").string(), "-o", file, "--grid", "halfdiff3d:12x12x24"});
  return file;
}

Arguments fit(const std::string& table, const Arguments& more) {
  Arguments all = {"fit",      table, "--reflectance", "microfacet", "--paths", "all",
                   "--layers", "3:5", "--starts",      "4",          "--tie",   "weft"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

json report_of(const std::filesystem::path& file) {
  json report = json::parse(read_file(file));
  CHECK_NOTHROW(check_against_schema(report, "fit_report.schema.json", file.string()));
  return report;
}

struct BadFit {
  Arguments options;
  std::string told;
};

}  // namespace

TEST_CASE("fit finds the material of a table that was made from one") {
  const TemporaryFolder folder;
  const std::string table = silk_table(folder);
  const std::string fitted = (folder / "fitted.json").string();
  const std::string picture = (folder / "slices.png").string();
  const std::string text =
      output_of(fit(table, {"-o", (folder / "report.json").string(), "--material", fitted,
                            "--picture", picture, "--noise", "0.001"}));
  CHECK(text.starts_with(table + ": halfdiff3d:12x12x24, cells are points\n"));
  for (const char* part : {"\n  solver ", "\n  noise       0.001 of the value, as given",
                           "\n  conventions\n", "\n    warp.lobe_axes.0 ", "\n  layers      warp 4",
                           "\n  starts ", "\n  residuals\n", "\n  time ", "\n  written "}) {
    CHECK_THAT(text, ContainsSubstring(part));
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    CHECK((line.size() <= 100 || line.find(folder.path().string()) != std::string::npos));
  }

  const json report = report_of(folder / "report.json");
  CHECK(report["table"] == table);
  CHECK(report["converged"] == true);
  CHECK(report["layers"]["warp"] == 4);
  CHECK(report["noise_estimated"] == false);
  // Stored as 32-bit floats.
  CHECK(report["residual_rms"].get<double>() < 1e-6);
  const Material material = read_material(fitted);
  CHECK(material == parse_material(report["material"].dump(), "report"));
  CHECK(material.name == "fitted");
  CHECK(material.description == "Fitted to silk.exr.");
  CHECK(read_png(picture).width > 0);

  // The same table comes from it.
  const std::string again = (folder / "again.exr").string();
  output_of({"tabulate", fitted, "-o", again, "--grid", "halfdiff3d:12x12x24"});
  const json compared = json_of({"compare", table, again});
  for (const json& channel : compared["channels"]) {
    CHECK(channel["rms"].get<double>() < 1e-6);
  }
}

TEST_CASE("fit --json prints the report that -o writes, and a fit file sets the same options") {
  const TemporaryFolder folder;
  const std::string table = silk_table(folder);
  const std::string file = (folder / "report.json").string();
  const json by_options =
      json_of(fit(table, {"--fix", "warp.refractive_index=1.55", "--free", "scatter=0:0.2",
                          "--start", "diffuse_path=1.5", "--seed", "3", "-o", file}));
  CHECK(by_options == report_of(file));
  CHECK(by_options["noise_estimated"] == true);
  write_file(folder / "fit.json", R"({"reflectance": "microfacet", "paths": "all",
      "layers": [3, 5], "starts": 4, "seed": 3,
      "parameters": {"weft": {"tie": true}, "warp.refractive_index": {"fix": 1.55},
                     "scatter": {"free": [0, 0.2]}, "diffuse_path": {"start": 1.5}}})");
  json by_file = json_of({"fit", table, "--options", (folder / "fit.json").string()});
  for (json report : {by_options, by_file}) {
    for (const json& p : report["parameters"]) {
      if (p["name"] == "warp.refractive_index") {
        CHECK(p["verdict"] == "fixed");
        CHECK_THAT(p["value"].get<double>(), Catch::Matchers::WithinRel(1.55, 1e-12));
      }
      if (p["name"] == "warp.scatter") {
        CHECK_THAT(p["highest"].get<double>(), Catch::Matchers::WithinRel(0.2, 1e-12));
      }
      if (p["name"] == "weft.lobe_axes.0") CHECK(p["verdict"] == "tied");
    }
    CHECK(report["layers"]["fewest"] == 3);
    CHECK(report["layers"]["most"] == 5);
    CHECK(report["conventions"].size() == 1);
    CHECK(report["starts"] <= 4);
  }
}

TEST_CASE("of options for one parameter the last counts, and the command line before the file") {
  const TemporaryFolder folder;
  const std::string table = silk_table(folder);
  write_file(folder / "fit.json", R"({"parameters": {"warp.scatter": {"fix": 0.25}}})");
  const std::string file = (folder / "fit.json").string();
  const auto verdict = [&](const Arguments& more) {
    const json report = json_of(fit(table, more));
    for (const json& p : report["parameters"]) {
      if (p["name"] == "warp.scatter") return p["verdict"].get<std::string>();
    }
    return std::string("not there");
  };
  CHECK(verdict({"--options", file}) == "fixed");
  CHECK(verdict({"--options", file, "--free", "warp.scatter"}) != "fixed");
  CHECK(verdict({"--free", "warp.scatter", "--fix", "warp.scatter=0.1"}) == "fixed");
  CHECK(verdict({"--fix", "warp.scatter=0.1", "--free", "warp"}) != "fixed");
}

TEST_CASE("a fit says which effects its table was made without") {
  const TemporaryFolder folder;
  const std::string table = (folder / "t.exr").string();
  const auto notes = [&](const std::string& effects) {
    output_of({"tabulate", preset("silk").string(), "-o", table, "--grid", "halfdiff3d:8x8x8",
               "--effects", effects});
    const std::string report = (folder / "r.json").string();
    run_program(fit(table, {"-o", report}));
    return report_of(report).at("notes").dump();
  };
  CHECK_THAT(notes("specular,internal:3,diffuse,no-scatter"),
             ContainsSubstring("the table was made with internal:3, no-scatter; the fit has the "
                               "effects that these leave out"));
  CHECK(notes("specular,internal,diffuse").find("was made with") == std::string::npos);
}

TEST_CASE("fit of a table without a single value exits 1, with a report and no material") {
  const TemporaryFolder folder;
  const std::string table = (folder / "masked.exr").string();
  write_table(mapped(lambertian(halfdiff3d(8, 8, 8), 0.5), [](double) { return kNotMeasured; }),
              table);
  const std::string file = (folder / "report.json").string();
  const std::string fitted = (folder / "fitted.json").string();
  const Outcome outcome = run_program({"fit", table, "-o", file, "--material", fitted});
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.err.starts_with("clothbrdf: " + table + ": "));
  CHECK(outcome.err.ends_with("; not written: " + fitted + "\n"));
  CHECK_THAT(outcome.out, ContainsSubstring("\n  failure "));
  const json report = report_of(file);
  CHECK(report["failure"] != "");
  CHECK(report["converged"] == false);
  CHECK_FALSE(report.contains("material"));
  CHECK_FALSE(std::filesystem::exists(fitted));
}

TEST_CASE("fit refuses options that make no sense, in one line that says what is allowed") {
  const TemporaryFolder folder;
  const std::string table = silk_table(folder);
  const std::string silk = preset("silk").string();
  const std::string none = (folder / "none.json").string();
  const std::string bad = (folder / "bad.json").string();
  const std::string odd = (folder / "odd.json").string();
  write_file(bad, R"({"layers": [0, 99]})");
  write_file(odd, R"({"parameters": {"warp.gloss": {"fix": 1}}})");
  const std::size_t files = folder.entry_count();
  const std::vector<BadFit> cases = {
      {{"--fix", "gloss"}, "gloss"},
      {{"--fix", "=1"}, "--fix: '=1' is not allowed: NAME or NAME=VALUE, VALUE a number"},
      {{"--fix", "warp.scatter=x"}, "--fix: 'warp.scatter=x' is not allowed: "},
      {{"--fix", "warp.scatter=nan"}, "--fix: 'warp.scatter=nan' is not allowed: "},
      {{"--fix"}, "--fix: a value is required"},
      {{"--free", "warp.scatter=0.1"}, "NAME or NAME=LO:HI, two numbers, LO below HI"},
      {{"--free", "warp.scatter=0.2:0.1"}, "--free: 'warp.scatter=0.2:0.1' is not allowed: "},
      {{"--tie", "weft=1"}, "--tie: 'weft=1' is not allowed: NAME"},
      {{"--start", none}, none + ": there is no such file"},
      {{"--start", silk, "--start", silk}, "is a second material; one is allowed"},
      {{"--start", "warp.scatter="}, "--start: 'warp.scatter=' is not allowed: "},
      {{"--layers", "4"}, "--layers: '4' is not allowed: LO:HI"},
      {{"--layers", "5:4"}, "LO not above HI"},
      {{"--layers", "0:65"}, "--layers: '65' is not allowed: a whole number from 0 to 64"},
      {{"--paths", "some"}, "--paths: 'some' is not allowed: all, single, both"},
      {{"--reflectance", ""}, "--reflectance: '' is not allowed: microfacet, paper, both"},
      {{"--noise", "0"}, "--noise: '0' is not allowed: a number from "},
      {{"--weighting", "log"}, "relative, absolute, logarithmic"},
      {{"--loss", "l1"}, "--loss: 'l1' is not allowed: squared, huber, cauchy"},
      {{"--starts", "-1"}, "--starts: '-1' is not allowed: a whole number from 1 to 10000"},
      {{"--seed", "1e16"}, "--seed: '1e16' is not allowed: a whole number from 0 to "},
      {{"--threads", "0"}, "--threads: "},
      {{"--options", none}, none + ": there is no such file"},
      {{"--options", bad}, bad + ": /layers/1: 99 is not allowed"},
      {{"--options", odd}, odd + ": /parameters: "},
      {{"--options", bad, "--options", bad}, "--options"},
      {{"-o", (folder / "r.exr").string()}, "the ending '.exr' is not allowed: .json"},
      {{"--material", (folder / "r").string()}, "--material: "},
      {{"--picture", (folder / "r.jpg").string()}, "r.jpg"},
      {{"--picture", table}, "is also read; it needs another name"},
      {{"-o", none, "--material", none}, "--material: " + none + " is given twice"},
      {{"--start", silk, "--material", silk}, silk + " is also read"},
      {{"more"}, "'more' is one argument too many for fit"},
  };
  for (const auto& [options, told] : cases) {
    Arguments all = {"fit", table};
    all.insert(all.end(), options.begin(), options.end());
    const Outcome outcome = run_program(all);
    CAPTURE(options);
    CHECK(not_a_refusal(outcome, 2) == "");
    CHECK_THAT(outcome.err, ContainsSubstring(told));
  }
  CHECK(folder.entry_count() == files);
  CHECK(not_a_refusal(run_program({"fit", silk}), 2) == "");
  CHECK(not_a_refusal(run_program({"fit"}), 2) == "");
  // Before any work.
  CHECK(not_a_refusal(run_program({"fit", table, "-o", (folder / "no" / "r.json").string()}), 1) ==
        "");
}

TEST_CASE("the material fitted to a spectral table has the table's wavelengths") {
  const TemporaryFolder folder;
  Material material = read_material(preset("silk"));
  material.wavelengths_nm = {450, 650.5};
  material.warp.absorption = material.weft.absorption = {0.1, 0.4};
  const std::string source = (folder / "source.json").string();
  const std::string table = (folder / "spectral.exr").string();
  const std::string fitted = (folder / "fitted.json").string();
  write_file(source, material_to_json(material));
  output_of({"tabulate", source, "-o", table, "--grid", "halfdiff3d:12x12x24"});
  output_of(fit(table, {"--material", fitted}));
  CHECK(read_material(fitted).wavelengths_nm == material.wavelengths_nm);
}

TEST_CASE("a fitted material that no material file can hold is told where one is asked for") {
  const TemporaryFolder folder;
  const std::string table = (folder / "grey.exr").string();
  const std::string fitted = (folder / "fitted.json").string();
  write_table(lambertian(halfdiff3d(8, 8, 8), 0.5), table);
  const Outcome outcome =
      run_program({"fit", table, "--fix", "weights.specular=0", "--fix", "weights.internal=0",
                   "--layers", "1:1", "--starts", "1", "--material", fitted});
  CHECK(outcome.exit_code == 1);
  CHECK_THAT(outcome.err, ContainsSubstring("; not written: " + fitted));
  CHECK_FALSE(std::filesystem::exists(fitted));
}

TEST_CASE("fit refuses a start that has not as many channels as the table") {
  const TemporaryFolder folder;
  const std::string table = (folder / "grey.exr").string();
  write_table(lambertian(halfdiff3d(8, 8, 8), 0.5), table);
  const std::string silk = preset("silk").string();
  const Outcome outcome = run_program({"fit", table, "--start", silk});
  CHECK(not_a_refusal(outcome, 2) == "");
  CHECK_THAT(outcome.err, ContainsSubstring(silk + ": /warp/absorption: 3 values are not allowed: "
                                                   "the table has 1 channels"));
}

}  // namespace clothbrdf::test
