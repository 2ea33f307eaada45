#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "table/producer.h"

namespace clothbrdf {

/// A table in memory, immutable. Values are f_r in 1/sr, without the cosine.
class Table final : public Producer {
 public:
  /// values[row][channel][column]; valid[cell] is 0 where a cell holds no measurement or lies below
  /// the horizon. Throws std::invalid_argument where the sizes do not match the spec.
  Table(TableSpec spec, std::vector<double> values, std::vector<std::uint8_t> valid);

  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t first_row, std::span<double> values) const override;
  /// The value of the cell that holds the pair: no interpolation; 0 outside the grid, below the
  /// horizon and, for a list of pairs, at pairs that are not in it.
  void fill_pairs(std::span<const DirectionPair> pairs, std::span<double> values) const override;

  double value(std::size_t cell, std::size_t channel) const;
  bool valid(std::size_t cell) const { return valid_[cell] != 0; }
  std::span<const double> values() const { return values_; }

 private:
  TableSpec spec_;
  std::vector<double> values_;
  std::vector<std::uint8_t> valid_;
};

/// Which cells of a table made from a material hold a value: those above the horizon (all, for a
/// list of pairs).
std::vector<std::uint8_t> cells_above_horizon(const TableSpec& spec);

/// All of a producer's table in memory, by stream_rows.
Table collect(const Producer& producer, Workers workers);

}  // namespace clothbrdf
