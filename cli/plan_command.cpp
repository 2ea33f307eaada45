#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/output_names.h"
#include "cli/plan_text.h"
#include "cli/progress_bar.h"
#include "cli/scene_tables.h"
#include "formats/plan_json.h"
#include "formats/scene_json.h"
#include "scene/planner.h"

namespace clothbrdf {
namespace {

struct PlanOptions {
  std::string scene;
  std::optional<std::string> output;
  std::optional<std::string> threads;
  bool json = false;
};

void plan(const PlanOptions& options) {
  const int threads = threads_of(options.threads);
  if (options.output) {
    check_output_names({{"--output", *options.output, ".json"}}, {options.scene});
  }
  const Scene scene = read_scene(options.scene);
  check_scene(scene, options.scene);
  ProgressBar bar;
  const Workers workers(threads, &bar.progress());
  // Opened before any work, so that a wrong folder costs nothing.
  std::optional<AtomicFile> file;
  if (options.output) file.emplace(*options.output);
  const Plan plan = make_plan(scene, workers);
  const std::string json = plan_to_json(plan);
  if (file) {
    write_text(json, *file);
    workers.check();
    file->commit();
  }
  bar.clear();
  std::cout << (options.json ? json : plan_text(plan));
}

}  // namespace

void add_plan_command(CLI::App& program) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* command = program.add_subcommand(
      "plan",
      "Finds the parts of the model that a scene can do without, with a proven bound on the error "
      "of each, given where its lights and eyes can be and the error that is tolerable.\n"
      "Example: clothbrdf plan examples/scenes/silk_dress.json -o plan.json");
  command->add_option("SCENE", options->scene, "scene file (JSON)")->required()->type_name("FILE");
  add_text_option(*command, "-o,--output", options->output, "PLAN",
                  "plan to write (.json), for eval --plan");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print the plan as JSON instead of a summary");
  command->callback([options] { plan(*options); });
}

}  // namespace clothbrdf
