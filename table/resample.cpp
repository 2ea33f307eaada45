#include "table/resample.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/threads.h"

namespace clothbrdf {
namespace {

bool tells_orders_apart(const TableSpec& spec) {
  if (!spec.has_grid()) return true;
  return !spec.grid().folds_orders();
}

// Means of valid, finite cells, which are taken one after the other.
class Mean {
 public:
  explicit Mean(std::size_t channels) : sum_(channels) {}
  void add(std::span<const double> sample) {
    for (std::size_t c = 0; c < sum_.size(); ++c) sum_[c] += sample[c];
    ++count_;
  }
  /// False where nothing was added.
  bool take(std::vector<double>& values) {
    const bool any = count_ > 0;
    values.assign(sum_.size(), 0.0);
    for (std::size_t c = 0; any && c < sum_.size(); ++c) values[c] = sum_[c] / count_;
    std::fill(sum_.begin(), sum_.end(), 0.0);
    count_ = 0;
    return any;
  }

 private:
  std::vector<double> sum_;
  int count_ = 0;
};

// Values of a cell; false where it has none.
using CellFunction = std::function<bool(std::size_t cell, std::vector<double>& values)>;

// A table like `source` but for its samples and values; a phase of the progress.
Table tabulated(const Table& source, const Samples& samples, const Workers& workers,
                const char* what, const std::function<CellFunction()>& make_function) {
  TableSpec spec = source.spec();
  spec.samples = samples;
  spec.cells = {};  // whatever the source's cells were: values are taken at nodes
  spec.provenance.error.reset();
  // Where a scene does not reach nothing is known, either.
  const double mark = spec.provenance.material && !spec.reach ? 0 : kNotMeasured;
  if (!spec.has_grid()) spec.reach.reset();
  const std::size_t columns = spec.column_count();
  std::vector<double> values(spec.cell_count() * spec.channels.size());
  std::vector<std::uint8_t> valid(spec.cell_count());
  if (workers.progress != nullptr) workers.progress->begin(what, spec.cell_count(), "cells");
  with_threads(workers.threads, [&] {
    run_parallel(spec.row_count(), workers, [&](std::size_t row) {
      const CellFunction function = make_function();
      std::vector<double> sample;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t cell = row * columns + column;
        if (!spec.node_above_horizon(cell)) continue;
        valid[cell] = function(cell, sample) ? 1 : 0;
        if (valid[cell] == 0) sample.assign(sample.size(), mark);
        for (std::size_t c = 0; c < sample.size(); ++c) {
          values[row * spec.row_values() + c * columns + column] = sample[c];
        }
      }
      workers.advance(columns);
    });
  });
  return {std::move(spec), std::move(values), std::move(valid), source.precision()};
}

// Adds f_r with the cloth turned back by each of `rotations` equal steps.
void add_rotations(const Table& source, const Directions& d, int rotations,
                   std::span<double> sample, Mean& mean) {
  for (int k = 0; k < rotations; ++k) {
    const SinCos<double> turn = sincosd(360.0 * k / rotations);
    if (source.interpolate({turned(d.wi, turn), turned(d.wo, turn)}, sample)) mean.add(sample);
  }
}

// The mean over rotations of the cloth, at the nodes of the source's azimuths (as many even steps
// where these are not even): a half/difference table without phi_h, or an in/out table with one
// phi_i, which stands for any.
Table isotropic_mean(const Table& source, const Workers& workers) {
  const Grid& from = source.spec().grid();
  Grid to = from;
  if (from.kind == GridKind::kInOut) {
    to.axes[1].size = 1;
  } else {
    to.kind = GridKind::kHalfDifference3d;
    to.axes.erase(to.axes.begin() + 1);
  }
  const std::size_t channels = source.spec().channels.size();
  return tabulated(source, to, workers, "mean over rotations", [&]() -> CellFunction {
    return [&, mean = Mean(channels), sample = std::vector<double>(channels)](
               std::size_t cell, std::vector<double>& values) mutable {
      const Directions d = to.directions(cell);
      if (!from.regular()) {
        add_rotations(source, d, rotation_count(source.spec()), sample, mean);
        return mean.take(values);
      }
      for (int k = 0; k < from.axes[1].size; ++k) {
        const SinCos<double> turn = sincosd(from.axes[1].node_deg(k));
        if (source.interpolate({turned(d.wi, turn), turned(d.wo, turn)}, sample)) mean.add(sample);
      }
      return mean.take(values);
    };
  });
}

// Where tables without a grid are sampled before the mean over rotations is taken: all azimuths of
// the half vector, both orders of the directions together.
Grid once_around() {
  Grid grid = halfdiff4d(45, 72, 45, 45);
  grid.axes[1].highest_deg = 360;
  return grid;
}

}  // namespace

