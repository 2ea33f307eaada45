#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/fit_options.h"
#include "cli/options.h"
#include "cli/output_names.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "cli/sweep_option.h"
#include "fit/fit.h"
#include "fit/identify.h"
#include "formats/fit_report_json.h"
#include "formats/image.h"
#include "formats/material_json.h"
#include "preview/layer_map.h"
#include "support/errors.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

constexpr const char* kDefaultGrid = "halfdiff4d:24x18x24x24";
constexpr double kMostRefits = 100000;

struct IdentifyCommandOptions {
  std::string file;
  std::vector<std::string> outputs;
  std::optional<std::string> grid;
  std::optional<std::string> cells;
  std::optional<std::string> effects;
  std::optional<std::string> refits;
  std::optional<std::string> sweep;
  FitFlags flags;
  std::optional<std::string> threads;
  bool json = false;
};

/// What is looked at: a cloth, and where it is or would be measured.
struct Subject {
  TableSpec spec;
  Material material;
  std::vector<unsigned char> valid;  ///< empty: all above the horizon
  IdentifyOptions options;
  std::string noise_source;
};

bool is_table(const IdentifyCommandOptions& options) {
  return find_format(options.file) != nullptr;
}

// An option that would do nothing is an error.
void refuse(bool given, const char* option, const char* why) {
  if (given) throw InputError(std::string(option) + ": not with " + why);
}

void check_use(const IdentifyCommandOptions& options) {
  if (is_table(options)) {
    const char* const why = "a table, which has its own samples";
    refuse(options.grid.has_value(), "--grid", why);
    refuse(options.cells.has_value(), "--cells", why);
    refuse(options.effects.has_value(), "--effects", why);
  } else {
    const char* const why = "a material, which is not fitted";
    refuse(options.flags.reflectance.has_value(), "--reflectance", why);
    refuse(options.flags.paths.has_value(), "--paths", why);
    refuse(options.sweep && options.flags.noise, "--noise", "--sweep, which has its own");
  }
  refuse(options.sweep && options.refits, "--refits", "--sweep, which predicts only");
}

void check_outputs(const IdentifyCommandOptions& options) {
  std::vector<OutputName> outputs;
  for (const std::string& file : options.outputs) {
    const std::string ending = std::filesystem::path(file).extension().string();
    const bool fits = options.sweep ? ending == ".csv" || ending == ".png" : ending == ".json";
    if (!fits) {
      std::string message = "--output: ";
      message.append(file).append(": the ending '").append(ending).append("' is not allowed: ");
      throw InputError(message +
                       (options.sweep ? ".csv (the map) or .png (its picture)" : ".json"));
    }
    outputs.push_back({"--output", file, ending});
  }
  check_output_names(outputs, {options.file});
}

// What a fit finds is a cloth with all effects: a table without some would be fitted with them.
Effects parse_components(const std::string& list) {
  const Effects effects = parse_effects(list);
  if (const std::vector<std::string> words = shortcut_words(effects); !words.empty()) {
    throw InputError("--effects: '" + words.front() +
                     "' is not allowed: components only, specular, internal and diffuse");
  }
  return effects;
}

Subject material_subject(const IdentifyCommandOptions& options) {
  if (std::filesystem::path(options.file).extension() != ".json") {
    throw InputError(
        options.file + ": the ending '" + std::filesystem::path(options.file).extension().string() +
        "' is not that of a material or a table; known: .json (material), " + table_endings());
  }
  const Material material = read_material(options.file);
  // The paper's f_r is not reciprocal: its tables go once around.
  const double phi_d_range = material.reflectance == Reflectance::kPaper ? 360 : 180;
  const Grid grid = parse_grid(options.grid.value_or(kDefaultGrid), phi_d_range);
  const Effects effects = options.effects ? parse_components(*options.effects) : Effects{};
  const CellRule cells = parse_cells(options.cells.value_or("point"));
  Subject subject{material_spec(material, effects, grid, cells), material, {}, {}, ""};
  check_producible(subject.spec);
  subject.options.fit = read_fit_options(options.flags, subject.spec.channels);
  return subject;
}

std::vector<unsigned char> measured(const Table& table) {
  const std::size_t channels = table.spec().channels.size();
  std::vector<unsigned char> valid(table.spec().cell_count());
  for (std::size_t cell = 0; cell < valid.size(); ++cell) {
    bool sound = table.valid(cell) && table.finite(cell);
    for (std::size_t c = 0; sound && c < channels; ++c) sound = table.value(cell, c) >= 0;
    valid[cell] = sound ? 1 : 0;
  }
  return valid;
}

