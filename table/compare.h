#pragma once

#include <string>
#include <vector>

#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// How far a channel of one table is from that of another, over the cells that both cover. Means
/// and percentiles are over directions: each cell counts by its size, dwi dwo.
struct ChannelDifference {
  std::string channel;
  double rms = 0;  ///< sqrt(mean w (b - a)^2 / mean w a^2), w = (cos theta_i cos theta_o)^2
  double p99 = 0;  ///< 99th percentile of |b - a| / (|a| + 0.001 mean |a|)
  double max = 0;  ///< the largest of that
  std::size_t worst_cell = 0;  ///< of the first table's grid: where it is the largest
  double a = 0;                ///< the values there
  double b = 0;
};

struct Comparison {
  std::size_t cells = 0;   ///< valid and finite in both tables, at the first table's nodes
  std::size_t only_a = 0;  ///< the first table's other valid cells
  std::vector<ChannelDifference> channels;  ///< those that both tables have
};

/// Differences of b from a, at the nodes of a; b is resampled there (resample.h) where its grid is
/// another one. Throws InputError where the tables have no channel or no cell in common.
Comparison compare(const Table& a, const Table& b, const Workers& workers);

}  // namespace clothbrdf
