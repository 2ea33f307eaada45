#include "cost/dry_run.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "cost/prediction.h"

namespace clothbrdf {
namespace {

constexpr std::size_t kPredictedPairs = 100000;
constexpr std::uint64_t kPredictedSeed = 3;

struct Cost {
  double seconds;
  double bytes;
};

Cost cost_of(const FileOrder& order, const FileSetting& setting, const Workers& workers) {
  AtomicFile scratch(order.name);
  const auto start = std::chrono::steady_clock::now();
  write_setting(order, setting, scratch, workers);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {taken.count(), static_cast<double>(scratch.size())};
}

// The same grid with about `rows` rows: every so many theta_h.
FileSetting fewer_rows(FileSetting setting, std::size_t rows) {
  Grid grid = std::get<Grid>(setting.samples);
  Axis& first = grid.axes[0];
  const std::size_t rows_each = grid.row_count() / static_cast<std::size_t>(first.size);
  const int size = std::max(2, static_cast<int>(rows / rows_each));
  if (size >= first.size) return setting;
  if (first.spacing == Spacing::kListed) {
    std::vector<double> nodes;
    nodes.reserve(static_cast<std::size_t>(size));
    for (int k = 0; k < size; ++k)
      nodes.push_back(first.node_deg(k * (first.size - 1) / (size - 1)));
    first.listed_deg = std::move(nodes);
  }
  first.size = size;
  setting.samples = std::move(grid);
  return setting;
}

double rows_of(const FileSetting& setting) {
  return static_cast<double>(std::get<Grid>(setting.samples).row_count());
}

// By two small files and a straight line; none where the format takes no other grids, or the file
// is small itself.
std::optional<Cost> extrapolated(const FileOrder& order, const FileSetting& setting,
                                 const Workers& workers) {
  constexpr double kSmallValues = 6e6;
  constexpr double kLargeValues = 30e6;
  const Grid* const grid = std::get_if<Grid>(&setting.samples);
  if (grid == nullptr || setting.cells.average) return std::nullopt;
  const TableSpec spec = computed_spec(order, setting);
  const double values = static_cast<double>(spec.cell_count() * spec.channels.size());
  if (values < 1.5 * kLargeValues) return std::nullopt;
  const auto row_values = static_cast<double>(spec.row_values());
  const FileSetting small =
      fewer_rows(setting, static_cast<std::size_t>(kSmallValues / row_values));
  const FileSetting large =
      fewer_rows(setting, static_cast<std::size_t>(kLargeValues / row_values));
  if (rows_of(large) <= rows_of(small) || !is_allowed(order, large)) return std::nullopt;
  // The first run starts threads and fetches code, as the real one will.
  const Cost first = cost_of(order, small, workers);
  const Cost a = cost_of(order, small, workers);
  const Cost b = cost_of(order, large, workers);
  const double more = rows_of(large) - rows_of(small);
  const double rest = rows_of(setting) - rows_of(small);
  return Cost{first.seconds + std::max(0.0, b.seconds - a.seconds) / more * rest,
              a.bytes + (b.bytes - a.bytes) / more * rest};
}

}  // namespace

Prediction predict_file(const FileOrder& order, const FileSetting& setting,
                        const Workers& workers) {
  const std::optional<Cost> by_rows = extrapolated(order, setting, workers);
  const Cost cost = by_rows ? *by_rows : cost_of(order, setting, workers);
  const bool isotropic = computed_spec(order, setting).isotropic();
  const PairModel model(order, isotropic, workers);
  const Exact exact = exact_values(model.get(), kPredictedPairs, kPredictedSeed, workers);
  Prediction prediction;
  prediction.error.pairs = exact.sampled.pairs.size();
  prediction.error.of_mean = isotropic;
  if (isotropic) {
    const PairModel cloth(order, false, workers);
    prediction.isotropy_loss =
        error_of(model.get(), exact_values(cloth.get(), kPredictedPairs, kPredictedSeed, workers),
                 workers)
            .rms;
  }
  prediction.seconds = cost.seconds;
  prediction.bytes = static_cast<std::uint64_t>(cost.bytes);
  const Reader reader = order.format->reader;
  if (by_rows) {
    const PointCells cells(model.get(), std::get<Grid>(setting.samples), reader,
                           order.format->precision(setting.options));
    prediction.error.error = error_of(cells, exact, workers);
    prediction.error.reader = reader == Reader::kNearest ? "nearest" : "linear";
  } else {
    // Pairs are drawn from all directions, so all cells are needed, unless they are dear.
    FileOrder whole = order;
    if (!setting.cells.average) whole.reach.reset();
    const Table table = written_and_read(whole, setting, workers);
    prediction.error.error = error_of(table, reader, exact, workers);
    prediction.error.reader = reader_name(table, reader);
  }
  return prediction;
}

}  // namespace clothbrdf
