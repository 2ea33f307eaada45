#include <nlohmann/json.hpp>

#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

struct BadCommandLine {
  Arguments arguments;
  std::vector<std::string> told;  // what the message must hold
};

void check_refused(const std::vector<BadCommandLine>& cases) {
  for (const BadCommandLine& bad : cases) {
    const Outcome outcome = run_program(bad.arguments);
    CAPTURE(bad.arguments);
    CHECK(not_a_refusal(outcome, 2) == "");
    for (const std::string& words : bad.told) CHECK_THAT(outcome.err, ContainsSubstring(words));
  }
}

// Arguments of a tabulate that would write the file, were the last ones not bad.
Arguments silk_table(const std::string& file, const Arguments& bad) {
  Arguments arguments = {"tabulate", kSilk, "-o", file};
  arguments.insert(arguments.end(), bad.begin(), bad.end());
  return arguments;
}

}  // namespace

TEST_CASE("the program tells its version and its help, with an example for each command") {
  const Outcome version = run_program({"--version"});
  CHECK(version.exit_code == 0);
  CHECK(version.out.starts_with("clothbrdf 0."));
  const Outcome help = run_program({"--help"});
  CHECK(help.exit_code == 0);
  for (const std::string command :
       {"new", "eval", "tabulate", "info", "fit", "identify", "cost", "plan"}) {
    CHECK_THAT(help.out, ContainsSubstring("\n  " + command + " "));
    const Outcome more = run_program({command, "--help"});
    CAPTURE(command, more.out);
    CHECK(more.exit_code == 0);
    CHECK(more.err.empty());
    const std::size_t example = more.out.find("Example: ");
    REQUIRE(example != std::string::npos);
    CHECK_THAT(more.out.substr(example), ContainsSubstring("clothbrdf " + command + " "));
  }
}

TEST_CASE("a command line that cannot be understood is told by the word that is wrong") {
  check_refused({
      {{},
       {"a command is required: new, eval, tabulate, info, preview, check, compare, convert, fit, "
        "identify, cost",
        "clothbrdf --help"}},
      {{"frobnicate"},
       {"'frobnicate' is not a command",
        "new, eval, tabulate, info, preview, check, compare, convert, fit, identify, cost"}},
      {{"frobnicate", kSilk, "-o", "x.exr"}, {"'frobnicate' is not a command"}},
      {{"--frob"}, {"'--frob' is not an option"}},
      {{"eval"}, {"MATERIAL is required", "clothbrdf eval --help"}},
      {{"info"}, {"FILE is required", "clothbrdf info --help"}},
      {{"tabulate", kSilk}, {"--output is required", "clothbrdf tabulate --help"}},
      {{"tabulate", "-o", "x.exr"}, {"MATERIAL is required"}},
      {{"tabulate", kSilk, "-o"}, {"--output: a value is required"}},
      {{"eval", kSilk, "--pairs"}, {"--pairs: a value is required"}},
      {{"tabulate", kSilk, "--frob", "-o", "x.exr"}, {"'--frob' is not an option of tabulate"}},
      {{"tabulate", "--frob", "3"}, {"'--frob' is not an option of tabulate"}},
      {{"eval", kSilk, "more"}, {"'more' is one argument too many for eval"}},
      {{"info", kSilk, "--json", "more"}, {"'more' is one argument too many for info"}},
      {{"fr\nob"}, {"'fr?ob' is not a command"}},
  });
}

