#include "formats/material_json.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "formats/fit_names.h"
#include "formats/json_text.h"
#include "formats/schema_check.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {

namespace {

using nlohmann::json;

// Where editors find the schema: right for materials/ of the repository and of an installation.
constexpr const char* kSchemaReference = "../data-schemas/material.schema.json";

// An absent key leaves `value` as it is. The schema has seen to it that the names are known.
template <class T, std::size_t N>
void read_choice(const json& object, const char* key, const ChoiceName<T> (&names)[N], T& value) {
  const auto found = object.find(key);
  if (found != object.end()) value = find_choice(names, found->get<std::string>()).value();
}

template <class T>
void read_value(const json& object, const char* key, T& value) {
  const auto found = object.find(key);
  if (found != object.end()) found->get_to(value);
}

template <class T, std::size_t N>
std::string quoted_name(const ChoiceName<T> (&names)[N], T value) {
  return '"' + std::string(choice_name(names, value)) + '"';
}

Yarn read_yarn(const json& object) {
  Yarn yarn;
  read_value(object, "lobe_axes", yarn.lobe_axes);
  read_value(object, "absorption", yarn.absorption);
  read_value(object, "layers", yarn.layers);
  read_value(object, "refractive_index", yarn.refractive_index);
  read_value(object, "scatter", yarn.scatter);
  if (object.contains("scatter_limit"))
    read_value(object, "scatter_limit", yarn.scatter_limit.emplace());
  return yarn;
}

// Bytes that are no UTF-8 are replaced: what is written can be read.
std::string written(const std::string& text) {
  return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

// JSON readers take -0 for the integer 0.
std::string written(double value) {
  return value == 0 && std::signbit(value) ? "-0.0" : number_text(value);
}

std::string written(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + written(value);
  return "[" + text + "]";
}

std::string written_yarn(const Yarn& yarn) {
  std::string text = "{\n    \"lobe_axes\": " + written(yarn.lobe_axes);
  text += ",\n    \"absorption\": " + written(yarn.absorption);
  text += ",\n    \"layers\": " + std::to_string(yarn.layers);
  text += ",\n    \"refractive_index\": " + written(yarn.refractive_index);
  text += ",\n    \"scatter\": " + written(yarn.scatter);
  if (yarn.scatter_limit) text += ",\n    \"scatter_limit\": " + written(*yarn.scatter_limit);
  return text + "\n  }";
}

}  // namespace

Material read_material(const std::filesystem::path& path) {
  return parse_material(read_json_file(path), path.string());
}

Material parse_material(std::string_view text, const std::string& name) {
  const json file = parse_json(text, name);
  check_against_schema(file, "material.schema.json", name);
  Material material;
  read_value(file, "name", material.name);
  read_value(file, "description", material.description);
  read_choice(file, "reflectance", kReflectanceNames, material.reflectance);
  read_choice(file, "paths", kPathsNames, material.paths);
  const json& weights = file.at("weights");
  read_value(weights, "specular", material.weights.specular);
  read_value(weights, "internal", material.weights.internal);
  read_value(weights, "diffuse", material.weights.diffuse);
  read_value(file, "diffuse_path", material.diffuse_path);
  read_value(file, "warp_fraction", material.warp_fraction);
  read_value(file, "rotation_deg", material.rotation_deg);
  read_value(file, "wavelengths_nm", material.wavelengths_nm);
  material.warp = read_yarn(file.at("warp"));
  material.weft = file.contains("weft") ? read_yarn(file.at("weft")) : material.warp;
  if (const std::optional<MaterialProblem> problem = find_problem(material)) {
    throw InputError(one_line(name, kLongestFileName) + ": " + problem->pointer + ": " +
                     problem->value + " is not allowed: " + problem->allowed);
  }
  return material;
}

std::string material_to_json(const Material& material) {
  check_material(material);  // never a file that we would refuse to read
  const Weights& weights = material.weights;
  std::string text = std::string("{\n  \"$schema\": \"") + kSchemaReference + "\"";
  text += ",\n  \"name\": " + written(material.name);
  if (!material.description.empty()) {
    text += ",\n  \"description\": " + written(material.description);
  }
  text += ",\n  \"reflectance\": " + quoted_name(kReflectanceNames, material.reflectance);
  text += ",\n  \"paths\": " + quoted_name(kPathsNames, material.paths);
  text += ",\n  \"weights\": {\"specular\": " + written(weights.specular);
  text += ", \"internal\": " + written(weights.internal);
  text += ", \"diffuse\": " + written(weights.diffuse) + "}";
  text += ",\n  \"diffuse_path\": " + written(material.diffuse_path);
  text += ",\n  \"warp_fraction\": " + written(material.warp_fraction);
  text += ",\n  \"rotation_deg\": " + written(material.rotation_deg);
  if (!material.wavelengths_nm.empty()) {
    text += ",\n  \"wavelengths_nm\": " + written(material.wavelengths_nm);
  }
  text += ",\n  \"warp\": " + written_yarn(material.warp);
  if (material.weft != material.warp) text += ",\n  \"weft\": " + written_yarn(material.weft);
  return text + "\n}\n";
}

}  // namespace clothbrdf
