#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/direction_rule.h"

namespace clothbrdf {

// Internal to formats/.

/// The square [0, 1]^2 as the hemisphere above the horizon: Shirley and Chiu's map of concentric
/// squares to circles of the unit disk (1997), raised to unit vectors. Equal areas of the square
/// are equal projected solid angles; (0.5, 0.5) is the normal, the first coordinate grows with x.
using SquarePoint = std::array<double, 2>;

/// Of a unit vector on or above the horizon, or of the x and y of any.
SquarePoint to_square(double x, double y);
Vector3<double> from_square(const SquarePoint& point);

/// One of 2^depth x 2^depth cells of the square, depth at least 1.
struct SquareCell {
  int depth;
  std::uint32_t x;
  std::uint32_t y;

  /// Means over the cell, each direction weighted with its projected solid angle: `nodes` along
  /// either axis, twice as many in cells on the diagonals, where the map has a kink.
  DirectionRule rule(std::size_t nodes) const;
  std::array<SquareCell, 4> quarters() const;  ///< x fastest
  double measure() const;                      ///< area in the square
};

}  // namespace clothbrdf
