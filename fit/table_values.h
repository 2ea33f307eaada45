#pragma once

#include <limits>

#include "fit/rows.h"
#include "table/table.h"

namespace clothbrdf {

/// The values of a table's valid cells. Holds references.
inline ValueSource table_values(const Table& table, const Observations& observations) {
  return [&table, &observations](std::size_t group, std::size_t channel, std::span<double> values) {
    const Observations::Group& g = observations.groups[group];
    const std::size_t columns = table.spec().column_count();
    const std::size_t row_values = table.spec().row_values();
    const std::size_t cell = g.first_value / row_values * columns + g.first_value % row_values;
    const double* const from =
        table.values().data() + g.first_value + channel * observations.value_stride;
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = table.valid(cell + k) ? from[k] : std::numeric_limits<double>::quiet_NaN();
    }
  };
}

}  // namespace clothbrdf
