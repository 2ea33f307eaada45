#include "table/table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "table/nearest_sample.h"
#include "table/reached_cells.h"
#include "table/stencil.h"

namespace clothbrdf {
namespace {

// The product of four pairs of shares adds up to 1 to within some epsilons.
constexpr double kWeightRounding = 1e-14;
// The angles of a node come back to this part of a cell: less is no share in a neighbour.
constexpr double kAngleRounding = 1e-9;

}  // namespace

Table::Table(TableSpec spec, std::vector<double> values, std::vector<std::uint8_t> valid,
             StoredPrecision precision, std::shared_ptr<const Interpolant> interpolant)
    : spec_(std::move(spec)),
      values_(std::move(values)),
      valid_(std::move(valid)),
      precision_(precision),
      interpolant_(std::move(interpolant)) {
  if (values_.size() != spec_.cell_count() * spec_.channels.size() ||
      valid_.size() != spec_.cell_count()) {
    throw std::invalid_argument(
        "table: the numbers of values and cells do not match its axes and channels");
  }
  if (spec_.has_pairs() && !interpolant_) {
    interpolant_ = std::make_shared<NearestSample>(spec_, values_, valid_);
  }
}

void Table::fill_rows(std::size_t first_row, std::span<double> values) const {
  const auto from = values_.begin() + static_cast<std::ptrdiff_t>(first_row * spec_.row_values());
  std::copy_n(from, values.size(), values.begin());
}

void Table::fill_pairs(std::span<const Directions> pairs, std::span<double> values) const {
  const std::size_t channels = spec_.channels.size();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    interpolate(pairs[p], values.subspan(p * channels, channels));
  }
}

std::string Table::interpolation() const {
  return interpolant_ ? interpolant_->rule() : "linear between nodes";
}

bool Table::interpolate(const Directions& directions, std::span<double> values) const {
  std::fill(values.begin(), values.end(), 0.0);
  if (!directions.above_horizon()) return false;
  if (interpolant_) {
    const bool finite = interpolant_->interpolate(directions, values) &&
                        std::all_of(values.begin(), values.end(),
                                    [](double value) { return std::isfinite(value); });
    if (!finite) std::fill(values.begin(), values.end(), 0.0);
    return finite;
  }
  const Stencil around = linear_stencil(spec_.grid(), directions);
  double total = 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    const std::size_t cell = around.cells[k];
    if (!valid(cell) || !finite(cell)) continue;
    for (std::size_t c = 0; c < values.size(); ++c) {
      values[c] += around.weights[k] * value(cell, c);
    }
    total += around.weights[k];
  }
  if (total <= kAngleRounding) {
    std::fill(values.begin(), values.end(), 0.0);
    return false;
  }
  // Weights that should add up to 1 may miss it by a rounding, which would be seen at the nodes.
  if (std::abs(total - 1) > kWeightRounding) {
    for (double& v : values) v /= total;
  }
  return true;
}

bool Table::finite(std::size_t cell) const {
  for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
    if (!std::isfinite(value(cell, c))) return false;
  }
  return true;
}

double Table::value(std::size_t cell, std::size_t channel) const {
  const std::size_t columns = spec_.column_count();
  return values_[(cell / columns * spec_.channels.size() + channel) * columns + cell % columns];
}

std::vector<std::uint8_t> cells_with_values(const TableSpec& spec) {
  if (!spec.has_grid()) return std::vector<std::uint8_t>(spec.cell_count(), 1);
  std::vector<std::uint8_t> cells =
      spec.grid().above_horizon(spec.cells.average ? CellPart::kAny : CellPart::kNode);
  if (spec.reach) ReachedCells(spec.grid(), *spec.reach).restrict(cells);
  return cells;
}

void mask_not_measured(const TableSpec& spec, std::span<const double> values,
                       std::span<std::uint8_t> valid) {
  const std::size_t columns = spec.column_count();
  for (std::size_t at = 0; at < values.size(); ++at) {
    if (values[at] < 0) valid[at / spec.row_values() * columns + at % columns] = 0;
  }
}

Table without_components(const Table& table) {
  TableSpec spec = table.spec();
  std::erase_if(spec.channels, [](const Channel& c) { return c.part != Part::kTotal; });
  std::vector<double> values;
  values.reserve(spec.cell_count() * spec.channels.size());
  std::vector<std::uint8_t> valid(spec.cell_count());
  const std::size_t columns = spec.column_count();
  for (std::size_t row = 0; row < spec.row_count(); ++row) {
    for (std::size_t c = 0; c < table.spec().channels.size(); ++c) {
      if (table.spec().channels[c].part != Part::kTotal) continue;
      const auto from = table.values().subspan((row * table.spec().channels.size() + c) * columns);
      values.insert(values.end(), from.begin(),
                    from.begin() + static_cast<std::ptrdiff_t>(columns));
    }
  }
  for (std::size_t cell = 0; cell < valid.size(); ++cell) valid[cell] = table.valid(cell) ? 1 : 0;
  return {std::move(spec), std::move(values), std::move(valid), table.precision()};
}

Table collect(const Producer& producer, Workers workers) {
  const TableSpec& spec = producer.spec();
  std::vector<double> values(spec.cell_count() * spec.channels.size());
  stream_rows(producer, workers, [&](std::size_t first_row, std::span<double> rows) {
    std::copy(rows.begin(), rows.end(),
              values.begin() + static_cast<std::ptrdiff_t>(first_row * spec.row_values()));
  });
  return {spec, std::move(values), cells_with_values(spec)};
}

}  // namespace clothbrdf
