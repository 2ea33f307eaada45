#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "table/grid.h"

namespace clothbrdf {

/// The cells of a grid that a reader takes a value from, and their weights.
struct Stencil {
  std::array<std::size_t, 16> cells;
  std::array<double, 16> weights;  ///< none is 0; they add up to 1
  std::size_t count = 0;
};

/// The 2^axes cells around a pair of unit vectors, linear in each axis's own coordinate. Periodic
/// and mirrored axes go on beyond their ends, the others are continued as constants beyond their
/// first and last node. An only phi_i stands for any, with phi_o counted from it.
Stencil linear_stencil(const Grid& grid, const Directions& directions);

}  // namespace clothbrdf
