#include "formats/material_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "formats/json_text.h"
#include "model/parameters.h"
#include "support/errors.h"
#include "tests/catch.h"

namespace clothbrdf::test {

namespace {

using nlohmann::json;

const std::filesystem::path kMaterials = std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "materials";
constexpr const char* kName = "cloth.json";
const std::string kAccepted;

std::string silk_text() {
  std::ifstream file(kMaterials / "silk.json", std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  REQUIRE(text.str().size() > 100);
  return text.str();
}

// silk.json with a weft of its own, so that both yarns can be broken.
json silk() {
  json file = json::parse(silk_text());
  file["weft"] = file["warp"];
  return file;
}

json changed(const std::string& pointer, const json& value) {
  json file = silk();
  file[json::json_pointer(pointer)] = value;
  return file;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

bool is_one_line(const std::string& message) {
  return !message.empty() && message.size() < 1000 &&
         message.find_first_of("\r\n") == std::string::npos;
}

// The message of the InputError that the text is refused with; kAccepted if there is none.
std::string refusal(const std::string& text) {
  try {
    parse_material(text, kName);
  } catch (const InputError& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(is_one_line(message));
    CHECK(message.rfind(std::string(kName) + ": ", 0) == 0);
    return message.substr(std::string(kName).size() + 2);
  }
  return "";
}

std::string refusal(const json& file) { return refusal(file.dump()); }

std::string file_refusal(const std::filesystem::path& path) {
  try {
    read_material(path);
  } catch (const InputError& error) {
    CHECK(is_one_line(error.what()));
    return error.what();
  }
  return "";
}

std::uint64_t below(std::mt19937_64& bits, std::uint64_t count) { return bits() % count; }

double uniform(std::mt19937_64& bits, double low, double high) {
  const double u = static_cast<double>(bits() >> 11U) * 0x1p-53;
  return std::min(high, low + (high - low) * u);
}

Yarn random_yarn(std::mt19937_64& bits, std::size_t channels) {
  Yarn yarn;
  yarn.lobe_axes = {std::exp(uniform(bits, std::log(1e-6), 0)), uniform(bits, 1e-6, 1)};
  for (std::size_t c = 0; c < channels; ++c) {
    yarn.absorption.push_back(std::exp(uniform(bits, -700, std::log(1e6))));
  }
  yarn.layers = static_cast<int>(below(bits, 65));
  yarn.refractive_index = uniform(bits, 1, 3);
  yarn.scatter = below(bits, 3) == 0 ? 0 : uniform(bits, 0, 1);
  if (below(bits, 2) == 0) {
    yarn.scatter_limit = uniform(bits, std::max(yarn.lobe_axes[0], yarn.lobe_axes[1]), 1);
  }
  return yarn;
}

Material random_material(std::mt19937_64& bits) {
  Material material;
  const char* const names[] = {"", "plain", "\"quoted\"\n\\\x01", "\xE7\x8E\x89\xE8\x99\xAB"};
  material.name = names[below(bits, 4)];
  material.description = names[below(bits, 4)];
  material.reflectance = below(bits, 2) == 0 ? Reflectance::kMicrofacet : Reflectance::kPaper;
  material.paths = below(bits, 2) == 0 ? Paths::kAll : Paths::kSingle;
  material.weights = {uniform(bits, 0, 100), uniform(bits, 0, 1), uniform(bits, 0, 1e-300)};
  material.diffuse_path = uniform(bits, 0, 100);
  material.warp_fraction = uniform(bits, 0, 1);
  const double rotations[] = {0.0,
                              -0.0,
                              45.0,
                              1e300,
                              -1e22,
                              18446744073709551616.0,
                              123456789012345680.0,
                              uniform(bits, -1000, 1000)};
  material.rotation_deg = rotations[below(bits, 8)];
  const std::size_t channels = below(bits, 2) == 0 ? 3 : 1 + below(bits, 40);
  material.warp = random_yarn(bits, channels);
  material.weft = below(bits, 2) == 0 ? material.warp : random_yarn(bits, channels);
  if (channels != 3 || below(bits, 2) == 0) {
    double wavelength = 300;
    for (std::size_t c = 0; c < channels; ++c) {
      wavelength += uniform(bits, 1, 20);
      material.wavelengths_nm.push_back(wavelength);
    }
  }
  return material;
}

}  // namespace

TEST_CASE("the six presets load, and the paper's differ in convention and weights alone") {
  for (const std::string name : {"silk", "cotton", "tamamushi"}) {
    CAPTURE(name);
    const Material microfacet = read_material(kMaterials / (name + ".json"));
    Material paper = read_material(kMaterials / (name + "_paper.json"));
    CHECK(microfacet.name == name);
    CHECK(microfacet.reflectance == Reflectance::kMicrofacet);
    CHECK(paper.name == name + "_paper");
    CHECK(paper.reflectance == Reflectance::kPaper);
    CHECK(paper.weights != microfacet.weights);
    paper.name = microfacet.name;
    paper.description = microfacet.description;
    paper.reflectance = microfacet.reflectance;
    paper.weights = microfacet.weights;
    CHECK(paper == microfacet);
  }
}

TEST_CASE("silk.json holds the values of the design's example") {
  const Material material = read_material(kMaterials / "silk.json");
  CHECK(material.paths == Paths::kAll);
  CHECK(material.weights == Weights{1.0, 1.0, 0.3});
  CHECK(material.diffuse_path == 2.0);
  CHECK(material.warp_fraction == 0.5);
  CHECK(material.rotation_deg == 0.0);
  CHECK(material.warp == Yarn{{0.10, 0.40}, {0.05, 0.30, 0.60}, 4, 1.55, 0.05, std::nullopt});
  CHECK(material.weft == material.warp);
  CHECK(material.wavelengths_nm.empty());
}

TEST_CASE("every key reaches its field") {
  const Material material = parse_material(R"({"$schema": "x", "name": "n", "description": "d",
      "reflectance": "paper", "paths": "single",
      "weights": {"specular": 1, "internal": 2, "diffuse": 3}, "diffuse_path": 4, "warp_fraction": 0.25, "rotation_deg": -30, "wavelengths_nm": [400, 500.5],
      "warp": {"lobe_axes": [0.125, 0.5], "absorption": [5, 6], "layers": 7,
               "refractive_index": 1.25, "scatter": 0.75, "scatter_limit": 0.875},
      "weft": {"lobe_axes": [0.25, 1], "absorption": [8, 9], "layers": 10,
               "refractive_index": 2}})",
                                           kName);
  const Material expected{"n",
                          "d",
                          Reflectance::kPaper,
                          Paths::kSingle,
                          {1, 2, 3},
                          4,
                          0.25,
                          -30,
                          {{0.125, 0.5}, {5, 6}, 7, 1.25, 0.75, 0.875},
                          {{0.25, 1}, {8, 9}, 10, 2, 0, std::nullopt},
                          {400, 500.5}};
  CHECK(material == expected);
}

TEST_CASE("left-out keys take the defaults of the parameter table") {
  const Material material =
      parse_material(R"({"weights": {"specular": 1, "internal": 1, "diffuse": 1},
      "warp": {"lobe_axes": [0.1, 0.4], "absorption": [0, 0, 0], "layers": 1,
               "refractive_index": 1.5}})",
                     kName);
  Material expected;
  expected.weights = {1, 1, 1};
  expected.warp = {{0.1, 0.4}, {0, 0, 0}, 1, 1.5, 0, std::nullopt};
  expected.weft = expected.warp;
  CHECK(material == expected);
}

