#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "table/grid.h"

namespace clothbrdf {

/// Pairs of directions for means over all pairs whose light and eye are both uniform on the
/// hemisphere below kSampledTheta degrees. Half of them are drawn so; the other half where errors
/// of tables of narrow lobes are: near mirror reflection and towards grazing light. Each counts by
/// its share (importance sampling), so that means are those over uniform pairs, with a fifth of
/// their noise: errors of 100,000 pairs repeat to about 2 %.
struct SampledPairs {
  std::vector<Directions> pairs;
  std::vector<double> shares;  ///< of all pairs; they add up to 1
};

inline constexpr double kSampledTheta = 85;

/// Draws `count` pairs and keeps those below kSampledTheta, about 0.8 of them. The same ones for
/// the same seed.
SampledPairs sampled_pairs(std::size_t count, std::uint64_t seed);

// Of TableError and of the differences of two tables.
inline constexpr double kPercentile = 0.99;
inline constexpr double kRelativeFloor = 1e-3;  ///< differences are relative to f + this x mean f

/// How far values read from a table are from the exact ones (docs/accuracy.md).
struct TableError {
  double rms = 0;  ///< sqrt(sum w (read - f)^2 / sum w f^2), w = (cos theta_i cos theta_o)^2
  double p99 = 0;  ///< 99th percentile of |read - f| / (f + 0.001 mean f)
  double max = 0;  ///< the largest of that

  bool operator==(const TableError&) const = default;
};

/// Sums run over pairs and channels: exact[pair][channel], read[pair][channel]. 0 where read equals
/// exact everywhere; infinite where exact is 0 everywhere and read is not.
TableError table_error(const SampledPairs& sampled, std::span<const double> exact,
                       std::span<const double> read);

}  // namespace clothbrdf
