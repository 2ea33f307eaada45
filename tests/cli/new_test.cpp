#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/colour.h"
#include "formats/material_json.h"
#include "formats/presets.h"
#include "tests/catch.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

std::string made(const Arguments& arguments) {
  Arguments all = {"new"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Outcome outcome = run_program(all);
  CHECK(outcome.err == "");
  REQUIRE(outcome.exit_code == 0);
  return outcome.out;
}

// What `new` says of a file it wrote.
std::string said(const std::string& file, const std::string& of_material) {
  std::string line = file;
  return line.append(": ").append(of_material).append("\n");
}

// That `new` refuses, says this, and leaves the folder empty.
void check_new_refused(const TemporaryFolder& folder, const Arguments& arguments,
                       const std::vector<std::string>& told, int exit_code = 2) {
  Arguments all = {"new"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  CAPTURE(all);
  const Outcome outcome = run_program(all);
  CHECK(not_a_refusal(outcome, exit_code) == "");
  for (const std::string& words : told) CHECK_THAT(outcome.err, ContainsSubstring(words));
  CHECK(folder.entry_count() == 0);
}

std::vector<double> dyed(const char* colour, const Material& material) {
  return absorption_of(parse_colour(colour).value(), material.diffuse_path);
}

}  // namespace

TEST_CASE("new without a preset lists the presets, a line each with what they are") {
  const std::string text = made({});
  const json list = json::parse(made({"--json"}));
  CHECK(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) == presets().size());
  REQUIRE(list.size() == presets().size());
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string name(presets()[k].name);
    const std::string description = read_material(preset(name)).description;
    CHECK(list[k] == json({{"name", name}, {"description", description}}));
    std::string line = name;
    line += ": " + description + "\n";
    CHECK_THAT(text, ContainsSubstring(line));
  }
}

TEST_CASE("every preset can be written, under the file's name, and tabulated") {
  const TemporaryFolder folder;
  const std::string file = (folder / "my cloth.json").string();
  for (const Preset& known : presets()) {
    const std::string name(known.name);
    CHECK(made({name, "-o", file}) == said(file, name));
    Material expected = read_material(preset(name));
    expected.name = "my cloth";
    CHECK(read_material(file) == expected);
    const Outcome outcome =
        run_program({"tabulate", file, "--dry-run", "-o", (folder / "x.exr").string()});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err == "");
  }
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("a colour is that of both yarns, and changes nothing else of them") {
  const TemporaryFolder folder;
  const std::string file = (folder / "rose.json").string();
  for (const std::string name : {"silk", "tamamushi"}) {
    CHECK(made({name, "--colour", "B03060", "-o", file}) == said(file, name + ", colour #b03060"));
    Material expected = read_material(preset(name));
    expected.name = "rose";
    expected.description += " Changed: colour #b03060.";
    expected.warp.absorption = dyed("#b03060", expected);
    expected.weft.absorption = expected.warp.absorption;
    CHECK(read_material(file) == expected);
  }
}

TEST_CASE("a yarn's own colour goes before that of both, and what no colour is given for stays") {
  const TemporaryFolder folder;
  const std::string file = (folder / "shot.json").string();
  CHECK(made({"silk", "--colour", "#b36", "--weft-colour", "#246", "-o", file}) ==
        said(file, "silk, warp colour #bb3366, weft colour #224466"));
  Material material = read_material(file);
  CHECK(material.warp.absorption == dyed("#bb3366", material));
  CHECK(material.weft.absorption == dyed("#224466", material));
  CHECK_THAT(material.description,
             ContainsSubstring(" Changed: warp colour #bb3366, weft colour #224466."));

  CHECK(made({"silk", "--warp-colour", "#b36", "--colour", "#246", "-o", file}) ==
        said(file, "silk, warp colour #bb3366, weft colour #224466"));
  const Material other_way = read_material(file);
  CHECK(other_way == material);

  CHECK(made({"silk", "--warp-colour", "#000", "-o", file}) ==
        said(file, "silk, warp colour #000000"));
  material = read_material(file);
  CHECK(material.warp.absorption == dyed("#000000", material));
  CHECK(material.weft == read_material(preset("silk")).weft);

  CHECK(made({"denim", "--weft-colour", "fff", "-o", file}) ==
        said(file, "denim, weft colour #ffffff"));
  material = read_material(file);
  CHECK(material.warp == read_material(preset("denim")).warp);
  CHECK(material.weft.absorption == std::vector<double>{0, 0, 0});
}

TEST_CASE("new says what it wrote as JSON on request") {
  const TemporaryFolder folder;
  const std::string file = (folder / "x.json").string();
  CHECK(json::parse(made({"silk", "--json", "-o", file})) ==
        json({{"file", file}, {"preset", "silk"}}));
  CHECK(json::parse(made({"silk", "--json", "--weft-colour", "#123", "-o", file})) ==
        json({{"file", file}, {"preset", "silk"}, {"weft_colour", "#112233"}}));
}

TEST_CASE("new writes nothing where the command line is wrong, and says what to mend") {
  const TemporaryFolder folder;
  const std::string file = (folder / "x.json").string();
  const std::string known = "known: cotton, cotton_paper, denim, linen, nylon, satin, silk,";
  check_new_refused(folder, {"silc", "-o", file}, {"'silc' is not a preset", known});
  check_new_refused(folder, {"", "-o", file}, {"'' is not a preset", known});
  check_new_refused(folder, {"si\nlk", "-o", file}, {"'si?lk' is not a preset"});
  check_new_refused(folder, {"-o", file}, {"PRESET is required", known});
  check_new_refused(folder, {"--colour", "#123"}, {"PRESET is required", known});
  check_new_refused(folder, {"silk"}, {"--output is required", ".json"});
  check_new_refused(folder, {"silk", "-o"}, {"--output: a value is required"});
  check_new_refused(folder, {"silk", "linen", "-o", file}, {"'linen' is one argument too many"});
  check_new_refused(folder, {"silk", "-o", file, "-o", file}, {"--output: allowed only once"});
  for (const std::string option : {"--colour", "--warp-colour", "--weft-colour"}) {
    for (const std::string value : {"", "red", "#12345", "#1234567", "#12345g", "#-1-1-1"}) {
      std::string told = option;
      told += ": '" + value + "' is not allowed: three or six hexadecimal digits";
      check_new_refused(folder, {"silk", option, value, "-o", file}, {told, "#b03060"});
    }
  }
  for (const char* name : {"x.exr", "x", ".json", "x.json.bak", "x.JSON"}) {
    const std::string wrong = (folder / name).string();
    check_new_refused(folder, {"silk", "-o", wrong}, {wrong + ": the ending '", "allowed: .json"});
  }
  check_new_refused(folder, {"silk", "-o", ""}, {"the ending '' is not that of a material"});
}

TEST_CASE("a material that cannot be written is failed work, and leaves nothing") {
  const TemporaryFolder folder;
  const std::string missing = (folder / "missing" / "x.json").string();
  check_new_refused(folder, {"silk", "-o", missing}, {missing + ": cannot write: No such file"}, 1);
}

TEST_CASE("a new material takes the place of an older file") {
  const TemporaryFolder folder;
  const std::string file = (folder / "x.json").string();
  write_file(file, std::string(100'000, 'x'));
  made({"linen", "-o", file});
  CHECK(read_material(file).warp == read_material(preset("linen")).warp);
  CHECK(folder.entry_count() == 1);
}

}  // namespace clothbrdf::test
