#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "table/grid.h"
#include "table/reach.h"

namespace clothbrdf {

// Internal to ReachedCells.

/// Cells of an axis from `begin` to before `end`.
struct AxisBlock {
  int begin;
  int end;
};

/// 1 or 0 for each [row][column] of the rows that share a cell of a grid's first axis.
using CellMarks = std::vector<std::uint8_t>;

/// Marks the cells of a grid that hold, or lie beside, a pair of a reach.
class ReachMarker {
 public:
  virtual ~ReachMarker() = default;

  /// Blocks of the first axis whose cells are marked alike.
  virtual const std::vector<AxisBlock>& blocks() const = 0;

  /// Adds the marks of a block to others, as many as its rows have cells.
  virtual void mark(std::size_t block, CellMarks& marks) const = 0;
};

std::unique_ptr<const ReachMarker> make_reach_marker(const Grid& grid, const Reach& reach);

}  // namespace clothbrdf
