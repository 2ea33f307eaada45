#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/material_json.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/random_inputs.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

std::vector<json> answers(const Outcome& outcome) {
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  std::vector<json> objects;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) objects.push_back(json::parse(line));
  return objects;
}

std::vector<json> eval(const std::string& input, const Arguments& more = {}) {
  Arguments arguments = {"eval", kSilk};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return answers(run_program(arguments, {.input = input}));
}

std::string text_of(const DirectionPair& pair) {
  std::ostringstream text;
  text.precision(17);
  text << pair.theta_i << ' ' << pair.phi_i << ' ' << pair.theta_o << ' ' << pair.phi_o << '\n';
  return text.str();
}

}  // namespace

TEST_CASE("eval answers a pair with its directions and f_r, one value a channel") {
  const std::vector<json> lines = eval("30 0 45 180\n");
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].size() == 3);
  CHECK(lines[0]["wi"] == json({30, 0}));
  CHECK(lines[0]["wo"] == json({45, 180}));
  CHECK(lines[0]["f_r"].size() == 4);
  for (const char* part : {"specular", "internal", "diffuse", "total"}) {
    REQUIRE(lines[0]["f_r"][part].size() == 3);
    for (const json& value : lines[0]["f_r"][part]) CHECK(value.get<double>() > 0);
  }
}

TEST_CASE("eval's numbers read back to the bits of the model") {
  const std::uint64_t seed = seed_from_environment();
  CAPTURE(seed);
  for (const char* name : {"silk", "tamamushi", "cotton_paper"}) {
    RandomInputs random(seed);
    std::vector<DirectionPair> pairs;
    std::string input;
    for (int i = 0; i < 200; ++i) {
      pairs.push_back(random.pair());
      input += text_of(pairs.back());
    }
    const Material material = read_material(preset(name));
    const ClothModel<double> model(material);
    const std::vector<json> lines =
        answers(run_program({"eval", preset(name).string()}, {.input = input}));
    REQUIRE(lines.size() == pairs.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const DirectionPair& p = pairs[i];
      const Components f = model.evaluate(pair_geometry(p, material.rotation_deg));
      CAPTURE(name, i, lines[i].dump());
      CHECK(lines[i]["wi"] == json({p.theta_i, p.phi_i}));
      CHECK(lines[i]["wo"] == json({p.theta_o, p.phi_o}));
      CHECK(lines[i]["f_r"]["specular"].get<std::vector<double>>() == f.specular);
      CHECK(lines[i]["f_r"]["internal"].get<std::vector<double>>() == f.internal);
      CHECK(lines[i]["f_r"]["diffuse"].get<std::vector<double>>() == f.diffuse);
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(lines[i]["f_r"]["total"][c].get<double>() == f.total(c));
    }
  }
}

TEST_CASE("eval answers a line before the next one is written") {
  constexpr int kTimeoutMs = 60'000;  // what a loaded machine under the sanitizers may need
  RunningProgram program({"eval", kSilk});
  program.write("30 0 45 180\n");
  REQUIRE(program.read_line(kTimeoutMs).has_value());
  // Neither what follows in the same breath nor half a line holds the answer back.
  program.write("31 0 45 180\n# a comment\n\n32 0");
  const std::optional<std::string> second = program.read_line(kTimeoutMs);
  REQUIRE(second.has_value());
  CHECK(json::parse(*second)["wi"] == json({31, 0}));
  program.write(" 45 180\n");
  REQUIRE(program.read_line(kTimeoutMs).has_value());
  program.close_input();
  CHECK(program.wait().exit_code == 0);
}

TEST_CASE("eval answers any number of pairs, from a file as from standard input") {
  constexpr std::size_t kPairs = 10'000;
  const TemporaryFolder folder;
  json material = json::parse(read_file(preset("silk")));
  material.erase("$schema");
  material["paths"] = "single";
  material["warp"]["layers"] = 1;
  write_file(folder / "single.json", material.dump());
  std::string input;
  for (std::size_t i = 0; i < kPairs; ++i) {
    input += text_of({static_cast<double>(i % 90), 0, 45, static_cast<double>(i) / 100});
  }
  write_file(folder / "pairs.txt", input);
  const std::string name = (folder / "single.json").string();
  const Outcome piped = run_program({"eval", name}, {.input = input});
  const Outcome from_file = run_program({"eval", name, "--pairs", (folder / "pairs.txt").string()});
  CHECK(answers(piped).size() == kPairs);
  CHECK(from_file.out == piped.out);
  CHECK(run_program({"eval", name, "--pairs", "-"}, {.input = input}).out == piped.out);
}

