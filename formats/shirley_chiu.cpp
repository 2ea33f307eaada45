#include "formats/shirley_chiu.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clothbrdf {
namespace {

constexpr double kEighthTurn = std::numbers::pi / 4;

// From centred coordinates in [-1, 1].
Vector3<double> raised(double a, double b) {
  const bool along_a = std::abs(a) >= std::abs(b);
  const double r = along_a ? std::abs(a) : std::abs(b);
  const double phi = r > 0 ? kEighthTurn * std::min(std::abs(a), std::abs(b)) / r : 0;
  const double longer = r * std::cos(phi);
  const double shorter = r * std::sin(phi);
  return {std::copysign(along_a ? longer : shorter, a),
          std::copysign(along_a ? shorter : longer, b),
          std::sqrt(std::max(0.0, (1 - r) * (1 + r)))};
}

// A node of the coordinate that is the radius.
struct RadialNode {
  double at;
  double weight;
};

// Towards the horizon f_r is smooth in the cosine, sqrt(1 - r^2), not in r: there the node is taken
// in the root of 1 - r.
RadialNode radial_node(double low, double width, bool at_horizon, double node, double weight) {
  if (!at_horizon) return {low + width * node, weight};
  const double root = 1 - node;
  return {1 - width * root * root, weight * 2 * root};
}

}  // namespace

SquarePoint to_square(double x, double y) {
  const double r = std::min(1.0, std::hypot(x, y));
  const double longer = std::max(std::abs(x), std::abs(y));
  const double shorter = std::min(std::abs(x), std::abs(y));
  const double other = r * std::atan2(shorter, longer) / kEighthTurn;
  const bool along_a = std::abs(x) >= std::abs(y);
  return {0.5 + std::copysign(along_a ? r : other, x) / 2,
          0.5 + std::copysign(along_a ? other : r, y) / 2};
}

Vector3<double> from_square(const SquarePoint& point) {
  return raised(2 * point[0] - 1, 2 * point[1] - 1);
}

DirectionRule SquareCell::rule(std::size_t nodes) const {
  const std::uint32_t half = 1U << (depth - 1);
  // Counted from the centre, towards either side.
  const std::uint32_t column = x >= half ? x - half : half - 1 - x;
  const std::uint32_t line = y >= half ? y - half : half - 1 - y;
  const double sign_a = x >= half ? 1 : -1;
  const double sign_b = y >= half ? 1 : -1;
  const double width = 1.0 / half;
  const bool at_horizon = std::max(column, line) == half - 1;
  const double low = width * std::max(column, line);  // of the radius
  const double other_low = width * std::min(column, line);
  const GaussLegendre gauss = gauss_legendre(nodes);
  DirectionRule rule;
  const auto add = [&](bool along_a, double r, double other, double weight) {
    rule.add(raised(sign_a * (along_a ? r : other), sign_b * (along_a ? other : r)), weight);
  };
  for (std::size_t k = 0; k < nodes; ++k) {
    const RadialNode r = radial_node(low, width, at_horizon, gauss.nodes[k], gauss.weights[k]);
    for (std::size_t j = 0; j < nodes; ++j) {
      if (column != line) {
        add(column > line, r.at, other_low + width * gauss.nodes[j], r.weight * gauss.weights[j]);
        continue;
      }
      // Two triangles, which meet at the diagonal.
      const double other = low + (r.at - low) * gauss.nodes[j];
      const double weight = r.weight * (r.at - low) * gauss.weights[j];
      add(true, r.at, other, weight);
      add(false, r.at, other, weight);
    }
  }
  rule.normalise();
  return rule;
}

std::array<SquareCell, 4> SquareCell::quarters() const {
  return {{{depth + 1, 2 * x, 2 * y},
           {depth + 1, 2 * x + 1, 2 * y},
           {depth + 1, 2 * x, 2 * y + 1},
           {depth + 1, 2 * x + 1, 2 * y + 1}}};
}

double SquareCell::measure() const { return std::ldexp(1.0, -2 * depth); }

}  // namespace clothbrdf
