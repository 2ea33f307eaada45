#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/measured_error.h"
#include "cli/options.h"
#include "formats/format.h"
#include "formats/material_json.h"
#include "formats/reach_json.h"
#include "model/reflectance.h"
#include "support/errors.h"
#include "table/reached_cells.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::string file;
  bool json = false;
};

constexpr const char* kNotReciprocal = "not reciprocal, unbounded at grazing incidence";

struct ChannelSummary {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  double sum = 0;
  std::size_t numbers = 0;
  std::size_t not_finite = 0;
};

ChannelSummary summarise(const Table& table, std::size_t channel) {
  ChannelSummary s;
  for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
    if (!table.valid(cell)) continue;
    const double value = table.value(cell, channel);
    if (!std::isfinite(value)) {
      ++s.not_finite;
      continue;
    }
    s.lowest = std::min(s.lowest, value);
    s.highest = std::max(s.highest, value);
    s.sum += value;
    ++s.numbers;
  }
  return s;
}

Json table_info(const std::string& file, const Format& format, const Table& table) {
  const TableSpec& spec = table.spec();
  Json info = {{"file", file}, {"format", format.name}, {"value", "f_r, 1/sr, without the cosine"}};
  info["grid"] = spec.description();
  if (spec.has_grid()) info["axes"] = Json::array();
  for (const Axis& axis : spec.has_grid() ? spec.grid().axes : std::vector<Axis>{}) {
    info["axes"].push_back({{"name", axis.name},
                            {"cells", axis.size},
                            {"from_deg", axis.lowest_deg},
                            {"to_deg", axis.highest_deg},
                            {"first_value_at_deg", axis.node_deg(0)},
                            {"last_value_at_deg", axis.node_deg(axis.size - 1)}});
  }
  std::size_t valid = 0;
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) valid += table.valid(cell) ? 1 : 0;
  info["cells"] = {{"all", spec.cell_count()}, {"valid", valid}};
  if (spec.reach) {
    info["cells"]["reached"] = ReachedCells(spec.grid(), *spec.reach).count();
    info["reach"] = reach_to_json(*spec.reach);
  }
  if (!spec.provenance.program.empty()) {  // other files do not say
    info["cells"]["rule"] = spec.cells.average ? "average" : "point";
  }
  info["channels"] = Json::array();
  for (std::size_t c = 0; c < spec.channels.size(); ++c) {
    const ChannelSummary s = summarise(table, c);
    Json channel = {{"name", full_name(spec.channels[c])}};
    if (s.numbers > 0) {
      channel.update({{"lowest", s.lowest},
                      {"highest", s.highest},
                      {"mean", s.sum / static_cast<double>(s.numbers)}});
    }
    channel["not_finite"] = s.not_finite;
    info["channels"].push_back(channel);
  }
  if (!spec.provenance.program.empty()) {
    info["made_by"] = spec.provenance.program;
    info["effects"] = effects_text(spec.provenance.effects);
  }
  if (spec.provenance.error) info["error"] = error_json(*spec.provenance.error);
  if (!spec.provenance.note.empty()) info["note"] = spec.provenance.note;
  if (spec.provenance.material) {
    if (spec.provenance.material->reflectance == Reflectance::kPaper) info["note"] = kNotReciprocal;
    info["material"] = Json::parse(material_to_json(*spec.provenance.material));
  }
  return info;
}

// The colour of the light without direction, 0 to 1 for each channel.
Json yarn_colour(const Material& material, const Yarn& yarn) {
  Json colour = Json::array();
  for (const double absorption : yarn.absorption) {
    colour.push_back(diffuse_colour(absorption, material.diffuse_path));
  }
  return colour;
}

Json material_info(const std::string& file, const Material& material) {
  Json info = {{"file", file}, {"channels", material.channel_count()}};
  if (material.reflectance == Reflectance::kPaper) info["note"] = kNotReciprocal;
  info["material"] = Json::parse(material_to_json(material));
  info["diffuse_colour"] = {{"warp", yarn_colour(material, material.warp)},
                            {"weft", yarn_colour(material, material.weft)}};
  return info;
}

// For people: numbers to six digits, lists without quotes.
std::string plain(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) {
    std::ostringstream text;
    text << value.get<double>();
    return text.str();
  }
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& item : value) text += (text.empty() ? "" : ", ") + plain(item);
  return text;
}

// Nested objects as indented "key: value" lines, lists of objects as one line each.
void print_text(const Json& info, const std::string& indent) {
  for (const auto& [key, value] : info.items()) {
    std::cout << indent << key << ':';
    if (value.is_object()) {
      std::cout << '\n';
      print_text(value, indent + "  ");
    } else if (value.is_array() && !value.empty() && value.front().is_object()) {
      std::cout << '\n';
      for (const Json& item : value) {
        std::string line;
        for (const auto& [name, field] : item.items()) {
          line += (line.empty() ? "" : ", ") + name + ' ' + plain(field);
        }
        std::cout << indent << "  " << line << '\n';
      }
    } else {
      std::cout << ' ' << plain(value) << '\n';
    }
  }
}

void info(const InfoOptions& options) {
  const Format* format = find_format(options.file);
  Json content;
  if (format != nullptr) {
    content = table_info(options.file, *format, format->read(options.file));
  } else if (std::filesystem::path(options.file).extension() == ".json") {
    content = material_info(options.file, read_material(options.file));
  } else {
    throw InputError(
        options.file + ": the ending '" + std::filesystem::path(options.file).extension().string() +
        "' is not that of a table or a material; known: " + table_endings() + ", .json (material)");
  }
  if (options.json) {
    std::cout << content.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    print_text(content, "");
  }
}

}  // namespace

void add_info_command(CLI::App& program) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = program.add_subcommand("info",
                                             "What a table or material file holds.\n"
                                             "Example: clothbrdf info silk.exr");
  command->add_option("FILE", options->file, "table (.binary, .exr) or material (.json)")
      ->required()
      ->type_name("FILE");
  command->add_flag("--json", options->json, "as one JSON object");
  command->callback([options] { info(*options); });
}

}  // namespace clothbrdf
