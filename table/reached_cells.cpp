#include "table/reached_cells.h"

#include <algorithm>
#include <cstring>

#include "table/reach_marker.h"

namespace clothbrdf {

ReachedCells::ReachedCells(const Grid& grid, const Reach& reach)
    : row_cells_(grid.column_count()), columns_{row_cells_, 0} {
  const std::unique_ptr<const ReachMarker> marker = make_reach_marker(grid, reach);
  const std::size_t rows = grid.row_count() / static_cast<std::size_t>(grid.axes.front().size);
  first_range_.reserve(grid.row_count() + 1);
  CellMarks marks(rows * row_cells_);
  for (std::size_t b = 0; b < marker->blocks().size(); ++b) {
    std::fill(marks.begin(), marks.end(), std::uint8_t{0});
    marker->mark(b, marks);
    const AxisBlock& block = marker->blocks()[b];
    for (int cell = block.begin; cell < block.end; ++cell) {
      for (std::size_t row = 0; row < rows; ++row) {
        add_row(std::span(marks).subspan(row * row_cells_, row_cells_));
      }
    }
  }
  if (count_ == 0) columns_ = {0, 0};
}

void ReachedCells::add_row(std::span<const std::uint8_t> marks) {
  const auto next = [&](std::size_t from, int wanted) {
    const void* const found = std::memchr(marks.data() + from, wanted, marks.size() - from);
    return found == nullptr
               ? marks.size()
               : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - marks.data());
  };
  for (std::size_t begin = next(0, 1); begin < marks.size();) {
    const std::size_t end = next(begin, 0);
    ranges_.push_back({begin, end});
    columns_ = {std::min(columns_.begin, begin), std::max(columns_.end, end)};
    count_ += end - begin;
    begin = next(end, 1);
  }
  first_range_.push_back(ranges_.size());
}

void ReachedCells::restrict(std::span<std::uint8_t> cells) const {
  for (std::size_t at = 0; at + 1 < first_range_.size(); ++at) {
    std::uint8_t* const of_row = cells.data() + at * row_cells_;
    std::size_t from = 0;
    for (const ColumnRange& range : row(at)) {
      std::fill(of_row + from, of_row + range.begin, std::uint8_t{0});
      from = range.end;
    }
    std::fill(of_row + from, of_row + row_cells_, std::uint8_t{0});
  }
}

}  // namespace clothbrdf