int rotation_count(const TableSpec& source) {
  constexpr int kWithoutGrid = 72;
  if (source.isotropic()) return 1;
  if (!source.has_grid()) return kWithoutGrid;
  const Axis& azimuth = source.grid().axes[1];
  return azimuth.size *
         static_cast<int>(std::lround(360 / (azimuth.highest_deg - azimuth.lowest_deg)));
}

bool averages_rotations(const TableSpec& source, const TableSpec& target) {
  return target.isotropic() && !source.isotropic();
}

bool averages_orders(const TableSpec& source, const TableSpec& target) {
  return tells_orders_apart(source) && !tells_orders_apart(target);
}

Table resample(const Table& source, const Samples& samples, const Workers& workers) {
  if (source.spec().samples == samples) return source;
  TableSpec target = source.spec();
  target.samples = samples;
  const bool isotropic = averages_rotations(source.spec(), target);
  std::optional<Table> mean;
  // Cheaper than a mean for each node of the target.
  if (isotropic && source.spec().has_grid() && target.has_grid()) {
    mean = isotropic_mean(source, workers);
  } else if (isotropic && averages_orders(source.spec(), target) && source.complete()) {
    mean = isotropic_mean(resample(source, once_around(), workers), workers);
  }
  const Table& table = mean ? *mean : source;
  if (table.spec().samples == samples) return table;
  const int rotations = isotropic && !mean ? rotation_count(source.spec()) : 1;
  const std::optional<Material>& material = source.spec().provenance.material;
  const bool reciprocal = material && material->reflectance == Reflectance::kMicrofacet;
  const bool both_orders =
      tells_orders_apart(source.spec()) &&
      ((reciprocal && source.spec().has_grid()) || averages_orders(source.spec(), target));
  const std::size_t channels = source.spec().channels.size();
  return tabulated(source, samples, workers, "resampling", [&]() -> CellFunction {
    return [&, both = Mean(channels), sample = std::vector<double>(channels)](
               std::size_t cell, std::vector<double>& values) mutable {
      const Directions d = target.directions(cell);
      add_rotations(table, d, rotations, sample, both);
      if (both_orders) add_rotations(table, {d.wo, d.wi}, rotations, sample, both);
      return both.take(values);
    };
  });
}

TablePairs::TablePairs(const Table& table, bool isotropic)
    : table_(table), spec_(table.spec()), rotations_(isotropic ? rotation_count(table.spec()) : 1) {
  spec_.samples = AnyPairs{isotropic};
  spec_.cells = {};
  spec_.reach.reset();
}

void TablePairs::fill_rows(std::size_t /*none*/, std::span<double> /*none*/) const {
  throw std::logic_error("pairs have no rows");
}

void TablePairs::fill_pairs(std::span<const Directions> pairs, std::span<double> values) const {
  const std::size_t channels = spec_.channels.size();
  Mean mean(channels);
  std::vector<double> sample(channels);
  std::vector<double> taken;
  for (const Directions& pair : pairs) {
    add_rotations(table_, pair, rotations_, sample, mean);
    if (!mean.take(taken) && pair.above_horizon()) ++unanswered_;
    std::copy(taken.begin(), taken.end(), values.begin());
    values = values.subspan(channels);
  }
}

}  // namespace clothbrdf
