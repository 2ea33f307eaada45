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
#include "formats/format.h"
#include "formats/format_colours.h"
#include "formats/material_json.h"
#include "support/errors.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct TabulateOptions {
  std::string material;
  std::vector<std::string> outputs;
  std::optional<std::string> grid;
  std::string cells = "point";
  std::optional<std::string> effects;
  std::optional<std::string> threads;
  FileOptions files;
  bool components = false;
  bool isotropic = false;
  bool dry_run = false;
  bool json = false;
};

struct Output {
  std::filesystem::path path;
  const Format* format;
  TableSpec computed;  // from the model
  TableSpec spec;      // in the file's colours
  WriteOptions options;
  std::string note;  // what this file cannot hold of the material
};

std::string what_is_lost(const Material& material, const TableSpec& computed,
                         const TableSpec& written, const Format& format) {
  std::vector<std::string> lost;
  if (written.isotropic()) lost.emplace_back("isotropic: the mean over phi_h");
  const bool folded = written.has_grid() && written.grid().kind != GridKind::kInOut &&
                      written.grid().axes.back().highest_deg <= 180;
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
  TableSpec computed =
      material_spec(material, effects, samples, parse_cells(options.cells), options.components);
  TableSpec spec = in_colours_of(format, computed, file.options);
  check_output(format, spec, file.options, file.name);
  check_producible(computed);
  const std::string note = what_is_lost(material, computed, spec, format);
  return {file.name, &format, std::move(computed), std::move(spec), file.options, note};
}

void report(const TabulateOptions& options, const Output& output, std::uint64_t bytes,
            double seconds) {
  const Layout layout = output.format->layout(output.spec, output.options);
  if (options.json) {
    Json line = {{"file", output.path.string()},
                 {"format", output.format->name},
                 {"grid", layout.description},
                 {"cells", layout.cells},
                 {"channels", output.spec.channels.size()}};
    if (!options.dry_run) line.update({{"bytes", bytes}, {"seconds", seconds}});
    if (!output.note.empty()) line["note"] = output.note;
    std::cout << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return;
  }
  std::ostringstream text;
  text << output.path.string() << ": " << output.format->name << ' ' << layout.description << ", "
       << with_commas(layout.cells) << " cells of " << output.spec.channels.size() << " channels";
  if (options.dry_run) {
    text << ", not written (dry run)";
  } else {
    text << ", " << with_commas(bytes) << " bytes in " << std::setprecision(3) << seconds << " s";
  }
  if (!output.note.empty()) text << " (" << output.note << ')';
  std::cout << text.str() << '\n';
}

void write(const Output& output, AtomicFile& file, Workers workers) {
  WriteOptions options = output.options;
  options.workers = workers;
  workers.progress->begin(output.path.filename().string(),
                          output.format->layout(output.spec, options).cells, "cells");
  const bool single = output.format->precision(options).relative >= 0x1p-24;
  const std::unique_ptr<Producer> producer =
      make_producer(output.computed, workers, single ? Precision::kSingle : Precision::kDouble);
  const std::unique_ptr<Producer> coloured = in_colours_of(*output.format, *producer, options);
  write_table(*output.format, coloured ? *coloured : *producer, file, options);
  workers.check();
  file.commit();
}

std::string what_stays(std::span<const Output> unwritten) {
  std::string names;
  for (const Output& output : unwritten) {
    names += (names.empty() ? "" : ", ") + output.path.string();
  }
  return names + (unwritten.size() == 1 ? " is as it was" : " are as they were");
}

void tabulate(const TabulateOptions& options) {
  const Material material = read_material(options.material);
  const int threads = threads_of(options.threads);
  std::vector<Output> outputs;
  for (const std::string& name : options.outputs) {
    for (const FileToWrite& file : files_to_write(name, options.files)) {
      if (std::any_of(outputs.begin(), outputs.end(),
                      [&](const Output& other) { return same_file(other.path, file.name); })) {
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
  for (const Output& output : outputs) files.emplace_back(output.path);
  std::size_t next = 0;
  try {
    for (; next < outputs.size(); ++next) {
      const Output& output = outputs[next];
      const auto start = std::chrono::steady_clock::now();
      if (!options.dry_run) write(output, files[next], workers);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      bar.clear();
      report(options, output, files[next].size(), elapsed.count());
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
  command
      ->add_option(
          "--cells", options->cells,
          "value of a cell: point (f_r at its node, the default) or average[:REL] (mean "
          "over the cell above the horizon, to the relative tolerance REL, 1e-3 where left "
          "out)")
      ->type_name("RULE");
  add_text_option(*command, "--effects", options->effects, "LIST",
                  "only these components, joined by ',': specular, internal, diffuse");
  command->add_flag("--components", options->components,
                    "also layers specular.*, internal.*, diffuse.* (EXR)");
  command->add_flag("--isotropic", options->isotropic,
                    "the mean over rotations of the cloth: smaller files, and no weave");
  add_file_options(*command, options->files);
  add_threads_option(*command, options->threads);
  command->add_flag("--dry-run", options->dry_run,
                    "check everything, say what would be written, write nothing");
  command->add_flag("--json", options->json, "say what was written as one JSON object a line");
  command->callback([options] { tabulate(*options); });
}

}  // namespace clothbrdf
