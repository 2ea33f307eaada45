#include "tabulate/cell_integral.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace clothbrdf {
namespace {

constexpr int kMostHalvings = 24;

// Where directions of |cos phi_d| = u sink below the horizon: tan(theta_h) tan(theta_d) u = 1.
double horizon(double u, double tan_other) { return std::atan2(1.0, u * tan_other); }

double tangent(double theta) { return theta >= kRightAngle ? 1e300 : std::tan(theta); }

}  // namespace

CellIntegrator::CellIntegrator(const std::vector<double>& phi_d_edges, std::size_t channels,
                               double tolerance, Workers workers)
    : channels_(channels),
      tolerance_(tolerance),
      workers_(workers),
      rules_(rules_for(tolerance)),
      column_(channels * kPolynomialNodes),
      value_(channels) {
  for (const double edge : phi_d_edges) {
    edges_.emplace_back(kRightAngle - edge);
    edge_cosines_.push_back(std::max(0.0, std::cos(edge)));
  }
}

void CellIntegrator::add(const BoxFunctions& functions, std::span<CellSums> sums) {
  const ThetaBox& box = functions.box;
  // Cells that the horizon does not touch share the nodes of one rule; the others have limits of
  // their own.
  const double reach = tangent(box.h_high) * tangent(box.d_high);
  std::size_t first = 0;
  while (first < sums.size() && edge_cosines_[first] * reach >= 1) ++first;
  const std::size_t uncut = sums.size() - first;
  std::vector<CellSums> weak(uncut, empty());
  std::vector<CellSums> strong(uncut, empty());
  if (uncut > 0) {
    add_rule(rules_.weak, functions, box, first, weak);
    add_rule(rules_.strong, functions, box, first, strong);
  }
  for (std::size_t cell = 0; cell < sums.size(); ++cell) {
    if (cell >= first && agrees(weak[cell - first], strong[cell - first], strong[cell - first])) {
      sums[cell].measure += strong[cell - first].measure;
      for (std::size_t c = 0; c < channels_; ++c)
        sums[cell].channels[c] += strong[cell - first].channels[c];
    } else {
      add_adaptively(functions, box, cell, sums[cell], nullptr, 0);
    }
  }
}

bool CellIntegrator::agrees(const CellSums& weak, const CellSums& strong,
                            const CellSums& whole) const {
  // A part of a cell may err by a small share of the whole cell. Two rules can agree by chance
  // where the shadow's edge bends the integrand: they must agree ten times better than asked.
  constexpr double kShare = 1.0 / 256;
  constexpr double kSafety = 0.1;
  const auto close = [&](double a, double b, double all) {
    return std::abs(a - b) <= kSafety * tolerance_ * std::max(std::abs(b), kShare * std::abs(all));
  };
  for (std::size_t c = 0; c < channels_; ++c) {
    if (!close(weak.channels[c], strong.channels[c], whole.channels[c])) return false;
  }
  return close(weak.measure, strong.measure, whole.measure);
}

void CellIntegrator::add_adaptively(const BoxFunctions& functions, ThetaBox box, std::size_t cell,
                                    CellSums& sum, const CellSums* whole, int depth) {
  const double nearest = edge_cosines_[cell + 1];
  box.h_high = std::min(box.h_high, horizon(nearest, tangent(box.d_low)));
  box.d_high = std::min(box.d_high, horizon(nearest, tangent(box.h_low)));
  if (!(box.h_high > box.h_low) || !(box.d_high > box.d_low)) return;
  CellSums weak = empty();
  CellSums strong = empty();
  add_rule(rules_.weak, functions, box, cell, std::span(&weak, 1));
  add_rule(rules_.strong, functions, box, cell, std::span(&strong, 1));
  if (whole == nullptr) whole = &strong;
  if (depth < kMostHalvings && !agrees(weak, strong, *whole)) {
    const double h = (box.h_low + box.h_high) / 2;
    const double d = (box.d_low + box.d_high) / 2;
    for (const ThetaBox& part :
         {ThetaBox{box.h_low, h, box.d_low, d}, ThetaBox{box.h_low, h, d, box.d_high},
          ThetaBox{h, box.h_high, box.d_low, d}, ThetaBox{h, box.h_high, d, box.d_high}}) {
      add_adaptively(functions, part, cell, sum, whole, depth + 1);
    }
    return;
  }
  sum.measure += strong.measure;
  for (std::size_t c = 0; c < channels_; ++c) sum.channels[c] += strong.channels[c];
}