TEST_CASE("a material that is written and read is the same to the last bit") {
  constexpr std::uint64_t kSeed = 20240611;
  CAPTURE(kSeed);
  std::mt19937_64 bits(kSeed);
  int negative_zeros = 0;
  int with_weft = 0;
  int with_description = 0;
  for (int i = 0; i < 2000; ++i) {
    const Material material = random_material(bits);
    REQUIRE(!find_problem(material));
    const std::string text = material_to_json(material);
    CAPTURE(i, text);
    const Material back = parse_material(text, kName);
    REQUIRE(back == material);
    REQUIRE(std::signbit(back.rotation_deg) == std::signbit(material.rotation_deg));
    negative_zeros += material.rotation_deg == 0 && std::signbit(material.rotation_deg) ? 1 : 0;
    with_weft += material.weft != material.warp ? 1 : 0;
    REQUIRE((text.find("\"weft\"") != std::string::npos) == (material.weft != material.warp));
    REQUIRE(text.find("{\n  \"$schema\": \"") == 0);
    const std::size_t described = text.find(",\n  \"description\": \"");
    REQUIRE((described != std::string::npos) == !material.description.empty());
    with_description += material.description.empty() ? 0 : 1;
  }
  CHECK(negative_zeros > 100);
  CHECK(with_weft > 500);
  CHECK(with_description > 1000);
}

