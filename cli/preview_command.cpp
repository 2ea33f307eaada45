#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "formats/format.h"
#include "formats/image.h"
#include "formats/material_json.h"
#include "model/parameters.h"
#include "preview/cloth.h"
#include "preview/lobes.h"
#include "preview/panels.h"
#include "preview/sheet.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

struct PreviewOptions {
  std::vector<std::string> files;
  std::vector<std::string> outputs;
  std::string show = "sheet";
  std::optional<std::string> light;
  std::optional<std::string> eye;
  std::optional<std::string> effects;
  std::string size = "256";
  std::string exposure = "0";
  std::optional<std::string> threads;
  bool json = false;
};

/// What one panel shows of a cloth.
struct View {
  const char* caption;
  bool lobes;
  Part part;
  double turn_deg;
};
constexpr View kSheet = {"", false, Part::kTotal, 0};
constexpr View kTurned = {"weave at 45 deg", false, Part::kTotal, 45};
constexpr View kSpecular = {"specular", false, Part::kSpecular, 0};
constexpr View kInternal = {"internal", false, Part::kInternal, 0};
constexpr View kDiffuse = {"diffuse", false, Part::kDiffuse, 0};
constexpr View kLobes = {"lobes", true, Part::kTotal, 0};

struct Show {
  const char* name;
  std::vector<View> views;
};
const std::vector<Show>& shows() {
  static const std::vector<Show> kAll = {
      {"sheet", {kSheet}},
      {"weave", {kSheet, kTurned}},
      {"components", {kSpecular, kInternal, kDiffuse}},
      {"lobes", {kLobes}},
      {"all", {kSheet, kTurned, kSpecular, kInternal, kDiffuse, kLobes}}};
  return kAll;
}

const Show& parse_show(const std::string& name) {
  std::string known;
  for (const Show& show : shows()) {
    if (name == show.name) return show;
    known += (known.empty() ? "" : ", ") + std::string(show.name);
  }
  throw InputError("--show: '" + name + "' is not allowed: " + known);
}

/// A cloth and what its row of panels is called.
struct Source {
  std::string file;
  std::string name;
  std::unique_ptr<Cloth> cloth;
};

Source read_source(const std::string& file, const Effects& effects, const Workers& workers) {
  const std::string stem = std::filesystem::path(file).stem().string();
  if (const Format* format = find_format(file)) {
    return {file, stem, table_cloth(format->read(file), file)};
  }
  if (std::filesystem::path(file).extension() == ".json") {
    return {file, stem, material_cloth(read_material(file), file, workers, effects)};
  }
  throw InputError(file + ": the ending '" + std::filesystem::path(file).extension().string() +
                   "' is not that of a table or a material; known: " + table_endings() +
                   ", .json (material)");
}

void check_shown(const Source& source, const Show& show) {
  for (const View& view : show.views) {
    if (source.cloth->has(view.part)) continue;
    throw InputError(source.file + ": --show " + show.name +
                     ": the table holds totals only; write it with tabulate --components");
  }
}

Panel make_panel(const Source& source, const View& view, const SheetView& sheet, double light_theta,
                 const Workers& workers) {
  std::string caption = source.name + (*view.caption == '\0' ? "" : ", ") + view.caption;
  if (source.cloth->for_scene()) caption += view.lobes ? ", gaps: not in it" : ", blue: not in it";
  if (view.lobes) {
    const LobesView lobes{light_theta, view.turn_deg, sheet.size};
    caption += ": ring " + number_text(lobe_scale(*source.cloth, lobes)) + "/sr";
    Image image = render_lobes(*source.cloth, lobes);
    workers.advance(image.pixels.size());
    return {caption, std::move(image)};
  }
  const Shading shading = source.cloth->shading(view.part);
  return {caption, render_sheet(turned(shading, view.turn_deg), sheet, workers)};
}

void report(const PreviewOptions& options, const std::string& file, const Image& picture,
            std::size_t panels) {
  if (options.json) {
    const nlohmann::ordered_json line = {
        {"file", file}, {"width", picture.width}, {"height", picture.height}, {"panels", panels}};
    std::cout << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  } else {
    std::cout << file << ": " << panels << (panels == 1 ? " panel, " : " panels, ") << picture.width
              << " x " << picture.height << " pixels\n";
  }
}

