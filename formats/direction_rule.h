#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "table/grid.h"

namespace clothbrdf {

// Internal to formats/.

/// A quadrature over a set of directions: a mean is the sum of weight times value.
struct DirectionRule {
  std::vector<Vector3<double>> directions;  ///< unit vectors above the horizon
  std::vector<double> weights;              ///< add up to 1

  void add(const Vector3<double>& direction, double weight) {
    directions.push_back(direction);
    weights.push_back(weight);
  }
  /// Makes the weights add up to 1.
  void normalise();
};

/// Nodes in (0, 1) and weights that add up to 1.
struct GaussLegendre {
  std::span<const double> nodes;
  std::span<const double> weights;
};

/// Of 2, 3 or 4 nodes: exact for polynomials up to degree 2 count - 1. Throws std::invalid_argument
/// for others.
GaussLegendre gauss_legendre(std::size_t count);

}  // namespace clothbrdf