TEST_CASE("a material that could not be read back is not written") {
  Material material = read_material(kMaterials / "silk.json");
  material.weft.scatter = std::nan("");
  CHECK_THROWS_AS(material_to_json(material), std::invalid_argument);
}

TEST_CASE("an unknown key is refused with the nearest known one") {
  CHECK(refusal(changed("/warp/layer", 4)) ==
        "/warp/layer: unknown key (did you mean \"layers\"?), allowed are absorption, layers, "
        "lobe_axes, "
        "refractive_index, scatter, scatter_limit");
  CHECK_THAT(refusal(changed("/gloss", 1)),
             ContainsSubstring(
                 "/gloss: unknown key, allowed are $schema, description, diffuse_path, name"));
  CHECK_THAT(refusal(changed("/weights/difuse", 1)),
             ContainsSubstring("/weights/difuse: unknown key (did you mean \"diffuse\"?)"));
  CHECK_THAT(refusal(changed("/line\nbreak \x1b[31m\xC2\x9B\x7F", 1)),
             ContainsSubstring("/line?break ?[31m??: unknown key"));
  CHECK(refusal(changed("/" + std::string(100000, 'k'), 1)).size() < 300);
}

TEST_CASE("a duplicate key is refused") {
  const std::string twice = ": this key is there twice; once is allowed";
  CHECK(refusal(replaced(silk_text(), "\"layers\": 4", "\"layers\": 4, \"layers\": 5")) ==
        "/warp/layers" + twice);
  CHECK(refusal(replaced(silk_text(), "\"name\"", "\"warp\": {}, \"name\"")) == "/warp" + twice);
}

TEST_CASE("arrays of the wrong length are refused") {
  CHECK(refusal(changed("/warp/lobe_axes", {0.1, 0.2, 0.3})) ==
        "/warp/lobe_axes: [0.1,0.2,0.3] is not allowed: an array of 2 numbers");
  CHECK(refusal(changed("/weft/lobe_axes", {0.1})) ==
        "/weft/lobe_axes: [0.1] is not allowed: an array of 2 numbers");
  CHECK(refusal(changed("/warp/absorption", json::array())) ==
        "/warp/absorption: [] is not allowed: an array of 1 to 1024 numbers");
  CHECK(refusal(changed("/warp/absorption", std::vector<double>(1025, 0.5))) ==
        "/warp/absorption: an array of 1025 values is not allowed: an array of 1 to 1024 numbers");
}

TEST_CASE("literals that JSON does not have are refused with line, column and place") {
  for (const std::string literal : {"NaN", "nan", "Infinity", "inf", "None", "True"}) {
    const std::string message = refusal(replaced(silk_text(), "1.55,\n", literal + ",\n"));
    CHECK_THAT(message,
               ContainsSubstring("line 15, column 25, near /warp/refractive_index: not JSON: "));
    CHECK_THAT(message, ContainsSubstring("a finite number, a string, true"));
    CHECK_THAT(message, ContainsSubstring("found \"" + literal + "\""));
  }
}

TEST_CASE("a number that overflows a double is refused") {
  for (const std::string& number :
       {std::string("1e999"), std::string("-1e999"), "1" + std::string(400, '0')}) {
    const std::string message =
        refusal(replaced(silk_text(), "\"rotation_deg\": 0", "\"rotation_deg\": " + number));
    CHECK_THAT(message, ContainsSubstring("/rotation_deg: " + number.substr(0, 5)));
    CHECK_THAT(message, ContainsSubstring("is not allowed: a number that a double can hold"));
  }
}

