#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "formats/colour.h"
#include "formats/material_json.h"
#include "formats/presets.h"
#include "support/atomic_file.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct NewOptions {
  std::optional<std::string> preset;
  std::optional<std::string> colour;
  std::optional<std::string> warp_colour;
  std::optional<std::string> weft_colour;
  std::optional<std::string> output;
  bool json = false;
};

// What was asked for; none keeps the preset's.
struct YarnColours {
  std::optional<Colour> warp;
  std::optional<Colour> weft;
};

void print(const Json& json) {
  std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

std::string known_presets() {
  std::string known;
  for (const Preset& preset : presets()) {
    known.append(known.empty() ? "" : ", ").append(preset.name);
  }
  return known;
}

Material material_of(const Preset& preset) {
  return parse_material(preset.text, "preset " + std::string(preset.name));
}

void list_presets(bool as_json) {
  Json list = Json::array();
  for (const Preset& preset : presets()) {
    list.push_back({{"name", preset.name}, {"description", material_of(preset).description}});
  }
  if (as_json) return print(list);
  for (const Json& preset : list) {
    std::cout << preset["name"].get<std::string>() << ": "
              << preset["description"].get<std::string>() << '\n';
  }
}

std::optional<Colour> read_colour(const char* option, const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  const std::optional<Colour> colour = parse_colour(*text);
  if (!colour) {
    throw InputError(std::string(option) + ": '" + *text + "' is not allowed: " + kColourAllowed);
  }
  return colour;
}

YarnColours read_colours(const NewOptions& options) {
  const std::optional<Colour> both = read_colour("--colour", options.colour);
  YarnColours colours = {read_colour("--warp-colour", options.warp_colour),
                         read_colour("--weft-colour", options.weft_colour)};
  if (!colours.warp) colours.warp = both;
  if (!colours.weft) colours.weft = both;
  return colours;
}

// "colour #b03060" where it is that of both yarns; empty where none was asked for.
std::string colours_text(const YarnColours& colours) {
  if (colours.warp && colours.warp == colours.weft) return "colour " + colour_text(*colours.warp);
  std::string text;
  if (colours.warp) text = "warp colour " + colour_text(*colours.warp);
  if (colours.weft) {
    text += (text.empty() ? "" : ", ") + ("weft colour " + colour_text(*colours.weft));
  }
  return text;
}

// Presets have three channels and a diffuse path; a test sees to that.
void dye(Material& material, const YarnColours& colours) {
  if (colours.warp) material.warp.absorption = absorption_of(*colours.warp, material.diffuse_path);
  if (colours.weft) material.weft.absorption = absorption_of(*colours.weft, material.diffuse_path);
  const std::string text = colours_text(colours);
  if (!text.empty()) material.description += " Changed: " + text + ".";
}

void write_material(const Material& material, const std::filesystem::path& path) {
  const std::string text = material_to_json(material);
  const ProgressBar bar;  // a signal waits for the whole file
  AtomicFile file(path);
  write_text(text, file);
  file.commit();
}

void report(const NewOptions& options, const YarnColours& colours) {
  if (options.json) {
    Json line = {{"file", *options.output}, {"preset", *options.preset}};
    if (colours.warp) line["warp_colour"] = colour_text(*colours.warp);
    if (colours.weft) line["weft_colour"] = colour_text(*colours.weft);
    return print(line);
  }
  const std::string text = colours_text(colours);
  std::cout << *options.output << ": " << *options.preset << (text.empty() ? "" : ", ") << text
            << '\n';
}

void make_material(const NewOptions& options) {
  if (!options.preset) {
    if (!options.output && !options.colour && !options.warp_colour && !options.weft_colour) {
      return list_presets(options.json);
    }
    throw InputError("PRESET is required, with --output and with colours; known: " +
                     known_presets());
  }
  const Preset* const preset = find_preset(*options.preset);
  if (preset == nullptr) {
    throw InputError("'" + *options.preset + "' is not a preset; known: " + known_presets());
  }
  const YarnColours colours = read_colours(options);
  if (!options.output) {
    throw InputError("--output is required with a preset: the material file to write, .json");
  }
  const std::filesystem::path path(*options.output);
  if (path.extension() != ".json") {
    throw InputError(*options.output + ": the ending '" + path.extension().string() +
                     "' is not that of a material; allowed: .json");
  }
  Material material = material_of(*preset);
  material.name = path.stem().string();
  dye(material, colours);
  write_material(material, path);
  report(options, colours);
}

}  // namespace

void add_new_command(CLI::App& program) {
  const auto options = std::make_shared<NewOptions>();
  CLI::App* command =
      program.add_subcommand("new",
                             "Writes a material from a preset and colours; without a preset, lists "
                             "the presets.\n"
                             "Example: clothbrdf new silk --colour '#b03060' -o rose.json");
  add_text_option(*command, "PRESET", options->preset, "NAME", "one of: " + known_presets());
  add_text_option(*command, "-o,--output", options->output, "MATERIAL",
                  "material file to write (.json); its name is the material's");
  add_text_option(*command, "--colour", options->colour, "HEX",
                  std::string("diffuse colour of both yarns, sRGB: ") + kColourAllowed);
  add_text_option(*command, "--warp-colour", options->warp_colour, "HEX",
                  "of the warp alone; goes before --colour");
  add_text_option(*command, "--weft-colour", options->weft_colour, "HEX",
                  "of the weft alone; goes before --colour");
  command->add_flag("--json", options->json,
                    "say what was written as a JSON object, or the presets as a JSON array");
  command->callback([options] { make_material(*options); });
}

}  // namespace clothbrdf
