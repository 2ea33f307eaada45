#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "table/table.h"

namespace clothbrdf::test {

/// A table of one channel R: value(cell) in the cells whose node is above the horizon, 0 in others.
inline Table plain_table(const Grid& grid, const std::function<double(std::size_t)>& value,
                         StoredPrecision precision = {}) {
  TableSpec spec{grid, {{"R", Part::kTotal, 0}}, {}, {}};
  std::vector<std::uint8_t> valid = cells_with_values(spec);
  std::vector<double> values(spec.cell_count());
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    if (valid[cell] != 0) values[cell] = value(cell);
  }
  return {std::move(spec), std::move(values), std::move(valid), precision};
}

/// Reflects `albedo` of the light, evenly.
inline Table lambertian(const Grid& grid, double albedo) {
  return plain_table(grid, [=](std::size_t) { return albedo / std::acos(-1.0); });
}

/// The table with other values[row][channel][column] and the same mask.
inline Table with_values(const Table& table, std::vector<double> values) {
  std::vector<std::uint8_t> valid(table.spec().cell_count());
  for (std::size_t cell = 0; cell < valid.size(); ++cell) valid[cell] = table.valid(cell) ? 1 : 0;
  return {table.spec(), std::move(values), std::move(valid), table.precision()};
}

/// The table with each value passed through a function.
inline Table mapped(const Table& table, const std::function<double(double)>& function) {
  std::vector<double> values(table.values().begin(), table.values().end());
  for (double& value : values) value = function(value);
  return with_values(table, std::move(values));
}

/// Where a value stands in values[row][channel][column].
inline std::size_t value_index(const TableSpec& spec, std::size_t cell, std::size_t channel) {
  const std::size_t columns = spec.column_count();
  return (cell / columns * spec.channels.size() + channel) * columns + cell % columns;
}

/// The table with one value replaced.
inline Table with_value(const Table& table, std::size_t cell, std::size_t channel, double value) {
  std::vector<double> values(table.values().begin(), table.values().end());
  values[value_index(table.spec(), cell, channel)] = value;
  return with_values(table, std::move(values));
}

}  // namespace clothbrdf::test