TEST_CASE("values out of range are refused, the ends are accepted, by schema and by find_problem") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  int ends = 0;
  for (const ParameterInfo& info : kParameters) {
    const bool integer = info.unit == "layers" && info.pointer.ends_with("/layers");
    for (const bool of_weft : {false, true}) {
      std::string pointer(info.pointer);
      if (of_weft) {
        if (!pointer.starts_with("/warp/")) continue;
        pointer.replace(0, 5, "/weft");
      }
      json at_ends = silk();
      for (const char* yarn :
           {"/warp", "/weft"}) {  // the narrowest lobe, so that no end contradicts it
        at_ends[json::json_pointer(std::string(yarn) + "/lobe_axes")] = {1e-6, 1e-6};
      }
      for (const double end : {info.lowest, info.highest}) {
        CAPTURE(pointer, end);
        json file = at_ends;
        json& value = file[json::json_pointer(pointer)];
        value = end;
        if (integer) value = static_cast<int>(end);
        CHECK(refusal(file) == kAccepted);
        const double outside =
            integer ? end + (end == info.lowest ? -1 : 1)
                    : std::nextafter(end, end == info.lowest ? -kInfinity : kInfinity);
        if (std::isinf(outside)) continue;  // not in JSON; find_problem's part below
        value = outside;
        if (integer) value = static_cast<int>(outside);
        CHECK(refusal(file) == pointer + ": " + value.dump() + " is not allowed: " +
                                   (integer ? "an integer" : "a number") + " from " +
                                   number_text(info.lowest) + " to " + number_text(info.highest));
        ++ends;
      }
    }
  }
  CHECK(ends == 2 * (5 + 2 * 7));  // rotation_deg has no ends that JSON can pass
}

TEST_CASE("values of the wrong type are refused") {
  CHECK(refusal(changed("/warp/layers", 4.5)) ==
        "/warp/layers: 4.5 is not allowed: an integer from 0 to 64");
  CHECK(refusal(changed("/warp/layers", "4")) ==
        "/warp/layers: \"4\" is not allowed: an integer from 0 to 64");
  CHECK(refusal(changed("/warp/layers", 18446744073709551615U)) ==
        "/warp/layers: 1.8446744073709552e+19 is not allowed: an integer from 0 to 64");
  CHECK(refusal(changed("/warp/absorption/2", nullptr)) ==
        "/warp/absorption/2: null is not allowed: a number from 0 to 1000000");
  CHECK(refusal(changed("/weights", {1, 1, 0.3})) ==
        "/weights: [1,1,0.3] is not allowed: an object");
  CHECK(refusal(changed("/name", true)) == "/name: true is not allowed: a string");
  CHECK(refusal(changed("/description", {"a", "b"})) ==
        "/description: [\"a\",\"b\"] is not allowed: a string");
  CHECK(refusal(changed("/$schema", 7)) == "/$schema: 7 is not allowed: a string");
  CHECK(refusal(changed("/paths", "some")) ==
        "/paths: \"some\" is not allowed: \"all\" or \"single\"");
  CHECK(refusal(changed("/reflectance", 1)) ==
        "/reflectance: 1 is not allowed: \"microfacet\" or \"paper\"");
  CHECK(refusal(changed("/rotation_deg", "0")) == "/rotation_deg: \"0\" is not allowed: a number");
  CHECK(refusal(changed("/wavelengths_nm", {0, 1, 2})) ==
        "/wavelengths_nm/0: 0 is not allowed: a number above 0");
  CHECK(refusal(std::string("[1, 2]")) == "[1,2] is not allowed: an object");
  CHECK(refusal(std::string("3")) == "3 is not allowed: an object");
}

TEST_CASE("a missing key is named with what it needs") {
  for (const auto& [pointer, needed] : std::vector<std::pair<std::string, std::string>>{
           {"/weights", "an object"},
           {"/weights/internal", "a number from 0 to 100"},
           {"/warp", "an object"},
           {"/warp/layers", "an integer from 0 to 64"},
           {"/weft/lobe_axes", "an array of 2 numbers"},
           {"/weft/absorption", "an array of 1 to 1024 numbers"},
           {"/weft/refractive_index", "a number from 1 to 3"}}) {
    const json::json_pointer place(pointer);
    json file = silk();
    file[place.parent_pointer()].erase(place.back());
    std::string message = pointer;
    message += ": missing, needed is " + needed;
    CHECK(refusal(file) == message);
  }
}