void CellIntegrator::add_rule(const std::vector<QuadraturePoint>& rule,
                              const BoxFunctions& functions, const ThetaBox& box, std::size_t first,
                              std::span<CellSums> sums) {
  workers_.check();
  const double farthest = edge_cosines_[first];
  const double nearest = edge_cosines_[first + sums.size()];
  std::vector<double> breaks = {box.h_low,
                                std::min(box.h_high, horizon(nearest, tangent(box.d_low)))};
  if (!(breaks[1] > breaks[0])) return;
  for (const double at :
       {horizon(farthest, tangent(box.d_low)), horizon(nearest, tangent(box.d_high)),
        horizon(farthest, tangent(box.d_high))}) {
    if (at > breaks[0] && at < breaks[1]) breaks.push_back(at);
  }
  std::sort(breaks.begin(), breaks.end());
  const ThetaBox& all = functions.box;
  for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
    const double h_width = breaks[piece + 1] - breaks[piece];
    for (const QuadraturePoint& h : rule) {
      const double theta_h = breaks[piece] + h.at * h_width;
      const PolynomialWeights at_h =
          polynomial_weights((theta_h - all.h_low) / (all.h_high - all.h_low));
      for (std::size_t i = 0; i < column_.size(); ++i) {
        column_[i] = 0;
        for (std::size_t n = 0; n < kPolynomialNodes; ++n) {
          column_[i] += at_h[n] * functions.values[i * kPolynomialNodes + n];
        }
      }
      const double end = std::min(box.d_high, horizon(nearest, tangent(theta_h)));
      const double bend =
          std::clamp(horizon(farthest, tangent(theta_h)), box.d_low, std::max(box.d_low, end));
      for (const auto& [low, high] : {std::pair{box.d_low, bend}, std::pair{bend, end}}) {
        if (!(high > low)) continue;
        for (const QuadraturePoint& d : rule) {
          const double weight = h.weight * h_width * d.weight * (high - low);
          add_point(functions, theta_h, low + d.at * (high - low), weight, first, sums);
        }
      }
    }
  }
}

void CellIntegrator::add_point(const BoxFunctions& functions, double theta_h, double theta_d,
                               double weight, std::size_t first, std::span<CellSums> sums) {
  const ThetaBox& all = functions.box;
  const PolynomialWeights at_d =
      polynomial_weights((theta_d - all.d_low) / (all.d_high - all.d_low));
  for (std::size_t c = 0; c < channels_; ++c) {
    value_[c] = 0;
    for (std::size_t n = 0; n < kPolynomialNodes; ++n)
      value_[c] += at_d[n] * column_[c * kPolynomialNodes + n];
  }
  const SinCos<double> h{std::sin(theta_h), std::cos(theta_h)};
  const SinCos<double> d{std::sin(theta_d), std::cos(theta_d)};
  weight *= h.sin * d.sin * d.cos;
  const FactorArc arc(h, d);
  FactorArc::Integral before = arc.from_right_angle(edges_[first]);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const FactorArc::Integral after = arc.from_right_angle(edges_[first + k + 1]);
    sums[k].measure += weight * (before.length - after.length);
    const double factor = weight * (before.factor - after.factor);
    for (std::size_t c = 0; c < channels_; ++c) sums[k].channels[c] += factor * value_[c];
    before = after;
  }
}

}  // namespace clothbrdf
