#include "cost/measure.h"

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "cost/convergence.h"
#include "cost/fidelity.h"
#include "cost/file_order.h"
#include "cost/front.h"
#include "cost/plan.h"
#include "cost/prediction.h"
#include "cost/timing.h"
#include "formats/format_colours.h"
#include "model/parameters.h"
#include "support/peak_memory.h"
#include "support/version.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

constexpr int kRepeats = 3;

// Work is counted for all settings together, not for each file.
Workers uncounted(const Workers& workers) { return {workers.threads, nullptr}; }

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Computing all values of a grid, and dropping them.
Timing computing_time(const FileOrder& order, const FileSetting& setting, int threads) {
  return timing_of(kRepeats, [&] {
    return seconds_of([&] {
      const auto producer =
          make_producer(computed_spec(order, setting), threads, kernel_precision(order, setting));
      stream_rows(*producer, threads, [](std::size_t, std::span<double>) {});
    });
  });
}

struct Measured {
  CostSetting costs;  // without error and reader
  Table table;
};

// Everything but the error.
Measured measured_file(const FileOrder& order, const FileSetting& setting, const Workers& workers) {
  CostSetting costs;
  const auto whole = [&] {
    AtomicFile file(order.name);
    const double seconds = seconds_of([&] { write_setting(order, setting, file, workers); });
    costs.bytes = file.size();
    return seconds;
  };
  const PeakMemory peak;
  whole();  // unseen: what all runs share is ready from here on
  costs.peak_memory = peak.added();
  costs.seconds = timing_of(kRepeats, whole);
  if (std::holds_alternative<Grid>(setting.samples)) {
    costs.one_thread = computing_time(order, setting, 1);
    costs.all_threads = computing_time(order, setting, workers.threads);
  }
  Table table = written_and_read(order, setting, workers);
  if (std::holds_alternative<Grid>(setting.samples)) {
    WriteOptions options = setting.options;
    options.workers = workers;
    costs.writing = timing_of(kRepeats, [&] {
      AtomicFile file(order.name);
      return seconds_of([&] { write_table(*order.format, table, file, options); });
    });
  }
  return {std::move(costs), std::move(table)};
}

// One setting for each reader of the file.
void measure_file(const FileOrder& any, const PlannedFile& file, const Exact& exact,
                  std::optional<double> isotropy_loss, const Workers& workers,
                  std::vector<CostSetting>& settings) {
  FileOrder order = any;
  order.format = find_format("cost" + file.ending);
  order.options.half = file.half;
  if (file.bytes > 0) order.options.bytes = file.bytes;
  const FileSetting setting{file.samples, file.cells, order.options};
  if (!is_allowed(order, setting)) return;
  if (file.half && !values_fit(order, setting, workers)) return;
  const Measured measured = measured_file(order, setting, workers);
  const TableSpec spec = computed_spec(order, setting);
  const Layout layout =
      order.format->layout(in_colours_of(*order.format, spec, order.options), order.options);
  const int bytes = order.format->precision(order.options).bytes;
  // A format may hold other colours than the material has.
  std::optional<Exact> in_its_colours;
  if (measured.table.spec().channels.size() != spec.channels.size()) {
    const PairModel model(order, any.isotropic, workers);
    in_its_colours = exact_values(model.get(), kCostPairs, kCostSeed, workers);
  }
  for (const Reader reader : file.readers) {
    CostSetting s = measured.costs;
    s.dial = file.dial;
    s.front = any.isotropic ? "3-D" : "4-D";
    s.format = order.format->name;
    s.grid = file.even_axes ? std::get<Grid>(file.samples).sizes() + " even in angle"
                            : layout.description;
    s.cells = file.cells.average ? "average:" + number_text(file.cells.tolerance) : "point";
    s.stored = bytes == 2 ? "half" : bytes == 4 ? "float" : "double";
    s.reader = measured.table.interpolant() ? "its own" : reader_name(measured.table, reader);
    s.size = static_cast<double>(layout.cells);
    s.error = error_of(measured.table, reader, in_its_colours ? *in_its_colours : exact, workers);
    s.isotropy_loss = isotropy_loss;
    s.name = s.format + " " + s.grid + (file.cells.average ? " " + s.cells : "") + " " + s.stored +
             ", " + s.reader;
    settings.push_back(std::move(s));
  }
}

}  // namespace

CostReport measure_cost(const Material& material, const std::filesystem::path& scratch_folder,
                        const Workers& workers) {
  CostReport report;
  report.program = std::string("clothbrdf ") + kVersion;
  report.material = material;
  report.threads = workers.threads;
  report.repeats = kRepeats;
  report.seed = kCostSeed;
  FileOrder order{material, {}, false, find_format("cost.exr"), {}, false, {}};
  order.name = (scratch_folder / ("clothbrdf_cost_" + unguessable_digits())).string();
  const Workers quiet = uncounted(workers);

  const PairModel cloth(order, false, quiet);
  const PairModel mean(order, true, quiet);
  const Exact of_cloth = exact_values(cloth.get(), kCostPairs, kCostSeed, quiet);
  const Exact of_mean = exact_values(mean.get(), kCostPairs, kCostSeed, quiet);
  report.pairs = of_cloth.sampled.pairs.size();
  const double loss = error_of(mean.get(), of_cloth, quiet).rms;
  const auto nodes = [&](const PairModel& model, const Exact& exact) {
    return ChosenNodes(model.get(), exact.sampled, exact.values, Metric::kRms, quiet);
  };
  const std::vector<PlannedFile> files3 =
      isotropic_files(nodes(mean, of_mean), material.reflectance);
  const std::vector<PlannedFile> files4 =
      anisotropic_files(nodes(cloth, of_cloth), material.reflectance);
  if (workers.progress != nullptr) {
    workers.progress->begin("cost", files3.size() + files4.size() + fidelity_settings(material),
                            "settings");
  }
  for (const bool isotropic : {true, false}) {
    order.isotropic = isotropic;
    for (const PlannedFile& file : isotropic ? files3 : files4) {
      measure_file(order, file, isotropic ? of_mean : of_cloth,
                   isotropic ? std::optional(loss) : std::nullopt, quiet, report.settings);
      workers.advance(1);
    }
  }
  for (CostSetting& s :
       measure_fidelity(material, of_cloth.sampled, of_cloth.values, kRepeats, workers)) {
    report.settings.push_back(std::move(s));
  }
  mark_fronts(report.settings);
  report.convergence = convergence(material, report.settings);
  report.sentences = sentences(report.settings);
  return report;
}

}  // namespace clothbrdf
