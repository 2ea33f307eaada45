#include <algorithm>
#include <regex>

#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/small_scene.h"
#include "tests/support/writers.h"

// Everything that several threads do, small: what they do must not depend on their number. Under
// the thread sanitizer a program in which two of them are in each other's way fails.

namespace clothbrdf::test {
namespace {

// More than there are processors, so that they wait for each other at odd places.
const std::string kMany = "4";

// What the command writes and prints with so many threads.
struct Results {
  std::string file;
  std::string out;
};
// "FILE" stands for a file of this name in the folder.
Results results(const TemporaryFolder& folder, Arguments arguments, const std::string& name,
                const std::string& threads) {
  const std::filesystem::path file = folder / name;
  std::filesystem::remove(file);
  std::replace(arguments.begin(), arguments.end(), std::string("FILE"), file.string());
  arguments.insert(arguments.end(), {"--threads", threads});
  const std::string out = output_of(arguments);
  return {std::filesystem::exists(file) ? read_file(file) : "", out};
}

void check_alike(const Arguments& arguments, const std::string& name = "none") {
  CAPTURE(arguments);
  const TemporaryFolder folder;
  const Results one = results(folder, arguments, name, "1");
  const Results many = results(folder, arguments, name, kMany);
  CHECK((one.file == many.file));
  // Where it tells how long it took, that differs.
  const std::regex time("[0-9.]+ m?s");
  CHECK(std::regex_replace(one.out, time, "time") == std::regex_replace(many.out, time, "time"));
}

// A table of silk.
std::string silk_table(const TemporaryFolder& folder, const std::string& grid) {
  std::string file = (folder / "silk.exr").string();
  output_of({"tabulate", kSilk, "--grid", grid, "-o", file});
  return file;
}

}  // namespace

TEST_CASE("any number of threads writes the same file, in every format") {
  for (const Writer& writer : writers()) {
    Arguments arguments = writer.arguments;
    const auto threads = std::find(arguments.begin(), arguments.end(), "--threads");
    if (threads == arguments.end()) continue;  // it has but one
    arguments.erase(threads, threads + 2);
    arguments.emplace_back("FILE");
    check_alike(arguments, writer.name);
  }
}

TEST_CASE("any number of threads computes the same values, by every kind of evaluation") {
  for (const Arguments& kind : {Arguments{"--grid", "halfdiff4d:6x5x6x7"},
                                {"--grid", "inout:4x6x4x6"},
                                {"--grid", "halfdiff3d:6x6x8", "--isotropic"},
                                {"--grid", "halfdiff3d:4x4x4", "--cells", "average:0.05"}}) {
    Arguments arguments = {"tabulate", kSilk, "-o", "FILE"};
    arguments.insert(arguments.end(), kind.begin(), kind.end());
    check_alike(arguments, "table.exr");
  }
}

TEST_CASE("any number of threads draws the same pictures") {
  for (const char* const what : {"all", "weave", "lobes"}) {
    check_alike({"preview", kSilk, "--size", "24", "--show", what, "-o", "FILE"}, "sheet.png");
  }
}

TEST_CASE("any number of threads checks, converts, plans and fits alike") {
  const TemporaryFolder folder;
  const std::string table = silk_table(folder, "halfdiff3d:6x6x8");
  check_alike({"check", table});
  check_alike({"check", kSilk});
  check_alike({"convert", table, "FILE", "--grid", "halfdiff3d:5x5x6"}, "other.exr");
  nlohmann::json scene = small_scene({"one", "two"});
  scene["tolerance"] = 0.05;
  for (nlohmann::json& material : scene["materials"]) material["weights"]["internal"] = 0;
  const std::string scene_file = written(folder, scene);
  check_alike({"plan", scene_file, "-o", "FILE"}, "plan.json");
  check_alike({"fit", table, "--material", "FILE", "--reflectance", "microfacet", "--paths", "all",
               "--layers", "3:4", "--starts", "2", "--tie", "weft"},
              "fitted.json");
  check_alike({"identify", kSilk, "--grid", "halfdiff3d:4x4x4", "--effects", "specular", "--noise",
               "0.01", "--refits", "2"});
}

TEST_CASE("progress is shown while several threads work, and a signal stops them all") {
  const TemporaryFolder folder;
  PseudoTerminal terminal;
  RunningProgram program(
      {"tabulate", kSilk, "--threads", kMany, "-o", (folder / "silk.exr").string(), "--grid",
       "inout:8x48x8x48", "--cells", "average:1e-4"},
      {.terminal = terminal.end()});
  while (program.runs() && terminal.text().find(" cells/s") == std::string::npos) {
  }
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  CAPTURE(terminal.text());
  CHECK(outcome.signal == SIGINT);
}

}  // namespace clothbrdf::test
