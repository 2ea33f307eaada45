#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fit/observations.h"
#include "fit/options.h"
#include "support/progress.h"

namespace clothbrdf {

/// The least-squares problem of a table: rows of
///
///     sum over a group's sites of coefficient * B + coefficient * D - target
///
/// already multiplied by the square roots of their weights.
struct Rows {
  /// Rows of one group and channel: numbers[first + row * (sites + 2) + k], k over sites, D,
  /// target.
  struct Block {
    std::uint32_t group;
    std::uint32_t channel;
    std::uint32_t count;
    std::size_t first;
  };
  /// All rows coefficient * D - target of a channel, turned into one.
  struct Diffuse {
    double coefficient = 0;
    double target = 0;
    double add(const Diffuse& row);  ///< returns the square that no D changes
  };

  std::vector<Block> blocks;              ///< ordered by group
  std::vector<std::size_t> bundle_block;  ///< first block of each bundle, and the end
  std::vector<double> numbers;
  std::vector<Diffuse> diffuse;  ///< [channel]
  double constant = 0;           ///< squares that no material changes
  std::size_t values = 0;        ///< of the table that are in
  std::size_t masked = 0;        ///< above the horizon and not in: not valid, negative, not finite
  double target_square = 0;      ///< of all values, weighted
  std::size_t row_count() const;
};

/// B at all sites, D in all channels: the fit that weights come from.
struct ModelValues {
  std::vector<double> site;     ///< [site][channel]
  std::vector<double> diffuse;  ///< [channel]
};

/// Fills the values of a group's samples in a channel; not a number where there is none.
using ValueSource =
    std::function<void(std::size_t group, std::size_t channel, std::span<double> values)>;

/// How residuals are weighted.
struct RowWeights {
  Weighting weighting = Weighting::kRelative;
  Loss loss = Loss::kSquared;
  double noise = 0;  ///< scale of the robust losses
};

/// The rows of a table. `reduce`: for each group and channel the QR factor of its samples, with
/// the same sum of squares at every material, up to the constant (model.md 8.4); otherwise one row
/// a value. `fit`: weights come from it; where there is none, from smoothed values.
Rows make_rows(const Observations& observations, const ValueSource& source,
               const RowWeights& weights, const ModelValues* fit, bool reduce, Workers workers);

}  // namespace clothbrdf
