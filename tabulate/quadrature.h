#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace clothbrdf {

/// A node of a rule on [0, 1].
struct QuadraturePoint {
  double at;
  double weight;
};

/// A Gauss-Legendre rule, and a weaker one that tells its error.
struct RulePair {
  std::vector<QuadraturePoint> weak;
  std::vector<QuadraturePoint> strong;
};

/// The pair that reaches a relative tolerance with the fewest nodes in practice: 2 and 3 points, or
/// 4 and 7.
const RulePair& rules_for(double tolerance);

/// Interpolation of smooth functions on [0, 1] from their values at Chebyshev points.
inline constexpr std::size_t kPolynomialNodes = 6;
using PolynomialWeights = std::array<double, kPolynomialNodes>;

/// Where the values are needed, ascending.
const PolynomialWeights& polynomial_nodes();

/// The interpolated value at `at` is the sum of these weights times the node values.
PolynomialWeights polynomial_weights(double at);

}  // namespace clothbrdf
