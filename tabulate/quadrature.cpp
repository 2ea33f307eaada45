#include "tabulate/quadrature.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace clothbrdf {

namespace {

template <unsigned kPoints>
std::vector<QuadraturePoint> gauss_legendre() {
  using Rule = boost::math::quadrature::gauss<double, kPoints>;  // on [-1, 1], one half of it
  std::vector<QuadraturePoint> points;
  for (std::size_t k = 0; k < Rule::abscissa().size(); ++k) {
    const double x = Rule::abscissa()[k];
    const double w = Rule::weights()[k];
    points.push_back({(1 + x) / 2, w / 2});
    if (x != 0) points.push_back({(1 - x) / 2, w / 2});
  }
  return points;
}

}  // namespace

const RulePair& rules_for(double tolerance) {
  static const RulePair kQuick = {gauss_legendre<2>(), gauss_legendre<3>()};
  static const RulePair kExact = {gauss_legendre<4>(), gauss_legendre<7>()};
  constexpr double kQuickIsEnough = 1e-4;
  return tolerance >= kQuickIsEnough ? kQuick : kExact;
}

const PolynomialWeights& polynomial_nodes() {
  static const PolynomialWeights kNodes = [] {
    PolynomialWeights nodes{};
    for (std::size_t k = 0; k < kPolynomialNodes; ++k) {
      nodes[k] = 0.5 - 0.5 * std::cos((static_cast<double>(k) + 0.5) * std::numbers::pi /
                                      kPolynomialNodes);
    }
    return nodes;
  }();
  return kNodes;
}

PolynomialWeights polynomial_weights(double at) {
  static const PolynomialWeights kScale = [] {
    PolynomialWeights scale{};
    for (std::size_t k = 0; k < kPolynomialNodes; ++k) {
      scale[k] = 1;
      for (std::size_t l = 0; l < kPolynomialNodes; ++l) {
        if (l != k) scale[k] /= polynomial_nodes()[k] - polynomial_nodes()[l];
      }
    }
    return scale;
  }();
  PolynomialWeights weights = kScale;
  for (std::size_t k = 0; k < kPolynomialNodes; ++k) {
    for (std::size_t l = 0; l < kPolynomialNodes; ++l) {
      if (l != k) weights[k] *= at - polynomial_nodes()[l];
    }
  }
  return weights;
}

}  // namespace clothbrdf
