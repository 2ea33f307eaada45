#include "formats/fit_file.h"

#include <nlohmann/json.hpp>

#include "formats/fit_names.h"
#include "formats/material_json.h"
#include "formats/schemas.h"
#include "model/layers.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/document_blocks.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;
using Kind = ParameterWish::Kind;

constexpr const char* kFitName = "fit.json";

FitOptions parsed(const std::string& text) { return parse_fit_file(text, kFitName, {}); }

// The message that the text is refused with, without the file's name.
std::string fit_refusal(const std::string& text) {
  try {
    parsed(text);
  } catch (const InputError& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(message.find_first_of("\r\n") == std::string::npos);
    CHECK(message.starts_with(std::string(kFitName) + ": "));
    return message.substr(std::string(kFitName).size() + 2);
  }
  return "";
}

}  // namespace

TEST_CASE("every key of a fit file reaches its field") {
  const FitOptions options = parsed(R"({"$schema": "x",
      "parameters": {"warp.refractive_index": {"fix": 1.5}, "scatter": {"free": [0, 0.3]},
                     "weft": {"tie": true}, "warp.lobe_axes.0": {"start": 0.1},
                     "weights": {"fix": true}, "diffuse_path": {"free": true},
                     "warp_fraction": {"free": [0.25, 0.75], "start": 0.5}},
      "layers": [2, 5], "paths": "single", "reflectance": "paper", "noise": 0.25,
      "weighting": "absolute", "loss": "cauchy", "starts": 7, "seed": 9007199254740991})");
  const std::vector<ParameterWish> wishes = {{Kind::kFree, "diffuse_path", {}, {}, {}},
                                             {Kind::kFree, "scatter", {}, 0.0, 0.3},
                                             {Kind::kFree, "warp_fraction", {}, 0.25, 0.75},
                                             {Kind::kStart, "warp_fraction", 0.5, {}, {}},
                                             {Kind::kTie, "weft", {}, {}, {}},
                                             {Kind::kFix, "weights", {}, {}, {}},
                                             {Kind::kFix, "warp.refractive_index", 1.5, {}, {}},
                                             {Kind::kStart, "warp.lobe_axes.0", 0.1, {}, {}}};
  CHECK(options.wishes == wishes);
  CHECK_FALSE(options.start);
  CHECK(options.fewest_layers == 2);
  CHECK(options.most_layers == 5);
  CHECK(options.paths == std::vector{Paths::kSingle});
  CHECK(options.reflectances == std::vector{Reflectance::kPaper});
  CHECK(options.noise == 0.25);
  CHECK(options.weighting == Weighting::kAbsolute);
  CHECK(options.loss == Loss::kCauchy);
  CHECK(options.starts == 7);
  CHECK(options.seed == 9007199254740991U);
}

TEST_CASE("the fit file of docs/fitting.md is read as the page says") {
  const std::vector<std::string> files =
      blocks_of(std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "docs" / "fitting.md", "json");
  REQUIRE(files.size() == 1);
  const FitOptions options = parsed(files[0]);
  const std::vector<ParameterWish> wishes = {{Kind::kFree, "refractive_index", {}, 1.5, 1.6},
                                             {Kind::kStart, "refractive_index", 1.55, {}, {}},
                                             {Kind::kFree, "scatter", {}, 0.0, 0.3},
                                             {Kind::kFix, "warp_fraction", 0.875, {}, {}},
                                             {Kind::kTie, "weft.refractive_index", {}, {}, {}},
                                             {Kind::kStart, "warp.lobe_axes.0", 0.06, {}, {}}};
  CHECK(options.wishes == wishes);
  CHECK(options.fewest_layers == 2);
  CHECK(options.most_layers == 6);
  CHECK(options.reflectances == std::vector{Reflectance::kMicrofacet});
  CHECK(options.paths == std::vector{Paths::kAll});
  CHECK(options.noise == 0.01);
  CHECK(options.loss == Loss::kHuber);
}

TEST_CASE("what a fit file leaves out keeps its default, and both stands for each convention") {
  const FitOptions defaults;
  for (const char* text : {"{}", R"({"paths": "both", "reflectance": "both"})"}) {
    const FitOptions options = parsed(text);
    CHECK(options.wishes.empty());
    CHECK_FALSE(options.start);
    CHECK_FALSE(options.noise);
    CHECK(options.fewest_layers == defaults.fewest_layers);
    CHECK(options.most_layers == defaults.most_layers);
    CHECK(options.paths == std::vector{Paths::kAll, Paths::kSingle});
    CHECK(options.reflectances == std::vector{Reflectance::kMicrofacet, Reflectance::kPaper});
    CHECK(options.weighting == defaults.weighting);
    CHECK(options.loss == defaults.loss);
    CHECK(options.starts == defaults.starts);
    CHECK(options.seed == defaults.seed);
  }
}

TEST_CASE("of two names for one parameter the one of more steps comes later, and so wins") {
  const FitOptions options = parsed(R"({"parameters": {
      "warp.absorption.0": {"fix": 0.1}, "warp.absorption": {"free": true}, "warp": {"fix": true},
      "absorption": {"free": [0, 1]}}})");
  std::vector<std::string> names;
  for (const ParameterWish& wish : options.wishes) names.push_back(wish.name);
  CHECK(names ==
        std::vector<std::string>{"absorption", "warp", "warp.absorption", "warp.absorption.0"});
}

