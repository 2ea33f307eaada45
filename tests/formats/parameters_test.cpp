#include "model/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/material_json.h"
#include "formats/schemas.h"
#include "model/layers.h"
#include "tests/catch.h"

namespace clothbrdf::test {

namespace {

using nlohmann::json;

const std::string kNone;

const json& resolved(const json& root, const json& node) {
  const auto ref = node.find("$ref");
  if (ref == node.end()) return node;
  return root.at(json::json_pointer(ref->get<std::string>().substr(1)));
}

// The schema of the value at a JSON pointer.
const json& schema_of(const json& root, const std::string& pointer) {
  const json* node = &root;
  json::json_pointer rest(pointer);
  std::vector<std::string> keys;
  for (; !rest.empty(); rest.pop_back()) keys.insert(keys.begin(), rest.back());
  for (const std::string& key : keys) {
    node = &resolved(root, *node);
    if (node->at("type") == "array") {
      const json& items = node->at("items");
      node = items.is_array() ? &items.at(std::stoul(key)) : &items;
    } else {
      node = &node->at("properties").at(key);
    }
  }
  return resolved(root, *node);
}

// Pointers of the numbers that a schema knows.
void collect_numbers(const json& root, const json& node_or_ref, const std::string& pointer,
                     std::vector<std::string>& found) {
  const json& node = resolved(root, node_or_ref);
  const std::string type = node.value("type", "");
  if (type == "number" || type == "integer") found.push_back(pointer);
  if (type == "object") {
    for (const auto& [key, child] : node.at("properties").items()) {
      std::string place = pointer;
      place += "/" + key;
      collect_numbers(root, child, place, found);
    }
  } else if (type == "array") {
    const json& items = node.at("items");
    for (std::size_t i = 0; i < (items.is_array() ? items.size() : 1); ++i) {
      collect_numbers(root, items.is_array() ? items[i] : items, pointer + "/" + std::to_string(i),
                      found);
    }
  }
}

Material valid_material() {
  Material material;
  material.weights = {1, 1, 0.3};
  material.warp = {{0.1, 0.4}, {0.05, 0.3, 0.6}, 4, 1.55, 0.05, 0.5};
  material.weft = material.warp;
  return material;
}

// The field that a pointer of kParameters means; `yarn` stands for /warp. Null for layers, an
// integer.
double* field(Material& material, Yarn& yarn, std::string_view pointer) {
  if (pointer == "/weights/specular") return &material.weights.specular;
  if (pointer == "/weights/internal") return &material.weights.internal;
  if (pointer == "/weights/diffuse") return &material.weights.diffuse;
  if (pointer == "/diffuse_path") return &material.diffuse_path;
  if (pointer == "/warp_fraction") return &material.warp_fraction;
  if (pointer == "/rotation_deg") return &material.rotation_deg;
  if (pointer == "/warp/lobe_axes/0") return yarn.lobe_axes.data();
  if (pointer == "/warp/lobe_axes/1") return &yarn.lobe_axes[1];
  if (pointer == "/warp/absorption/0") return yarn.absorption.data();
  if (pointer == "/warp/refractive_index") return &yarn.refractive_index;
  if (pointer == "/warp/scatter") return &yarn.scatter;
  if (pointer == "/warp/scatter_limit") return &*yarn.scatter_limit;
  return nullptr;
}

}  // namespace

TEST_CASE("schema and parameter table agree on ranges, defaults, units and meaning") {
  const json schema = json::parse(schema_text("material.schema.json"));
  for (const ParameterInfo& info : kParameters) {
    CAPTURE(info.pointer);
    const json& node = schema_of(schema, std::string(info.pointer));
    const bool integer = info.pointer == "/warp/layers";
    CHECK(node.at("type") == (integer ? "integer" : "number"));
    if (info.highest == kNoLimit) {
      CHECK_FALSE(node.contains("minimum"));
      CHECK_FALSE(node.contains("maximum"));
    } else {
      CHECK(node.at("minimum").get<double>() == info.lowest);
      CHECK(node.at("maximum").get<double>() == info.highest);
    }
    CHECK(node.contains("default") == info.default_value.has_value());
    if (info.default_value) CHECK(node.at("default").get<double>() == *info.default_value);
    CHECK(node.at("description") ==
          std::string(info.meaning) + " [" + std::string(info.unit) + "]");
  }
}

TEST_CASE("every number of the schema is in the parameter table") {
  const json schema = json::parse(schema_text("material.schema.json"));
  std::vector<std::string> numbers;
  collect_numbers(schema, schema, "", numbers);
  std::size_t in_table = 0;
  for (const std::string& pointer : numbers) {
    if (pointer.starts_with("/weft/") || pointer == "/wavelengths_nm/0") continue;
    CAPTURE(pointer);
    CHECK(std::any_of(std::begin(kParameters), std::end(kParameters),
                      [&](const ParameterInfo& info) { return info.pointer == pointer; }));
    ++in_table;
  }
  CHECK(in_table == std::size(kParameters));
}

TEST_CASE("the schema's defaults and lengths are those of the structs") {
  const json schema = json::parse(schema_text("material.schema.json"));
  const Material defaults;
  CHECK(schema_of(schema, "/diffuse_path").at("default") == defaults.diffuse_path);
  CHECK(schema_of(schema, "/warp_fraction").at("default") == defaults.warp_fraction);
  CHECK(schema_of(schema, "/rotation_deg").at("default") == defaults.rotation_deg);
  CHECK(schema_of(schema, "/warp/scatter").at("default") == defaults.warp.scatter);
  CHECK(schema_of(schema, "/name").at("default") == defaults.name);
  CHECK(schema_of(schema, "/description").at("default") == defaults.description);
  CHECK(schema_of(schema, "/reflectance").at("default") == "microfacet");
  CHECK(defaults.reflectance == Reflectance::kMicrofacet);
  CHECK(schema_of(schema, "/paths").at("default") == "all");
  CHECK(defaults.paths == Paths::kAll);
  CHECK(schema_of(schema, "/warp/absorption").at("maxItems") == kMaxChannels);
  CHECK(schema_of(schema, "/wavelengths_nm").at("maxItems") == kMaxChannels);
  CHECK(schema_of(schema, "/warp/layers").at("maximum") == kMaxLayers);
  CHECK(&schema_of(schema, "/warp") == &schema_of(schema, "/weft"));
}

TEST_CASE(
    "find_problem accepts the ends of every range and names what is outside, NaN and infinities "
    "too") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  int checked = 0;
  for (const ParameterInfo& info : kParameters) {
    for (const bool of_weft : {false, true}) {
      std::string pointer(info.pointer);
      if (of_weft && !pointer.starts_with("/warp/")) continue;
      if (of_weft) pointer.replace(0, 5, "/weft");
      CAPTURE(pointer);
      Material material = valid_material();
      Yarn& yarn = of_weft ? material.weft : material.warp;
      double* const value = field(material, yarn, info.pointer);
      if (value == nullptr) {
        for (const int layers : {0, kMaxLayers}) {
          yarn.layers = layers;
          CHECK_FALSE(find_problem(material));
        }
        for (const int layers : {-1, kMaxLayers + 1}) {
          yarn.layers = layers;
          REQUIRE(find_problem(material));
          CHECK(find_problem(material)->pointer == pointer);
          CHECK(find_problem(material)->value == std::to_string(layers));
          CHECK(find_problem(material)->allowed == "an integer from 0 to 64");
        }
        ++checked;
        continue;
      }
      if (!pointer.ends_with("scatter_limit")) {
        yarn.scatter_limit.reset();
      } else {
        yarn.lobe_axes = {1e-6, 1e-6};
      }
      for (const double end : {info.lowest, info.highest}) {
        *value = end;
        CHECK_FALSE(find_problem(material));
      }
      for (const double outside :
           {std::nextafter(info.lowest, -kInfinity), std::nextafter(info.highest, kInfinity),
            std::nan(""), kInfinity, -kInfinity}) {
        *value = outside;
        REQUIRE(find_problem(material));
        CHECK(find_problem(material)->pointer == pointer);
        CHECK(find_problem(material)->value == number_text(outside));
        CHECK(find_problem(material)->allowed ==
              (info.highest == kNoLimit ? "a finite number"
                                        : "a number from " + number_text(info.lowest) + " to " +
                                              number_text(info.highest)));
      }
      ++checked;
    }
  }
  CHECK(checked == 6 + 2 * 7);
}

