#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "table/table_spec.h"

namespace clothbrdf {

// Internal to formats/.

/// How the rows of an ALTA file hold a table of ours.
class AltaLayout {
 public:
  /// The spec has a grid or pairs, and is kept by reference.
  explicit AltaLayout(const TableSpec& spec);

  std::string_view parametrisation() const { return parametrisation_; }  ///< #PARAM_IN
  std::string_view output() const;                                       ///< #PARAM_OUT
  std::size_t dimension() const { return dimension_; }

  /// Whether a file has a row for a cell that was measured.
  bool holds(std::size_t cell) const;

  /// The first dimension() numbers of a cell's row, radians; 0 beyond.
  std::array<double, 4> coordinates(std::size_t cell) const;

  /// The inverse, for grids; none where the coordinates are not those of a node.
  std::optional<std::size_t> cell_at(std::span<const double> coordinates) const;

 private:
  double coordinate(std::size_t axis, int k) const;

  const TableSpec& spec_;
  std::string_view parametrisation_;
  std::size_t dimension_;
};

/// A grid of fewer cells with a value than one in so many is not written: a reader could not tell
/// such a file from one that claims a grid to exhaust its memory.
inline constexpr std::size_t kMostCellsPerRow = 100;

}  // namespace clothbrdf
