#include "table/table.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace clothbrdf {

Table::Table(TableSpec spec, std::vector<double> values, std::vector<std::uint8_t> valid)
    : spec_(std::move(spec)), values_(std::move(values)), valid_(std::move(valid)) {
  if (values_.size() != spec_.cell_count() * spec_.channels.size() ||
      valid_.size() != spec_.cell_count()) {
    throw std::invalid_argument(
        "table: the numbers of values and cells do not match its axes and channels");
  }
}

void Table::fill_rows(std::size_t first_row, std::span<double> values) const {
  const auto from = values_.begin() + static_cast<std::ptrdiff_t>(first_row * spec_.row_values());
  std::copy_n(from, values.size(), values.begin());
}

void Table::fill_pairs(std::span<const DirectionPair> pairs, std::span<double> values) const {
  const std::size_t channels = spec_.channels.size();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const DirectionPair& pair = pairs[p];
    std::optional<std::size_t> cell;
    if (spec_.has_grid()) {
      const Vector3<double> wi = direction(pair.theta_i, pair.phi_i);
      const Vector3<double> wo = direction(pair.theta_o, pair.phi_o);
      if (wi[2] > 0 && wo[2] > 0) cell = spec_.grid().cell_of(wi, wo);
    } else {
      const auto found = std::find(spec_.pairs().begin(), spec_.pairs().end(), pair);
      if (found != spec_.pairs().end())
        cell = static_cast<std::size_t>(found - spec_.pairs().begin());
    }
    for (std::size_t c = 0; c < channels; ++c)
      values[p * channels + c] = cell ? value(*cell, c) : 0.0;
  }
}

double Table::value(std::size_t cell, std::size_t channel) const {
  const std::size_t columns = spec_.column_count();
  return values_[(cell / columns * spec_.channels.size() + channel) * columns + cell % columns];
}

std::vector<std::uint8_t> cells_above_horizon(const TableSpec& spec) {
  std::vector<std::uint8_t> valid(spec.cell_count(), 1);
  if (!spec.has_grid()) return valid;
  for (std::size_t cell = 0; cell < valid.size(); ++cell) {
    valid[cell] = spec.cells.average ? spec.grid().any_above_horizon(cell)
                                     : spec.grid().node_above_horizon(cell);
  }
  return valid;
}

Table collect(const Producer& producer, Workers workers) {
  const TableSpec& spec = producer.spec();
  std::vector<double> values(spec.cell_count() * spec.channels.size());
  stream_rows(producer, workers, [&](std::size_t first_row, std::span<double> rows) {
    std::copy(rows.begin(), rows.end(),
              values.begin() + static_cast<std::ptrdiff_t>(first_row * spec.row_values()));
  });
  return {spec, std::move(values), cells_above_horizon(spec)};
}

}  // namespace clothbrdf