TEST_CASE("what is not JSON is refused with line and column") {
  CHECK_THAT(refusal(std::string("hello")), ContainsSubstring("line 1, column 1: not JSON: "));
  CHECK_THAT(refusal(std::string("{'a': 1}")), ContainsSubstring("line 1, column 2: not JSON: "));
  CHECK_THAT(refusal(std::string("{} {}")), ContainsSubstring("line 1, column 4: not JSON: "));
  CHECK_THAT(refusal(silk_text() + "x"), ContainsSubstring("not JSON"));
  CHECK_THAT(refusal(replaced(silk_text(), "\"paths\"", "// comment\n  \"paths\"")),
             ContainsSubstring("line 6, column 3, near /reflectance: not JSON: "));
  CHECK_THAT(refusal(replaced(silk_text(), "silk", "s\xFFlk")),
             ContainsSubstring(
                 "line 3, column 13, near /name: not JSON: invalid string: ill-formed UTF-8"));
  CHECK_THAT(refusal(replaced(silk_text(), "silk", "\xED\xA0\x80")),
             ContainsSubstring("UTF-8"));  // surrogate
  CHECK_THAT(refusal(replaced(silk_text(), "silk", "\xE7\x8E\x89\n")),
             ContainsSubstring(
                 "line 3, column 13, near /name: not JSON: invalid string: control character"));
  CHECK_THAT(refusal(silk_text() + std::string(1, '\0') + "garbage"),
             ContainsSubstring("a zero byte"));
  CHECK(refusal("\"" + std::string(100000, 'x')).size() < 300);
}

TEST_CASE("a byte-order mark and Windows line ends are accepted") {
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : silk_text()) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(parse_material(windows, kName) == read_material(kMaterials / "silk.json"));
}

TEST_CASE("an empty file is refused") {
  CHECK(refusal(std::string()) == "is empty; a JSON object is needed");
  CHECK(refusal(std::string(" \n\t")) == "is empty; a JSON object is needed");
}

TEST_CASE("nesting too deep is refused, however deep") {
  const std::size_t limit = kMaxJsonDepth;
  const auto nested = [](std::size_t depth) {
    std::string text(depth, '[');
    return text.append(depth, ']');
  };
  CHECK_THAT(refusal(nested(limit)), ContainsSubstring("is not allowed: an object"));
  CHECK_THAT(refusal(nested(limit + 1)),
             ContainsSubstring("/0/0/0: nested too deep: at most 32 levels are allowed"));
  std::string deep;
  deep.resize(10'000'000, '[');
  CHECK_THAT(refusal(deep), ContainsSubstring("nested too deep"));
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  CHECK_THAT(refusal(objects), ContainsSubstring("/a/a/a: nested too deep"));
}

TEST_CASE("a file of more than 16 MiB is refused, one of 16 MiB is looked at") {
  const std::string text = silk_text();
  CHECK(refusal(text + std::string(kMaxJsonBytes - text.size(), ' ')) == kAccepted);
  CHECK(refusal(text + std::string(kMaxJsonBytes - text.size() + 1, ' ')) ==
        "too large: at most 16 MiB are allowed");
}

TEST_CASE("millions of wrong values are refused with one") {
  std::string values = "[null";
  for (int i = 0; i < 1'000'000; ++i) values += ",null";
  CHECK_THAT(
      refusal(replaced(silk_text(), "[0.05, 0.30, 0.60]", values + "]")),
      ContainsSubstring("/warp/absorption/0: null is not allowed: a number from 0 to 1000000"));
}

TEST_CASE("a file that is cut anywhere is refused") {
  std::string text = silk_text();
  text.erase(text.find_last_of('}') + 1);
  for (std::size_t size = 0; size < text.size(); ++size) {
    CAPTURE(size);
    CHECK(refusal(text.substr(0, size)) != kAccepted);
  }
  CHECK(refusal(text) == kAccepted);
}