TEST_CASE("find_problem names every channel, wrong counts and wavelengths out of order") {
  const auto place = [](const Material& material) {
    const std::optional<MaterialProblem> problem = find_problem(material);
    return problem ? problem->pointer : kNone;
  };
  CHECK(place(valid_material()) == kNone);
  Material material = valid_material();
  material.weft.absorption[2] = -1;
  CHECK(place(material) == "/weft/absorption/2");
  material = valid_material();
  material.warp.absorption[1] = std::nan("");
  CHECK(place(material) == "/warp/absorption/1");
  material = valid_material();
  material.warp.absorption.clear();
  CHECK(place(material) == "/warp/absorption");
  material.warp.absorption.assign(kMaxChannels + 1, 0.5);
  CHECK(place(material) == "/warp/absorption");
  material = valid_material();
  material.weft.absorption.push_back(0);
  CHECK(place(material) == "/weft/absorption");
  material.warp.absorption.push_back(0);
  CHECK(place(material) == "/warp/absorption");
  for (const double last :
       {600.0, 599.0, 0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    material.wavelengths_nm = {400, 500, 600, last};
    CHECK(place(material) == "/wavelengths_nm/3");
  }
  material.wavelengths_nm = {0, 500, 600, 700};
  CHECK(place(material) == "/wavelengths_nm/0");
  material.wavelengths_nm = {400, 500, 600};
  CHECK(place(material) == "/wavelengths_nm");
  material.wavelengths_nm = {400, 500, 600, 700};
  CHECK(place(material) == kNone);
  material.warp.scatter_limit = 0.39;
  CHECK(place(material) == "/warp/scatter_limit");
}

TEST_CASE("check_material throws what find_problem finds") {
  Material material = valid_material();
  CHECK_NOTHROW(check_material(material));
  material.weft.absorption[2] = -1;
  CHECK_THROWS_WITH(check_material(material),
                    "/weft/absorption/2: -1 is not allowed: a number from 0 to 1000000");
}

TEST_CASE("number_text is the shortest text that reads back") {
  CHECK(number_text(1e6) == "1000000");
  CHECK(number_text(1e-6) == "1e-06");
  CHECK(number_text(0.1) == "0.1");
  CHECK(number_text(1) == "1");
  CHECK(number_text(1e15) == "1e+15");
  CHECK(number_text(-kNoLimit) == "-1.7976931348623157e+308");
}

}  // namespace clothbrdf::test
