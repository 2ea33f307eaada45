#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/scene_tables.h"
#include "cli/table_output.h"
#include "cost/verified.h"
#include "formats/scene_json.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

struct TabulateOptions {
  std::string material;
  std::vector<std::string> outputs;
  std::optional<std::string> grid;
  std::optional<std::string> cells;
  std::optional<std::string> effects;
  std::optional<std::string> threads;
  FileOptions files;
  bool components = false;
  bool isotropic = false;
  std::optional<std::string> tolerance;
  std::optional<std::string> metric;
  bool isotropic_ok = false;
  bool dry_run = false;
  bool json = false;
};

// Throws InputError where options contradict each other.
std::optional<Target> target_of(const TabulateOptions& options) {
  if (!options.tolerance) {
    if (options.metric) throw InputError("--metric: is for --tolerance, which is missing");
    if (options.isotropic_ok) {
      throw InputError("--isotropic-ok: is for --tolerance, which is missing");
    }
    return std::nullopt;
  }
  const auto refuse = [](const std::string& other, const std::string& what) {
    throw InputError("--tolerance: chooses " + what + " itself; leave out " + other);
  };
  if (options.grid) refuse("--grid", "the grid");
  if (options.cells) refuse("--cells", "the cells");
  if (options.files.size) refuse("--size", "the size");
  Target target;
  target.tolerance = parse_number("--tolerance", *options.tolerance, {1e-6, 1, false});
  target.isotropic_ok = options.isotropic_ok;
  const std::string metric = options.metric.value_or("rms");
  if (metric != "rms" && metric != "p99") {
    throw InputError("--metric: '" + metric + "' is not allowed: rms or p99");
  }
  target.metric = metric == "rms" ? Metric::kRms : Metric::kP99;
  return target;
}

// Without anisotropy the mean over rotations loses nothing: it is taken wherever the format can
// hold it and nothing else is asked for.
Samples samples_of(const TabulateOptions& options, const FileOrder& order) {
  const Reflectance reflectance = order.material.reflectance;
  if (options.grid) {
    const bool once_around = reflectance == Reflectance::kPaper && order.format->keeps_description;
    return parse_grid(*options.grid, once_around ? 360 : 180);
  }
  return order.format->default_samples(reflectance, order.isotropic);
}

TableOutput make_output(const TabulateOptions& options, const ClothTables& cloth,
                        const FileToWrite& file) {
  const Format& format = format_for(file.name);
  TableOutput output;
  output.order = {
      cloth.material,     cloth.effects,
      options.components, &format,
      file.options,       options.isotropic || (!cloth.effects.anisotropy && !options.grid),
      file.name,          cloth.reach};
  output.plan = cloth.plan;
  const auto set = [&] {
    output.setting = {samples_of(options, output.order),
                      parse_cells(options.cells.value_or("point")), file.options};
  };
  set();
  if (output.order.isotropic && !options.isotropic && !is_allowed(output.order, output.setting)) {
    output.order.isotropic = false;
    set();
  }
  check_setting(output.order, output.setting);
  describe(output);
  return output;
}

// By cloth, then by name. Also checks all that can be wrong with them before any work.
std::vector<TableOutput> make_outputs(const TabulateOptions& options,
                                      const std::vector<ClothTables>& cloths) {
  std::vector<TableOutput> outputs;
  for (const ClothTables& cloth : cloths) {
    for (const std::string& name : cloth.names) {
      for (const FileToWrite& file : files_to_write(name, options.files)) {
        if (std::any_of(outputs.begin(), outputs.end(), [&](const TableOutput& other) {
              return same_file(other.path(), file.name);
            })) {
          throw InputError("--output: " + file.name + " is given twice");
        }
        outputs.push_back(make_output(options, cloth, file));
      }
    }
  }
  return outputs;
}

std::vector<ClothTables> material_tables(const TabulateOptions& options, const Material& material) {
  if (options.outputs.empty()) {
    throw InputError("--output is required; see clothbrdf tabulate --help");
  }
  const Effects effects = options.effects ? parse_effects(*options.effects) : Effects{};
  return {{material, effects, options.outputs}};
}

std::vector<ClothTables> unplanned_tables(const TabulateOptions& options, const Scene& scene) {
  const auto refuse = [](const std::optional<std::string>& value, const std::string& option,
                         const std::string& why) {
    if (value) throw InputError(option + ": not with a scene, " + why);
  };
  refuse(options.effects, "--effects", "whose plan chooses the effects");
  refuse(options.tolerance, "--tolerance", "which has its own");
  refuse(options.metric, "--metric", "whose tolerance is a share of its brightest");
  check_scene(scene, options.material);
  const std::vector<std::string>& names = options.outputs.empty() ? scene.outputs : options.outputs;
  if (names.empty()) {
    throw InputError(options.material +
                     ": /output: missing, needed is the name of a table, or the option -o");
  }
  return scene_tables(scene, names);
}

