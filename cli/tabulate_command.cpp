#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cost/verified.h"
#include "formats/format.h"
#include "formats/format_colours.h"
#include "formats/material_json.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

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

struct Output {
  FileOrder order;
  FileSetting setting;
  TableSpec spec;    // in the file's colours
  std::string note;  // what this file cannot hold of the material
  std::optional<MeasuredError> error;

  std::filesystem::path path() const { return order.name; }
};

std::string what_is_lost(const Material& material, const TableSpec& computed,
                         const TableSpec& written, const Format& format) {
  std::vector<std::string> lost;
  if (written.isotropic()) lost.emplace_back("isotropic: the mean over phi_h");
  const bool folded = written.has_grid() && written.grid().folds_orders();
  if (material.reflectance == Reflectance::kPaper && folded) {
    lost.emplace_back("not reciprocal: the mean of both orders of the directions");
  }
  if (!format.averages.empty()) lost.emplace_back(format.averages);
  if (const std::string colours = colours_note(computed, written); !colours.empty()) {
    lost.push_back(colours);
  }
  std::string note;
  for (const std::string& what : lost) note += (note.empty() ? "" : "; ") + what;
  return note;
}

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

// Looks at the output with the setting that it has now.
void describe(Output& output) {
  const FileOrder& order = output.order;
  const TableSpec computed = computed_spec(order, output.setting);
  output.spec = in_colours_of(*order.format, computed, output.setting.options);
  output.note = what_is_lost(order.material, computed, output.spec, *order.format);
}

Output plan_output(const TabulateOptions& options, const Material& material,
                   const FileToWrite& file) {
  const Format& format = format_for(file.name);
  Samples samples = format.default_samples(material.reflectance, options.isotropic);
  if (options.grid) {
    const bool once_around =
        material.reflectance == Reflectance::kPaper && format.keeps_description;
    samples = parse_grid(*options.grid, once_around ? 360 : 180);
  }
  const Effects effects = options.effects ? parse_effects(*options.effects) : Effects{};
  Output output{
      {material, effects, options.components, &format, file.options, options.isotropic, file.name},
      {std::move(samples), parse_cells(options.cells.value_or("point")), file.options},
      {},
      {},
      {}};
  check_setting(output.order, output.setting);
  describe(output);
  return output;
}

Json error_json(const MeasuredError& measured) {
  return {
      {"rms", measured.error.rms}, {"p99", measured.error.p99},
      {"max", measured.error.max}, {"reader", measured.reader},
      {"pairs", measured.pairs},   {"against", measured.of_mean ? "mean over rotations" : "cloth"}};
}

std::string error_text(const MeasuredError& measured) {
  std::ostringstream text;
  text << std::setprecision(3) << "error read " << measured.reader
       << (measured.of_mean ? ", against the mean over rotations" : "") << ": rms "
       << measured.error.rms << ", p99 " << measured.error.p99 << ", max " << measured.error.max;
  return text.str();
}