Subject table_subject(const IdentifyCommandOptions& options, const Table& table,
                      const FitOptions& fit_options, const Workers& workers) {
  FitReport report = fit_table(table, fit_options, workers);
  add_wavelengths(table.spec().channels, report);
  if (!report.failure.empty()) throw WorkError(options.file + ": " + report.failure);
  if (!report.converged) {
    throw WorkError(options.file + ": the fit did not converge: " + report.termination +
                    (report.message.empty() ? "" : ": " + report.message));
  }
  Subject subject{table.spec(), report.material, measured(table), {}, "as given"};
  subject.spec.provenance = {report.material, {}, ""};
  subject.options.fit = fit_options;
  if (fit_options.noise) return subject;
  // A table without any residual says nothing of how well another one would be measured.
  subject.noise_source = "the default";
  if (report.noise > 0) {
    subject.options.fit.noise = report.noise;
    subject.noise_source = "estimated from the residual of the fit";
  }
  return subject;
}

void write_map(const std::vector<SweepCell>& map, AtomicFile& file) {
  if (file.name().extension() == ".csv") {
    write_text(sweep_csv(map), file);
  } else {
    write_picture(layer_map(map), file);
  }
}

void identify_file(const IdentifyCommandOptions& options) {
  const int threads = threads_of(options.threads);
  check_use(options);
  check_outputs(options);
  const Sweep sweep = options.sweep ? parse_sweep(*options.sweep) : Sweep{};
  int refits = IdentifyOptions{}.refits;
  if (options.refits) {
    refits = static_cast<int>(parse_number("--refits", *options.refits, {0, kMostRefits, true}));
  }

  std::optional<Table> table;
  FitOptions fit_options;
  Subject subject;
  if (is_table(options)) {
    table = read_totals(options.file);
    fit_options = read_fit_options(options.flags, table->spec().channels);
  } else {
    subject = material_subject(options);
    subject.noise_source = options.flags.noise ? "as given" : "the default";
  }
  ProgressBar bar;
  const Workers workers{threads, &bar.progress()};
  std::vector<AtomicFile> files;
  files.reserve(options.outputs.size());
  for (const std::string& file : options.outputs) files.emplace_back(file);
  if (table) subject = table_subject(options, *table, fit_options, workers);
  subject.options.refits = refits;

  std::string printed;
  if (options.sweep) {
    const std::vector<SweepCell> map = sweep_layers(
        subject.spec, subject.material, sweep.absorptions, sweep.noises, subject.options, workers);
    for (AtomicFile& file : files) write_map(map, file);
    if (options.json) {
      printed = sweep_json(map);
    } else if (files.empty()) {
      printed = sweep_csv(map);
    } else {
      for (const AtomicFile& file : files) {
        printed += file.name().string() + ": " + with_commas(map.size()) + " points\n";
      }
    }
  } else {
    const IdentifyReport report =
        identify(subject.spec, subject.material, subject.valid, subject.options, workers);
    for (AtomicFile& file : files) write_text(identify_report_to_json(report), file);
    printed = options.json ? identify_report_to_json(report)
                           : identify_summary(options.file, report, subject.noise_source);
  }
  workers.check();
  for (AtomicFile& file : files) file.commit();
  bar.clear();
  std::cout << printed;
}

}  // namespace

void add_identify_command(CLI::App& program) {
  const auto options = std::make_shared<IdentifyCommandOptions>();
  CLI::App* command = program.add_subcommand("identify", kIdentifySummary);
  command->add_option("FILE", options->file, "material (.json) or table (" + table_endings() + ")")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->outputs,
                   "report to write (.json); with --sweep the map, .csv or .png, repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_text_option(*command, "--grid", options->grid, "GRID",
                  std::string("samples of a material's table, as of tabulate; ") + kDefaultGrid +
                      " where left out");
  add_text_option(*command, "--cells", options->cells, "RULE",
                  "point (the default) or average[:REL], of a material's table");
  add_text_option(*command, "--effects", options->effects, "LIST",
                  "only these components of a material, joined by ',': specular, internal, "
                  "diffuse");
  add_text_option(*command, "--refits", options->refits, "N",
                  "noisy tables that are fitted to verify the prediction; 200 where left out");
  add_text_option(*command, "--sweep", options->sweep, "absorption=LO:HI:N,noise=LO:HI:N",
                  "instead, the map of how many layers can be told, over N absorptions and N "
                  "noises; CSV on standard output without -o");
  add_parameter_options(*command, options->flags);
  add_convention_options(*command, options->flags);
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print the report as JSON instead of a summary");
  command->callback([options] { identify_file(*options); });
}

}  // namespace clothbrdf