TEST_CASE("eval skips blank lines and comments and takes any white space") {
  const std::vector<json> expected = eval("30 0 45 180\n");
  CHECK(eval("# theta_i phi_i theta_o phi_o\n\n  \t\n  # more\n30 0 45 180\n") == expected);
  CHECK(eval("# Windows\r\n\r\n30 0 45 180\r\n") == expected);
  CHECK(eval("\t30\t0  45 180 \n") == expected);
  CHECK(eval("+30 +0 4.5e1 180.0") == expected);
  CHECK(eval("").empty());
}

TEST_CASE("a line that is no pair ends eval, the lines before it answered") {
  const auto refused = [](const std::string& line) {
    const Outcome outcome =
        run_program({"eval", kSilk}, {.input = "# first\n30 0 45 180\n" + line + "\n1 2 3 4\n"});
    CAPTURE(line, outcome.out);
    CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 1);
    CHECK(not_a_refusal({outcome.exit_code, outcome.signal, "", outcome.err}, 2) == "");
    CHECK_THAT(outcome.err, ContainsSubstring("standard input: line 3: "));
    CHECK_THAT(outcome.err, ContainsSubstring("'theta_i phi_i theta_o phi_o' in degrees"));
    return outcome.err;
  };
  CHECK_THAT(refused("30 0 45"), ContainsSubstring("only 3 values"));
  CHECK_THAT(refused("30"), ContainsSubstring("only 1 value;"));
  CHECK_THAT(refused("30 0 45 180 1"), ContainsSubstring("more than four values"));
  for (const char* word : {"x", "nan", "inf", "1e999", "0x10", "1,5", "+-1", "+", "--1"}) {
    CHECK_THAT(refused("30 0 " + std::string(word) + " 180"),
               ContainsSubstring("'" + std::string(word) + "' is not a finite number"));
  }
  CHECK_THAT(refused("30 0 181 180"), ContainsSubstring("theta_o '181' is not allowed: 0 to 180"));
  CHECK_THAT(refused("-0.5 0 45 180"),
             ContainsSubstring("theta_i '-0.5' is not allowed: 0 to 180"));
  CHECK_THAT(refused("30 0 \x1b[2J 180"), ContainsSubstring("'?[2J'"));
  CHECK(refused(std::string(100'000, 'x')).size() < 300);
}

TEST_CASE("a line of a file that is no pair is told with the file's name") {
  const TemporaryFolder folder;
  const std::string name = (folder / "pairs.txt").string();
  write_file(name, "30 0 45 x\n");
  const Outcome outcome = run_program({"eval", kSilk, "--pairs", name});
  CHECK(not_a_refusal(outcome, 2) == "");
  CHECK_THAT(outcome.err, ContainsSubstring(name + ": line 1: 'x'"));
}

TEST_CASE("option --effects leaves in the components that it names, no others") {
  const json all = eval("30 0 45 180\n").at(0)["f_r"];
  const json zero = {0, 0, 0};
  for (const std::string on : {"specular", "internal", "diffuse"}) {
    const json one = eval("30 0 45 180\n", {"--effects", on}).at(0)["f_r"];
    for (const std::string part : {"specular", "internal", "diffuse"}) {
      CAPTURE(on, part);
      CHECK(one[part] == (part == on ? all[part] : zero));
    }
    CHECK(one["total"] == all[on]);
  }
  const json two = eval("30 0 45 180\n", {"--effects", "diffuse,specular"}).at(0)["f_r"];
  CHECK(two["internal"] == zero);
  CHECK(two["specular"] == all["specular"]);
  CHECK(two["diffuse"] == all["diffuse"]);
}

TEST_CASE("eval answers 0 on and below the horizon") {
  const json zero = {0, 0, 0};
  for (const json& line : eval("90 0 45 180\n30 0 90 180\n120 0 45 180\n30 0 180 180\n100 0 100 "
                               "0\n90 0 90 0\n")) {
    CAPTURE(line.dump());
    for (const json& values : line["f_r"]) CHECK(values == zero);
  }
  CHECK(eval("89.999999 0 45 180\n").at(0)["f_r"]["total"] != zero);
}

TEST_CASE("eval ends when nobody reads on, and says so where its output cannot be written") {
  RunningProgram program({"eval", kSilk});
  program.write("30 0 45 180\n");
  REQUIRE(program.read_line(60'000).has_value());
  program.close_output();  // as head -1 does
  program.write("31 0 45 180\n");
  const Outcome ended = program.wait();
  CHECK(ended.signal == SIGPIPE);
  CHECK(ended.err.empty());

  const RunOptions full{.input = "30 0 45 180\n", .output_file = "/dev/full"};
  CHECK(not_a_refusal(run_program({"eval", kSilk}, full), 1) == "");
}

}  // namespace clothbrdf::test
