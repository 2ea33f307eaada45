#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/cost_text.h"
#include "cli/gnuplot.h"
#include "cli/options.h"
#include "cli/output_names.h"
#include "cli/progress_bar.h"
#include "cost/measure.h"
#include "cost/plot.h"
#include "formats/cost_report.h"
#include "formats/material_json.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

struct CostOptions {
  std::string material;
  std::vector<std::string> outputs;
  std::optional<std::string> threads;
  bool json = false;
};

bool is_picture(const std::filesystem::path& file) {
  return file.extension() == ".svg" || file.extension() == ".png";
}

void check_outputs(const CostOptions& options) {
  std::vector<OutputName> outputs;
  for (const std::string& file : options.outputs) {
    const std::string ending = std::filesystem::path(file).extension().string();
    if (ending != ".json" && ending != ".csv" && !is_picture(file)) {
      std::string message = "--output: ";
      message.append(file).append(": the ending '").append(ending);
      throw InputError(
          message.append("' is not allowed: .json (report), .csv (table), .svg or .png (picture)"));
    }
    outputs.push_back({"--output", file, ending});
  }
  check_output_names(outputs, {options.material});
}

std::string content_for(const CostReport& report, const std::filesystem::path& file) {
  if (file.extension() == ".json") return cost_report_json(report);
  if (file.extension() == ".csv") return cost_report_csv(report);
  return run_gnuplot(cost_plot(report, file.extension() == ".svg" ? "svg" : "pngcairo"));
}

void measure_material(const CostOptions& options) {
  const int threads = threads_of(options.threads);
  check_outputs(options);
  const Material material = read_material(options.material);
  ProgressBar bar;
  // All opened before any work, so that a wrong folder costs nothing.
  std::vector<AtomicFile> files;
  files.reserve(options.outputs.size());
  bool pictures = false;
  for (const std::string& file : options.outputs) {
    files.emplace_back(file);
    pictures = pictures || is_picture(file);
  }
  if (pictures) require_gnuplot();

  const CostReport report =
      measure_cost(material, std::filesystem::temp_directory_path(), {threads, &bar.progress()});
  bar.clear();
  for (AtomicFile& file : files) write_text(content_for(report, file.name()), file);
  for (AtomicFile& file : files) file.commit();
  std::cout << (options.json ? cost_report_json(report) : cost_text(report));
}

}  // namespace

void add_cost_command(CLI::App& program) {
  const auto options = std::make_shared<CostOptions>();
  CLI::App* command = program.add_subcommand(
      "cost",
      "Measures what tables of a material cost in time, bytes and memory, and how exact they are: "
      "grids, formats, averages and shortcuts of the model against each other.\n"
      "Example: clothbrdf cost materials/silk.json -o cost.json -o cost.png");
  command->add_option("MATERIAL", options->material, "material file (JSON)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->outputs,
                   "file to write, repeatable (.json: report; .csv: table, a line a setting; .svg, "
                   ".png: picture, needs gnuplot)")
      ->type_name("FILE")
      ->allow_extra_args(false);  // what follows the name may be the material
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print the report as JSON");
  command->callback([options] { measure_material(*options); });
}

}  // namespace clothbrdf