void report_json(const Output& output, const Json& cost) {
  const Layout layout = output.order.format->layout(output.spec, output.setting.options);
  Json line = {{"file", output.order.name},
               {"format", output.order.format->name},
               {"grid", layout.description},
               {"cells", layout.cells},
               {"channels", output.spec.channels.size()}};
  line.update(cost);
  if (!output.note.empty()) line["note"] = output.note;
  std::cout << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void report_text(const Output& output, const std::string& cost) {
  const Layout layout = output.order.format->layout(output.spec, output.setting.options);
  std::cout << output.order.name << ": " << output.order.format->name << ' ' << layout.description
            << (output.setting.options.half ? " of half floats" : "") << ", "
            << with_commas(layout.cells) << " cells of " << output.spec.channels.size()
            << " channels, " << cost;
  if (!output.note.empty()) std::cout << " (" << output.note << ')';
  std::cout << '\n';
}

std::string cost_text(std::uint64_t bytes, double seconds) {
  std::ostringstream text;
  text << with_commas(bytes) << " bytes in " << std::setprecision(3) << seconds << " s";
  return text.str();
}

void report(const TabulateOptions& options, const Output& output, std::uint64_t bytes,
            double seconds) {
  if (options.json) {
    Json cost = {{"bytes", bytes}, {"seconds", seconds}};
    if (output.error) cost["error"] = error_json(*output.error);
    report_json(output, cost);
  } else {
    report_text(output, cost_text(bytes, seconds) +
                            (output.error ? "; " + error_text(*output.error) : std::string()));
  }
}

void report(const TabulateOptions& options, const Output& output, const Prediction& expected) {
  const bool mean_only = expected.isotropy_loss > 0;
  if (options.json) {
    Json predicted = {{"seconds", expected.seconds},
                      {"bytes", expected.bytes},
                      {"error", error_json(expected.error)}};
    if (mean_only) predicted["isotropy_loss"] = expected.isotropy_loss;
    report_json(output, {{"predicted", predicted}});
    return;
  }
  std::ostringstream text;
  text << "not written (dry run); expected: " << cost_text(expected.bytes, expected.seconds) << "; "
       << error_text(expected.error) << std::setprecision(3);
  if (mean_only) text << "; the mean over rotations loses " << expected.isotropy_loss << " rms";
  report_text(output, text.str());
}

// With a target the file is written once to be measured, and once more with the result in it.
void choose(Output& output, const Target& target, bool dry_run, const Workers& workers) {
  if (dry_run) {
    output.setting = SettingChooser(output.order, target, workers).choose(target.tolerance);
  } else {
    VerifiedSetting chosen = choose_verified(output.order, target, workers);
    output.setting = std::move(chosen.setting);
    output.error = std::move(chosen.error);
  }
  describe(output);
}

std::string what_stays(std::span<const Output> unwritten) {
  std::string names;
  for (const Output& output : unwritten) {
    names += (names.empty() ? "" : ", ") + output.order.name;
  }
  return names + (unwritten.size() == 1 ? " is as it was" : " are as they were");
}

void tabulate(const TabulateOptions& options) {
  const Material material = read_material(options.material);
  const int threads = threads_of(options.threads);
  const std::optional<Target> target = target_of(options);
  std::vector<Output> outputs;
  for (const std::string& name : options.outputs) {
    for (const FileToWrite& file : files_to_write(name, options.files)) {
      if (std::any_of(outputs.begin(), outputs.end(),
                      [&](const Output& other) { return same_file(other.path(), file.name); })) {
        throw InputError("--output: " + file.name + " is given twice");
      }
      outputs.push_back(plan_output(options, material, file));
    }
  }

  ProgressBar bar;
  const Workers workers(threads, &bar.progress());
  // All opened before any work, so that a wrong folder costs nothing and a dry run finds it.
  std::vector<AtomicFile> files;
  files.reserve(outputs.size());
  for (const Output& output : outputs) files.emplace_back(output.path());
  std::size_t next = 0;
  try {
    for (; next < outputs.size(); ++next) {
      Output& output = outputs[next];
      if (target) choose(output, *target, options.dry_run, workers);
      if (options.dry_run) {
        const Prediction expected = predict_file(output.order, output.setting, workers);
        bar.clear();
        report(options, output, expected);
      } else {
        const auto start = std::chrono::steady_clock::now();
        write_setting(output.order, output.setting, files[next], workers, output.error);
        files[next].commit();
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        bar.clear();
        report(options, output, files[next].size(), elapsed.count());
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
      "ending.\n"
      "Example: clothbrdf tabulate materials/silk.json -o silk.binary -o silk.exr");
  std::string known;
  for (const Format& f : formats())
    known += (known.empty() ? "" : "; ") + std::string(f.ending) + ": " + std::string(f.summary);
  command->add_option("MATERIAL", options->material, "material file (JSON)")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", options->outputs, "table to write, repeatable (" + known + ")")
      ->required()
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
  add_text_option(*command, "--effects", options->effects, "LIST",
                  "only these components, joined by ',': specular, internal, diffuse");
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