TEST_CASE("a file of an unknown ending is refused with the known ones") {
  const TemporaryFolder folder;
  for (const char* name : {"silk.txt", "silk", "silk.binary.bak", "a\nb.txt"}) {
    const std::string file = (folder / name).string();
    check_refused({{{"tabulate", kSilk, "-o", file}, {".binary (MERL), .exr (EXR)"}},
                   {{"info", file}, {".binary (MERL), .exr (EXR), "}}});
  }
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("a file that is not there or not readable is told by its name") {
  const TemporaryFolder folder;
  const std::string folder_name = folder.path().string();
  const std::string missing = (folder / "missing.json").string();
  check_refused({
      {{"eval", missing}, {missing + ": there is no such file"}},
      {{"info", missing}, {missing + ": there is no such file"}},
      {{"tabulate", missing, "-o", (folder / "x.exr").string()}, {missing}},
      {{"eval", folder_name}, {folder_name + ": is a directory"}},
      {{"eval", kSilk, "--pairs", missing}, {missing + ": cannot be read: No such file"}},
      {{"eval", kSilk, "--pairs", folder_name}, {folder_name + ": is a directory"}},
      {{"info", (folder / "missing.exr").string()}, {"missing.exr"}},
      {{"info", (folder / "missing.binary").string()}, {"missing.binary"}},
  });
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("a bad material is told by file, field, value and what is allowed") {
  const TemporaryFolder folder;
  const std::string file = (folder / "bad.json").string();
  nlohmann::json material = nlohmann::json::parse(read_file(preset("silk")));
  material.erase("$schema");
  material["warp"]["layers"] = -3;
  write_file(file, material.dump());
  for (const Arguments& arguments :
       {Arguments{"eval", file}, Arguments{"info", file},
        Arguments{"tabulate", file, "-o", (folder / "x.exr").string()}}) {
    check_refused(
        {{arguments, {file + ": /warp/layers: -3 is not allowed: an integer from 0 to"}}});
  }
  write_file(file, "{\"name\": ");
  check_refused({{{"eval", file}, {file + ": line 1"}}});
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("a table that is none is refused by info") {
  const TemporaryFolder folder;
  for (const char* name : {"x.exr", "x.binary"}) {
    for (const std::string& content : {std::string(), std::string(1000, 'x')}) {
      write_file(folder / name, content);
      check_refused({{{"info", (folder / name).string()}, {(folder / name).string() + ": "}}});
    }
  }
}

TEST_CASE("what a format cannot hold is refused with the option's name") {
  const TemporaryFolder folder;
  const std::string binary = (folder / "x.binary").string();
  check_refused({
      {silk_table(binary, {"--grid", "inout"}),
       {binary + ": the grid inout:6x48x6x48 is not allowed", "halfdiff3d:90x90x180 only"}},
      {silk_table(binary, {"--half"}), {binary + ": --half is not allowed"}},
      {silk_table(binary, {"--compress"}), {binary + ": --compress is not allowed"}},
      {silk_table(binary, {"--components"}), {binary + ": 12 channels", "R, G and B only"}},
      {silk_table((folder / "x.exr").string(), {"-o", binary, "--half"}), {binary + ": --half"}},
      {silk_table((folder / "x.exr").string(), {"--grid", "inout:1x1x1000000x1000000"}),
       {"is not allowed: its picture has 1000000000000 x 1 pixels"}},
  });
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("a bad value of an option is told with the option and what is allowed") {
  const TemporaryFolder folder;
  std::vector<BadCommandLine> cases;
  const auto refuse = [&](const std::string& option, const Arguments& values,
                          const std::string& allowed) {
    for (const std::string& value : values) {
      cases.push_back(
          {silk_table((folder / "x.exr").string(), {option, value}), {option, allowed}});
      if (!value.empty()) cases.back().told.push_back("'" + value + "'");
    }
  };
  refuse("--grid", {"", "foo", "in\bout", "inout3d"},
         "halfdiff3d[:THxTDxPD], halfdiff4d[:THxPHxTDxPD] or inout[:TIxPIxTOxPO]");
  refuse("--grid", {"inout:", "inout:0x1x1x1", "inout:1x1x1x-1", "inout:1x1x1x1 "},
         "sizes are whole numbers from 1");
  refuse("--grid", {"inout:1", "inout:1x1x1x1x1"}, "inout takes 4 sizes");
  refuse("--cells", {"", "mean", "average:", "average:0", "average:2", "average:x", "average:nan"},
         "point, average or average:REL");
  refuse("--effects", {"", "foo", "Specular", "specular;diffuse"},
         "specular, internal[:LAYERS], diffuse");
  refuse("--threads", {"", "0", "-1", "1025", "x", "1.5", "99999999999999999999"},
         "a whole number from 1 to 1024");
  for (BadCommandLine& bad : cases) {
    for (std::string& words : bad.told) std::replace(words.begin(), words.end(), '\b', '?');
  }
  check_refused(cases);
  check_refused({
      {{"eval", kSilk, "--effects", "foo"},
       {"--effects: 'foo'", "specular, internal[:LAYERS], diffuse"}},
      {silk_table("x.exr", {"--grid", "inout", "--grid", "inout"}), {"--grid: allowed only once"}},
      {silk_table("x.exr", {"--effects", "specular,,diffuse"}), {"--effects: '' is not an effect"}},
      {silk_table("x.exr", {"--dry-run=maybe"}), {"--dry-run", "maybe"}},
      {silk_table("x.exr", {"-o", "x.exr"}), {"--output: x.exr is given twice"}},
  });
  CHECK(folder.entry_count() == 0);
}

}  // namespace clothbrdf::test
