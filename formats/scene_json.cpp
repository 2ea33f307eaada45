#include "formats/scene_json.h"

#include <nlohmann/json.hpp>

#include "formats/json_text.h"
#include "formats/material_json.h"
#include "formats/reach_json.h"
#include "formats/schema_check.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using nlohmann::json;

constexpr double kHorizonDeg = 90;

void refuse_below_horizon(const json& angle, const std::string& where) {
  if (angle.is_number() && angle.get<double>() > kHorizonDeg) {
    throw InputError(where + ": " + one_line(angle.dump()) +
                     " is below the horizon; allowed are 0 to 90, from the cloth's normal");
  }
}

// Says more than the schema, which refuses these angles too. The file may still be anything.
void check_horizon(const json& file, const std::string& name) {
  for (const char* key : {"lights", "eyes"}) {
    if (!file.is_object() || !file.contains(key) || !file[key].is_array()) continue;
    for (std::size_t i = 0; i < file[key].size(); ++i) {
      const json& range = file[key][i];
      if (!range.is_object() || !range.contains("theta_deg")) continue;
      const json& theta = range["theta_deg"];
      const std::string where = name + ": /" + key + "/" + std::to_string(i) + "/theta_deg";
      refuse_below_horizon(theta, where);
      for (std::size_t k = 0; theta.is_array() && k < theta.size(); ++k) {
        refuse_below_horizon(theta[k], where + "/" + std::to_string(k));
      }
    }
  }
}

Material scene_material(const json& material, const std::string& where,
                        const std::filesystem::path& folder) {
  if (material.is_object()) return parse_material(material.dump(), where);
  try {
    return read_material(folder / material.get<std::string>());
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
}

// A value, or an array of them.
template <class T>
std::vector<T> one_or_more(const json& value) {
  if (value.is_array()) return value.get<std::vector<T>>();
  return {value.get<T>()};
}

Scene scene_of(const json& file, const std::string& full_name,
               const std::filesystem::path& folder) {
  const std::string name = one_line(full_name, kLongestFileName);
  check_horizon(file, name);
  check_against_schema(file, "scene.schema.json", full_name);
  Scene scene;
  scene.name = file.value("name", "");
  scene.description = file.value("description", "");
  const auto place = [&](const char* key, std::size_t index) {
    return name + ": /" + key + "/" + std::to_string(index);
  };
  for (const json& light : file.at("lights")) {
    scene.lights.push_back({parse_direction_range(light, place("lights", scene.lights.size()))});
    const auto radiance = light.find("radiance");
    if (radiance != light.end()) scene.lights.back().radiance = one_or_more<double>(*radiance);
  }
  for (const json& eye : file.at("eyes")) {
    scene.eyes.push_back(parse_direction_range(eye, place("eyes", scene.eyes.size())));
  }
  scene.rotations_deg = file.value("rotations_deg", scene.rotations_deg);
  scene.tolerance = file.at("tolerance").get<double>();
  if (file.contains("output")) scene.outputs = one_or_more<std::string>(file["output"]);
  for (const json& material : file.at("materials")) {
    scene.materials.push_back(
        scene_material(material, place("materials", scene.materials.size()), folder));
  }
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
  return parse_scene(read_json_file(path), path.string(), path.parent_path());
}

Scene parse_scene(std::string_view text, const std::string& name,
                  const std::filesystem::path& folder) {
  return scene_of(parse_json(text, name), name, folder);
}

std::variant<Material, Scene> read_material_or_scene(const std::filesystem::path& path) {
  const std::string text = read_json_file(path);
  const json file = parse_json(text, path.string());
  if (!file.is_object() || !file.contains("materials")) return parse_material(text, path.string());
  return scene_of(file, path.string(), path.parent_path());
}

}  // namespace clothbrdf