// With a target the file is written once to be measured, and once more with the result in it.
void choose(TableOutput& output, const Target& target, bool dry_run, const Workers& workers) {
  if (dry_run) {
    output.setting = SettingChooser(output.order, target, workers).choose(target.tolerance);
  } else {
    VerifiedSetting chosen = choose_verified(output.order, target, workers);
    output.setting = std::move(chosen.setting);
    output.error = std::move(chosen.error);
  }
  describe(output);
}

std::string what_stays(std::span<const TableOutput> unwritten) {
  std::string names;
  for (const TableOutput& output : unwritten) {
    names += (names.empty() ? "" : ", ") + output.order.name;
  }
  return names + (unwritten.size() == 1 ? " is as it was" : " are as they were");
}

void tabulate(const TabulateOptions& options) {
  const int threads = threads_of(options.threads);
  const std::variant<Material, Scene> input = read_material_or_scene(options.material);
  const Scene* scene = std::get_if<Scene>(&input);
  std::vector<ClothTables> cloths = scene != nullptr
                                        ? unplanned_tables(options, *scene)
                                        : material_tables(options, std::get<Material>(input));
  const std::optional<Target> target = target_of(options);
  std::vector<TableOutput> outputs = make_outputs(options, cloths);

  ProgressBar bar;
  const Workers workers(threads, &bar.progress());
  // All opened before any work, so that a wrong folder costs nothing and a dry run finds it.
  std::vector<AtomicFile> files;
  files.reserve(outputs.size());
  for (const TableOutput& output : outputs) files.emplace_back(output.path());
  if (scene != nullptr) {
    plan_tables(*scene, cloths, workers);
    outputs = make_outputs(options, cloths);
  }
  std::size_t next = 0;
  try {
    for (; next < outputs.size(); ++next) {
      TableOutput& output = outputs[next];
      if (target) choose(output, *target, options.dry_run, workers);
      if (options.dry_run) {
        const Prediction expected = predict_file(output.order, output.setting, workers);
        bar.clear();
        report_expected(output, expected, options.json);
      } else {
        const auto start = std::chrono::steady_clock::now();
        write_setting(output.order, output.setting, files[next], workers, output.error);
        files[next].commit();
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        bar.clear();
        report_written(output, files[next].size(), elapsed.count(), options.json);
      }
      // To a pipe all at once: where nobody reads it, that ends the program.
      if (::isatty(STDOUT_FILENO) != 0) std::cout.flush();
    }
  } catch (const Cancelled&) {
    throw WorkError("stopped; " + what_stays(std::span(outputs).subspan(next)));
  }
}

}  // namespace

void add_tabulate_command(CLI::App& program) {
  const auto options = std::make_shared<TabulateOptions>();
  CLI::App* command = program.add_subcommand(
      "tabulate",
      "Writes the cloth's f_r as tables that other programs read; the format follows the file's "
      "ending. Of a scene, what its tolerance allows to leave out is left out.\n"
      "Example: clothbrdf tabulate materials/silk.json -o silk.binary -o silk.exr");
  std::string known;
  for (const Format& f : formats()) {
    add_note(known, std::string(f.ending) + ": " + std::string(f.summary));
  }
  command->add_option("MATERIAL", options->material, "material file or scene file (JSON)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->outputs,
                   "table to write, repeatable (" + known +
                       "); of a scene with several materials one each, with the material's name "
                       "before the ending; the scene's own output where left out")
      ->type_name("FILE")
      ->allow_extra_args(false);  // what follows the name may be the material
  add_text_option(
      *command, "--grid", options->grid, "GRID",
      "halfdiff3d[:THxTDxPD], halfdiff4d[:THxPHxTDxPD] or inout[:TIxPIxTOxPO]; each format "
      "has its own default");
  add_text_option(*command, "--cells", options->cells, "RULE",
                  "value of a cell: point (f_r at its node, the default) or average[:REL] (mean "
                  "over the cell above the horizon, to the relative tolerance REL, 1e-3 where left "
                  "out)");
  add_effects_option(*command, options->effects);
  command->add_flag("--components", options->components,
                    "also layers specular.*, internal.*, diffuse.* (EXR)");
  command->add_flag("--isotropic", options->isotropic,
                    "the mean over rotations of the cloth: smaller files, and no weave");
  add_file_options(*command, options->files);
  add_threads_option(*command, options->threads);
  add_text_option(*command, "--tolerance", options->tolerance, "ERROR",
                  "choose the smallest file whose readers err by no more than this, relative "
                  "(0.003), and measure it: grid, nodes, cells, float or half, size");
  add_text_option(
      *command, "--metric", options->metric, "WHICH",
      "the error that --tolerance limits: rms (weighted by cosines, the default) or p99 "
      "(99th percentile of relative errors)");
  command->add_flag("--isotropic-ok", options->isotropic_ok,
                    "--tolerance does not count what the mean over rotations loses");
  command->add_flag("--dry-run", options->dry_run,
                    "check everything, say what would be written, the time, bytes and error that "
                    "are expected; write nothing");
  command->add_flag("--json", options->json, "say what was written as one JSON object a line");
  command->callback([options] { tabulate(*options); });
}

}  // namespace clothbrdf