TEST_CASE("the start of a fit file is a material in it, or a path from its folder") {
  const Material silk = read_material(preset("silk"));
  const json inlined = {{"start", json::parse(read_file(preset("silk")))}};
  CHECK(parsed(inlined.dump()).start == silk);

  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "starts");
  std::filesystem::copy_file(preset("silk"), folder / "starts" / "silk.json");
  write_file(folder / "fit.json", R"({"start": "starts/silk.json"})");
  CHECK(read_fit_file(folder / "fit.json").start == silk);

  CHECK_THAT(fit_refusal(R"({"start": {"warp": {}}})"),
             ContainsSubstring("/start: /weights: missing"));
  CHECK_THROWS_AS(parsed(R"({"start": "no such file.json"})"), InputError);
}

TEST_CASE("a fit file is refused in one line with pointer, value and what is allowed") {
  CHECK(fit_refusal("{]").starts_with("line 1, column 2"));
  CHECK(fit_refusal("[]") == "[] is not allowed: an object");
  CHECK_THAT(fit_refusal(R"({"layer": [0, 8]})"),
             ContainsSubstring("/layer: unknown key (did you mean \"layers\"?)"));
  CHECK(fit_refusal(R"({"layers": [0, 8], "layers": [0, 7]})") ==
        "/layers: this key is there twice; once is allowed");
  CHECK(fit_refusal(R"({"layers": [0]})") == "/layers: [0] is not allowed: an array of 2 integers");
  CHECK(fit_refusal(R"({"layers": [0, 65]})") ==
        "/layers/1: 65 is not allowed: an integer from 0 to 64");
  CHECK(fit_refusal(R"({"layers": [8, 0]})") ==
        "/layers: [8,0] is not allowed: the fewest, then the most");
  CHECK(fit_refusal(R"({"paths": "none"})") ==
        "/paths: \"none\" is not allowed: \"all\" or \"single\" or \"both\"");
  CHECK(fit_refusal(R"({"noise": 0})") ==
        "/noise: 0 is not allowed: a number from 1e-12 to 1000000000000");
  CHECK(fit_refusal(R"({"loss": 2})") ==
        "/loss: 2 is not allowed: \"squared\" or \"huber\" or \"cauchy\"");
  CHECK(fit_refusal(R"({"starts": 1.5})") ==
        "/starts: 1.5 is not allowed: an integer from 1 to 10000");
  CHECK_THAT(fit_refusal(R"({"seed": 9007199254740993})"), ContainsSubstring("/seed: "));
  CHECK(fit_refusal(R"({"start": 3})") == "/start: 3 is not allowed: a string or an object");
}

TEST_CASE("a wish that makes no sense is refused") {
  const auto of = [](const std::string& wish) {
    return fit_refusal(R"({"parameters": {"warp.scatter": )" + wish + "}}");
  };
  const std::string at = "/parameters/warp.scatter";
  const std::string allowed =
      " is not allowed: one of fix, free, start and tie, or free with start";
  CHECK(of("{}") == at + ": {}" + allowed);
  CHECK(of(R"({"fix": 1, "tie": true})") == at + ": {\"fix\":1,\"tie\":true}" + allowed);
  CHECK(of(R"({"fix": 1, "free": true, "start": 1})").ends_with(allowed));
  CHECK(of("0.1") == at + ": 0.1 is not allowed: an object");
  CHECK(of(R"({"fix": false})") == at + "/fix: false is not allowed: true");
  CHECK(of(R"({"fix": "x"})") == at + "/fix: \"x\" is not allowed: a number or true");
  CHECK(of(R"({"free": [0.3, 0]})") ==
        at + "/free: [0.3,0] is not allowed: the lowest value, then a higher one");
  CHECK(of(R"({"free": [0, 1, 2]})") ==
        at + "/free: [0,1,2] is not allowed: an array of 2 numbers");
  CHECK_THAT(of(R"({"freeze": 1})"), ContainsSubstring(at + "/freeze: unknown key"));
}

TEST_CASE("the fit file's schema, the command line and FitOptions agree on ranges and defaults") {
  const json schema = json::parse(schema_text("fit.schema.json")).at("properties");
  const FitOptions defaults;
  CHECK(kMostLayers == kMaxLayers);
  CHECK(schema["layers"]["items"]["maximum"] == kMostLayers);
  CHECK(schema["layers"]["default"] == json({defaults.fewest_layers, defaults.most_layers}));
  CHECK(schema["noise"]["minimum"] == kLeastNoise);
  CHECK(schema["noise"]["maximum"] == kMostNoise);
  CHECK(schema["starts"]["maximum"] == kMostStarts);
  CHECK(schema["starts"]["default"] == defaults.starts);
  CHECK(schema["seed"]["maximum"].get<double>() == kLargestSeed);
  CHECK(schema["seed"]["default"] == defaults.seed);
  CHECK(schema["weighting"]["default"] == choice_name(kWeightingNames, defaults.weighting));
  CHECK(schema["loss"]["default"] == choice_name(kLossNames, defaults.loss));
  const auto names = [](const auto& choices) {
    json all = json::array();
    for (const auto& choice : choices) all.push_back(choice.name);
    return all;
  };
  CHECK(schema["weighting"]["enum"] == names(kWeightingNames));
  CHECK(schema["loss"]["enum"] == names(kLossNames));
  json paths = names(kPathsNames);
  paths.push_back(kBoth);
  CHECK(schema["paths"]["enum"] == paths);
  json reflectances = names(kReflectanceNames);
  reflectances.push_back(kBoth);
  CHECK(schema["reflectance"]["enum"] == reflectances);
}

}  // namespace clothbrdf::test
