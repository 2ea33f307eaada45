#pragma once

#include <span>
#include <vector>

#include "support/progress.h"
#include "table/sampled_error.h"
#include "table/table.h"

namespace clothbrdf {

/// How a reader finds f_r between the samples of a table.
enum class Reader {
  kNearest,       ///< the value stored in the cell, as MERL's readers do; 0 outside the grid
  kInterpolated,  ///< Table::interpolate
};

/// For people: "nearest", "linear", or the rule of the format's own.
std::string reader_name(const Table& table, Reader reader);

/// What a reader takes from a table at pairs of unit vectors: values[pair][channel].
std::vector<double> read_pairs(const Table& table, Reader reader, std::span<const Directions> pairs,
                               const Workers& workers);

}  // namespace clothbrdf