// A table's ending is a picture's, too: an output must not take the place of an input.
void check_outputs(const PreviewOptions& options) {
  for (auto at = options.outputs.begin(); at != options.outputs.end(); ++at) {
    check_picture_name(*at);
    const auto is_it = [&](const std::string& other) { return same_file(*at, other); };
    if (std::any_of(options.outputs.begin(), at, is_it)) {
      throw InputError("--output: " + *at + " is given twice");
    }
    if (std::any_of(options.files.begin(), options.files.end(), is_it)) {
      throw InputError("--output: " + *at + " is also read; a picture needs another name");
    }
  }
}

// Beside tables they may be given: those of the materials.
Effects effects_of(const PreviewOptions& options) {
  if (!options.effects) return {};
  const auto is_table = [](const std::string& file) { return find_format(file) != nullptr; };
  if (std::all_of(options.files.begin(), options.files.end(), is_table)) {
    throw InputError("--effects: not with tables alone, which have theirs");
  }
  return parse_effects(*options.effects);
}

void preview(const PreviewOptions& options) {
  const Show& show = parse_show(options.show);
  const Effects effects = effects_of(options);
  SheetView sheet;
  sheet.light = parse_direction("--light", options.light.value_or("0,0"));
  sheet.eye = parse_direction("--eye", options.eye.value_or("0,0"));
  sheet.size = static_cast<int>(parse_number("--size", options.size, {16, 4096, true}));
  sheet.exposure = parse_number("--exposure", options.exposure, {-30, 30, false});
  constexpr double kLobesTheta = 30;
  const double light_theta = options.light ? sheet.light.theta_deg : kLobesTheta;
  const int threads = threads_of(options.threads);
  check_outputs(options);
  ProgressBar bar;
  const Workers workers{threads, &bar.progress()};
  std::vector<Source> sources;
  for (const std::string& file : options.files) {
    sources.push_back(read_source(file, effects, workers));
    check_shown(sources.back(), show);
  }
  std::vector<AtomicFile> files;
  files.reserve(options.outputs.size());
  for (const std::string& name : options.outputs) files.emplace_back(name);
  const std::size_t panels = sources.size() * show.views.size();
  const auto pixels = static_cast<std::size_t>(sheet.size) * static_cast<std::size_t>(sheet.size);
  bar.progress().begin(options.outputs.front(), panels * pixels, "pixels");
  std::vector<std::vector<Panel>> rows;
  for (const Source& source : sources) {
    rows.emplace_back();
    for (const View& view : show.views) {
      rows.back().push_back(make_panel(source, view, sheet, light_theta, workers));
    }
  }
  const Image picture = arrange(rows);
  for (AtomicFile& file : files) write_picture(picture, file);
  workers.check();
  for (AtomicFile& file : files) file.commit();
  bar.clear();
  for (const AtomicFile& file : files) report(options, file.name().string(), picture, panels);
}

}  // namespace

void add_preview_command(CLI::App& program) {
  const auto options = std::make_shared<PreviewOptions>();
  CLI::App* command = program.add_subcommand(
      "preview",
      "Pictures of materials or tables: the paper's wrinkled sheet, its components, its lobes; one "
      "row of panels a file.\n"
      "Example: clothbrdf preview materials/cotton.json materials/silk.json -o sheets.png");
  command
      ->add_option("FILE", options->files,
                   "materials (.json) or tables (.binary, .exr), repeatable")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->outputs,
                   "picture to write, repeatable (.png: sRGB; .exr: linear)")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  const auto option = [&](const char* name, std::string& value, const char* type,
                          const char* help) {
    command->add_option(name, value, help)->type_name(type);
  };
  option("--show", options->show, "WHAT",
         "sheet (the default), weave (also turned by 45 degrees), components (specular, internal, "
         "diffuse), lobes (polar, in two planes) or all");
  add_text_option(
      *command, "--light", options->light, "THETA,PHI",
      "direction to the light, degrees; 0,0 (straight above) where left out; lobes: only THETA, "
      "30 where left out");
  add_text_option(*command, "--eye", options->eye, "THETA,PHI",
                  "direction to the eye, degrees; 0,0 (straight above) where left out");
  add_effects_option(*command, options->effects, "(of materials)");
  option("--size", options->size, "PIXELS", "edge of a panel, 16 to 4096; 256 where left out");
  option("--exposure", options->exposure, "STOPS",
         "brighter by 2^STOPS; at 0, the default, a white diffuse sheet facing the light is white");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "say what was written as one JSON object a line");
  command->callback([options] { preview(*options); });
}

}  // namespace clothbrdf
