#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "table/producer.h"

namespace clothbrdf {

/// How exactly a file stores values.
struct StoredPrecision {
  double relative = 0x1p-53;  ///< largest rounding of a normal number
  double step = 0;            ///< between the smallest numbers
  double largest = std::numeric_limits<double>::max();
  int bytes = 8;  ///< of a value, where all values take the same

  bool operator==(const StoredPrecision&) const = default;
};

/// How f_r is found between the samples of a table: a rule of its format, as its readers follow it.
/// May be called from several threads at once.
class Interpolant {
 public:
  virtual ~Interpolant() = default;

  /// f_r of each channel at a pair of unit vectors above the horizon. False, and values of 0, where
  /// the table says nothing.
  virtual bool interpolate(const Directions& directions, std::span<double> values) const = 0;

  /// Whether it answers all pairs above the horizon.
  virtual bool complete() const { return true; }

  /// For people: "linear between nodes".
  virtual std::string rule() const = 0;
};

/// A table in memory, immutable. Values are f_r in 1/sr, without the cosine.
class Table final : public Producer {
 public:
  /// values[row][channel][column]; valid[cell] is 0 where a cell holds no measurement or lies below
  /// the horizon. Grids need no interpolant of their own; of pairs without one the nearest sample
  /// counts (NearestSample). Throws std::invalid_argument where the sizes do not match the spec.
  Table(TableSpec spec, std::vector<double> values, std::vector<std::uint8_t> valid,
        StoredPrecision precision = {}, std::shared_ptr<const Interpolant> interpolant = {});

  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t first_row, std::span<double> values) const override;
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override;

  /// How interpolate() works, for people.
  std::string interpolation() const;
  /// Whether it answers all pairs above the horizon, but for cells that are not valid.
  bool complete() const { return !interpolant_ || interpolant_->complete(); }

  /// f_r of each channel between the samples, by the table's interpolant. Without one, between the
  /// nodes of a grid: linear in each axis's own coordinate.
  /// Periodic axes wrap, the others are continued as constants beyond their first and last node.
  /// An only phi_i stands for any, with phi_o counted from it.
  /// Cells that are not valid or not finite are left out, and the weights of the others scaled up.
  /// False, and values of 0, on or below the horizon and where all cells around are left out.
  bool interpolate(const Directions& directions, std::span<double> values) const;
  std::shared_ptr<const Interpolant> interpolant() const { return interpolant_; }

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
  std::shared_ptr<const Interpolant> interpolant_;
};

/// Which cells of a table made from a material hold a value, 1 or 0 each: those above the horizon
/// that its reach holds (all, for a list of pairs).
std::vector<std::uint8_t> cells_with_values(const TableSpec& spec);

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
