#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "table/grid.h"
#include "table/reach.h"

namespace clothbrdf {

/// Columns of a grid's row from `begin` to before `end`.
struct ColumnRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The cells of a grid in which a scene can produce a pair of directions, and a margin: the next
/// cell to both sides on each axis, so that readers may interpolate. All of these are found, and
/// some more, since bounds of angles over small blocks of cells decide: of half/difference grids
/// some 3 degrees of theta_h and theta_d by 6 of phi_d. Part of a cell may lie below the horizon.
class ReachedCells {
 public:
  /// Ranges of the reach as DirectionRange allows them.
  ReachedCells(const Grid& grid, const Reach& reach);

  /// Ascending, apart from each other; none where the row is not reached.
  std::span<const ColumnRange> row(std::size_t row) const {
    return {ranges_.data() + first_range_[row], first_range_[row + 1] - first_range_[row]};
  }

  /// Columns of all rows lie between these; both 0 where no cell is reached.
  ColumnRange columns() const { return columns_; }

  std::size_t count() const { return count_; }

  /// Takes all other cells from those that are marked by 1.
  void restrict(std::span<std::uint8_t> cells) const;

 private:
  void add_row(std::span<const std::uint8_t> marks);

  std::size_t row_cells_;
  std::vector<std::size_t> first_range_ = {0};  // [row], and one past the last
  std::vector<ColumnRange> ranges_;
  ColumnRange columns_;
  std::size_t count_ = 0;
};

}  // namespace clothbrdf
