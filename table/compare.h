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
  std::size_t worst_cell = 0;  ///< of the samples compared: where it is the largest
  std::string place = {};      ///< the same for people
  double a = 0;                ///< the values there
  double b = 0;
};

struct Comparison {
  std::string samples;     ///< where, for people: "the nodes of halfdiff3d:90x90x180"
  std::size_t cells = 0;   ///< valid and finite in both tables
  std::size_t only_a = 0;  ///< other samples that are valid in the first table
  std::vector<ChannelDifference> channels;  ///< those that both tables have
};

/// Pairs at which tables without a grid are compared: both directions uniform on the hemisphere
/// below kComparedTheta degrees, the same ones each time.
inline constexpr std::size_t kComparedPairs = 50000;
inline constexpr double kComparedTheta = 85;
PairList compared_pairs(bool isotropic);

/// Differences of the second table from the first, at the nodes of the first's grid or at its
/// scattered samples; the second is resampled there (resample.h) where its samples are others. A
/// table that has no grid but answers all pairs is compared at kComparedPairs random ones. Throws
/// InputError where the tables have no channel or no cell in common.
Comparison compare(const Table& first, const Table& second, const Workers& workers);

}  // namespace clothbrdf
