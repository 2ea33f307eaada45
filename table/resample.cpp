#include "table/resample.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "support/threads.h"

namespace clothbrdf {
namespace {

bool tells_orders_apart(const Grid& grid) {
  return grid.kind == GridKind::kInOut || grid.axes.back().highest_deg > 180;
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

// A table like `source` but for its grid and values; a phase of the progress.
Table tabulated(const Table& source, const Grid& grid, const Workers& workers, const char* what,
                const std::function<CellFunction()>& make_function) {
  TableSpec spec = source.spec();
  spec.samples = grid;
  spec.cells = {};  // whatever the source's cells were: values are taken at nodes
  const std::size_t columns = spec.column_count();
  // A computed table has no cells that were not measured.
  const double mark = spec.provenance.material ? 0 : kNotMeasured;
  std::vector<double> values(spec.cell_count() * spec.channels.size());
  std::vector<std::uint8_t> valid(spec.cell_count());
  if (workers.progress != nullptr) workers.progress->begin(what, spec.cell_count(), "cells");
  with_threads(workers.threads, [&] {
    tbb::parallel_for(std::size_t{0}, spec.row_count(), [&](std::size_t row) {
      const CellFunction function = make_function();
      std::vector<double> sample;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t cell = row * columns + column;
        if (!grid.node_above_horizon(cell)) continue;
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

// The mean over rotations of the cloth, at the nodes of the source's azimuths: a half/difference
// table without phi_h, or an in/out table with one phi_i, which stands for any.
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
      for (int k = 0; k < from.axes[1].size; ++k) {
        const SinCos<double> turn = sincosd(from.axes[1].node_deg(k));
        if (source.interpolate({turned(d.wi, turn), turned(d.wo, turn)}, sample)) mean.add(sample);
      }
      return mean.take(values);
    };
  });
}

}  // namespace

bool averages_rotations(const Grid& source, const Grid& target) {
  return target.kind == GridKind::kHalfDifference3d && source.kind != GridKind::kHalfDifference3d;
}

bool averages_orders(const Grid& source, const Grid& target) {
  return tells_orders_apart(source) && !tells_orders_apart(target);
}

Table resample(const Table& source, const Grid& grid, const Workers& workers) {
  const Grid& from = source.spec().grid();
  if (from == grid) return source;
  const bool isotropic = averages_rotations(from, grid);
  std::optional<Table> mean;
  if (isotropic) mean = isotropic_mean(source, workers);
  const Table& table = mean ? *mean : source;
  if (table.spec().grid() == grid) return table;
  const std::optional<Material>& material = source.spec().provenance.material;
  const bool reciprocal = material && material->reflectance == Reflectance::kMicrofacet;
  const bool both_orders = tells_orders_apart(from) && (reciprocal || averages_orders(from, grid));
  const std::size_t channels = source.spec().channels.size();
  return tabulated(source, grid, workers, "resampling", [&]() -> CellFunction {
    return [&, both = Mean(channels), sample = std::vector<double>(channels)](
               std::size_t cell, std::vector<double>& values) mutable {
      const auto add = [&](const Vector3<double>& wi, const Vector3<double>& wo) {
        if (table.interpolate({wi, wo}, sample)) both.add(sample);
      };
      const Directions d = grid.directions(cell);
      add(d.wi, d.wo);
      if (both_orders) add(d.wo, d.wi);
      return both.take(values);
    };
  });
}

}  // namespace clothbrdf
