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
#include "fit/fit.h"
#include "formats/fit_report_json.h"
#include "formats/image.h"
#include "formats/material_json.h"
#include "model/parameters.h"
#include "preview/fit_slices.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

struct FitCommandOptions {
  std::string table;
  std::optional<std::string> report;
  std::optional<std::string> material;
  std::optional<std::string> picture;
  FitFlags flags;
  std::optional<std::string> threads;
  bool json = false;
};

/// The files of a fit, opened before the work so that a wrong folder costs nothing.
struct FitFiles {
  std::optional<AtomicFile> report;
  std::optional<AtomicFile> material;
  std::optional<AtomicFile> picture;
};

void check_outputs(const FitCommandOptions& options) {
  std::vector<OutputName> outputs;
  if (options.report) outputs.push_back({"--output", *options.report, ".json"});
  if (options.material) outputs.push_back({"--material", *options.material, ".json"});
  if (options.picture) {
    check_picture_name(*options.picture);
    outputs.push_back({"--picture", *options.picture, ""});
  }
  std::vector<std::string> inputs = options.flags.inputs();
  inputs.push_back(options.table);
  check_output_names(outputs, inputs);
}

FitFiles open_files(const FitCommandOptions& options) {
  FitFiles files;
  if (options.report) files.report.emplace(*options.report);
  if (options.material) files.material.emplace(*options.material);
  if (options.picture) files.picture.emplace(*options.picture);
  return files;
}

// For people, like a preset's.
void name_material(const FitCommandOptions& options, Material& material) {
  const std::filesystem::path name(options.material.value_or(options.table));
  if (material.name.empty()) material.name = name.stem().string();
  if (material.description.empty()) {
    material.description =
        "Fitted to " + std::filesystem::path(options.table).filename().string() + ".";
  }
}

/// Why a fit has no material that a file can hold; empty where it has one.
std::string what_is_missing(const FitReport& report) {
  if (!report.failure.empty()) return report.failure;
  const std::optional<MaterialProblem> problem = find_problem(report.material);
  return problem ? "the material fits no material file: " + problem->pointer + ": " +
                       problem->value + " is not allowed: " + problem->allowed
                 : "";
}

/// Commits all that can be written; the names of what cannot.
std::string write_files(const FitReport& report, bool has_material, const Table& table,
                        const Workers& workers, FitFiles& files) {
  std::string left_out;
  if (has_material) {
    if (files.material) write_text(material_to_json(report.material), *files.material);
    if (files.picture) {
      write_picture(fit_slices(table, report.material, workers), *files.picture);
    }
  }
  if (files.report) write_text(fit_report_to_json(report), *files.report);
  workers.check();
  if (files.report) files.report->commit();
  for (std::optional<AtomicFile>* file : {&files.material, &files.picture}) {
    if (!*file) continue;
    if (has_material) {
      (*file)->commit();
    } else {
      left_out += (left_out.empty() ? "" : ", ") + (*file)->name().string();
    }
  }
  return left_out;
}

std::string what_was_written(const FitCommandOptions& options, const std::string& left_out) {
  std::string names;
  const auto add = [&](const std::optional<std::string>& name) {
    if (name) names += (names.empty() ? "" : ", ") + *name;
  };
  add(options.report);
  if (left_out.empty()) {
    add(options.material);
    add(options.picture);
  }
  return names.empty() ? "" : labelled("written", names);
}

void fit(const FitCommandOptions& options) {
  const int threads = threads_of(options.threads);
  check_outputs(options);
  const Table table = read_totals(options.table);
  const FitOptions fit_options = read_fit_options(options.flags, table.spec().channels);
  ProgressBar bar;
  const Workers workers{threads, &bar.progress()};
  FitFiles files = open_files(options);
  FitReport report = fit_table(table, fit_options, workers);
  report.table = options.table;
  add_wavelengths(table.spec().channels, report);
  if (report.failure.empty()) name_material(options, report.material);
  const std::string missing = what_is_missing(report);
  const bool has_material = missing.empty();
  const std::string left_out = write_files(report, has_material, table, workers, files);
  bar.clear();
  std::cout << (options.json ? fit_report_to_json(report)
                             : fit_summary(report) + what_was_written(options, left_out));

  // A material that no file can hold is no trouble for who wants none.
  std::string trouble = report.failure.empty() && left_out.empty() ? "" : missing;
  if (report.failure.empty() && !report.converged) {
    trouble = "the fit did not converge: " + report.termination +
              (report.message.empty() ? "" : ": " + report.message);
  }
  if (trouble.empty()) return;
  if (!left_out.empty()) trouble += "; not written: " + left_out;
  throw WorkError(options.table + ": " + trouble);
}

}  // namespace

void add_fit_command(CLI::App& program) {
  const auto options = std::make_shared<FitCommandOptions>();
  CLI::App* command = program.add_subcommand("fit", kFitSummary);
  command->add_option("TABLE", options->table, "table (" + table_endings() + ")")
      ->required()
      ->type_name("FILE");
  add_text_option(*command, "-o,--output", options->report, "REPORT", "report to write (.json)");
  add_text_option(*command, "--material", options->material, "FILE",
                  "fitted material to write (.json)");
  add_text_option(*command, "--picture", options->picture, "FILE",
                  "table against fit in slices, a picture to write (.png or .exr)");
  add_solver_options(*command, options->flags);
  add_parameter_options(*command, options->flags);
  add_convention_options(*command, options->flags);
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print the report as JSON instead of a summary");
  command->callback([options] { fit(*options); });
}

}  // namespace clothbrdf
