#pragma once

#include <vector>

#include "fit/report.h"
#include "support/image.h"

namespace clothbrdf {

/// How many layers can be told, as a map: a column for each noise and a row for each absorption,
/// growing to the right and upward at equal steps (which is logarithmic where the values are), the
/// darker the more layers, with the number in each cell that has room for it. Pairs that are not
/// among the cells stay grey. Cells are layer_map_cell(columns, rows) pixels large, and the picture
/// larger by margins that do not depend on them (but never narrower than its title).
Image layer_map(const std::vector<SweepCell>& cells);

struct LayerMapCell {
  int width;
  int height;
};
/// The edges of a cell where so many have to fit, pixels.
LayerMapCell layer_map_cell(std::size_t columns, std::size_t rows);

/// Where the top left cell starts, pixels.
inline constexpr int kLayerMapLeft = 96;
inline constexpr int kLayerMapTop = 70;

}  // namespace clothbrdf
