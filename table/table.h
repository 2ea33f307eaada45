#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "table/producer.h"

namespace clothbrdf {

/// How exactly a file stores values.
struct StoredPrecision {
  double relative = 0x1p-53;  ///< largest rounding of a normal number
  double step = 0;            ///< between the smallest numbers

  bool operator==(const StoredPrecision&) const = default;
};

/// A table in memory, immutable. Values are f_r in 1/sr, without the cosine.
class Table final : public Producer {
 public:
  /// values[row][channel][column]; valid[cell] is 0 where a cell holds no measurement or lies below
  /// the horizon. Throws std::invalid_argument where the sizes do not match the spec.
  Table(TableSpec spec, std::vector<double> values, std::vector<std::uint8_t> valid,
        StoredPrecision precision = {});

  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t first_row, std::span<double> values) const override;
  /// Interpolated; for a list of pairs, the value of the pair that is asked for, 0 where it is not
  /// in the list.
  void fill_pairs(std::span<const DirectionPair> pairs, std::span<double> values) const override;

  /// f_r of each channel between the nodes of a grid: linear in each axis's own coordinate.
  /// Periodic axes wrap, the others are continued as constants beyond their first and last node.
  /// An only phi_i stands for any, with phi_o counted from it.
  /// Cells that are not valid or not finite are left out, and the weights of the others scaled up.
  /// False, and values of 0, on or below the horizon and where all cells around are left out.
  bool interpolate(const Directions& directions, std::span<double> values) const;

  double value(std::size_t cell, std::size_t channel) const;
  bool valid(std::size_t cell) const { return valid_[cell] != 0; }
  /// Whether all its channels are finite numbers.
  bool finite(std::size_t cell) const;
  std::span<const double> values() const { return values_; }
  StoredPrecision precision() const { return precision_; }

 private:
  TableSpec spec_;
  std::vector<double> values_;
  std::vector<std::uint8_t> valid_;
  StoredPrecision precision_;
};

/// Which cells of a table made from a material hold a value: those above the horizon (all, for a
/// list of pairs).
std::vector<std::uint8_t> cells_above_horizon(const TableSpec& spec);

/// A negative value in any channel is the mark of a cell that was not measured, as in MERL's files;
/// written as this.
inline constexpr double kNotMeasured = -1;

/// Takes the cells with that mark from the valid ones; values[row][channel][column].
void mask_not_measured(const TableSpec& spec, std::span<const double> values,
                       std::span<std::uint8_t> valid);

/// The channels of whole f_r, without its components.
Table without_components(const Table& table);

/// All of a producer's table in memory, by stream_rows.
Table collect(const Producer& producer, Workers workers);

}  // namespace clothbrdf