TEST_CASE("values that contradict one another are refused") {
  CHECK(refusal(changed("/weft/scatter_limit", 0.3)) ==
        "/weft/scatter_limit: 0.3 is not allowed: a number from 0.4 to 1 (not below the wider of "
        "lobe_axes)");
  CHECK(refusal(changed("/warp/scatter_limit", 0.4)) == kAccepted);
  CHECK(refusal(changed("/weft/absorption", {0.1, 0.2})) ==
        "/weft/absorption: an array of 2 values is not allowed: 3 values, as many as in "
        "/warp/absorption");
  json file = changed("/warp/absorption", {0.1, 0.2});
  file["weft"]["absorption"] = {0.3, 0.4};
  CHECK(refusal(file) ==
        "/warp/absorption: an array of 2 values is not allowed: 3 values (linear R, G, B), or as "
        "many as in "
        "/wavelengths_nm, which is missing");
  file["wavelengths_nm"] = {400, 500};
  CHECK(refusal(file) == kAccepted);
  file["wavelengths_nm"] = {400, 500, 600};
  CHECK(refusal(file) ==
        "/wavelengths_nm: an array of 3 values is not allowed: 2 values, as many as in "
        "/warp/absorption");
  file["wavelengths_nm"] = {500, 500};
  CHECK(refusal(file) ==
        "/wavelengths_nm/1: 500 is not allowed: a finite number above 500 (strictly ascending)");
  CHECK(refusal(changed("/wavelengths_nm", {450, 550, 650})) == kAccepted);
}

TEST_CASE("files that cannot be read are refused by name") {
  const std::filesystem::path missing = kMaterials / "no_such_cloth.json";
  CHECK(file_refusal(missing) == missing.string() + ": there is no such file");
  CHECK(file_refusal(kMaterials) ==
        kMaterials.string() + ": is a directory; a JSON file is needed");
  CHECK_THAT(file_refusal(kMaterials / "silk.json" / "x"), ContainsSubstring("cannot be read: "));
  CHECK_THAT(file_refusal("two\nlines.json"),
             ContainsSubstring("two?lines.json: there is no such file"));
  CHECK_THAT(file_refusal("/proc/self/mem"), ContainsSubstring("cannot be read: "));
  CHECK_THAT(file_refusal("/dev/zero"), ContainsSubstring("too large"));
}

TEST_CASE("mutated files are read or refused in one line, and nothing else") {
  constexpr std::uint64_t kSeed = 7;
  CAPTURE(kSeed);
  std::mt19937_64 bits(kSeed);
  const std::string original = silk_text();
  const std::vector<std::string> tokens = {"{",  "}",        "[",    "]",    ",",
                                           ":",  "\"",       "null", "-",    "1e99",
                                           "0",  "\\u00",    "\xFF", "true", "1e-320",
                                           "\n", "\\",       ".5",   "9",    "{}",
                                           "[[", "\"warp\"", "e5",   " ",    "\"scatter_limit\":"};
  int accepted = 0;
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = original;
    const std::uint64_t changes = 1 + below(bits, 3);
    for (std::uint64_t change = 0; change < changes && !text.empty(); ++change) {
      const std::size_t at = below(bits, text.size());
      const std::size_t length = std::min<std::size_t>(1 + below(bits, 30), text.size() - at);
      switch (below(bits, 10)) {
        case 0: text[at] = static_cast<char>(below(bits, 256)); break;
        case 1: text.erase(at, length); break;
        case 2: text.insert(at, text.substr(at, length)); break;
        case 3: text.insert(at, tokens[below(bits, tokens.size())]); break;
        case 4: text.insert(below(bits, text.size()), text.substr(at, length)); break;
        case 5:
        case 6:
        case 7:
        case 8: {  // a digit: most such files stay valid
          const std::size_t digit = text.find_first_of("0123456789", at);
          if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(bits, 10));
          break;
        }
        default: {  // a value or key of the parsed file
          json file = json::parse(text, nullptr, false);
          if (!file.is_object()) break;
          const json flat = file.flatten();
          const auto entry =
              std::next(flat.begin(), static_cast<std::ptrdiff_t>(below(bits, flat.size())));
          const json values[] = {nullptr,        -1,  0, 1, 0.5, 1e300, "text", json::array(),
                                 json::object(), true};
          file[json::json_pointer(entry.key())] = values[below(bits, std::size(values))];
          text = file.dump(-1, ' ', false, json::error_handler_t::replace);
        }
      }
    }
    CAPTURE(i, text);
    const std::string message = refusal(text);  // any other exception fails the test
    message.empty() ? ++accepted : ++refused;
    if (message.empty()) REQUIRE(!find_problem(parse_material(text, kName)));
  }
  CAPTURE(accepted, refused);
  CHECK(accepted > 200);
  CHECK(refused > 200);
}

}  // namespace clothbrdf::test
