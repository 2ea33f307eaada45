#pragma once

#include <span>
#include <vector>

#include "support/progress.h"
#include "tabulate/factor_arc.h"
#include "tabulate/quadrature.h"

namespace clothbrdf {

/// A box of theta_h and theta_d, radians.
struct ThetaBox {
  double h_low;
  double h_high;
  double d_low;
  double d_high;
};

/// Smooth functions over a box, one a channel, by their values at polynomial nodes:
/// values[channel][node of theta_d][node of theta_h].
struct BoxFunctions {
  ThetaBox box;
  std::span<const double> values;
};

/// Measure of the part of a cell above the horizon and, for each channel, the integral over it of
/// the directional factor times the channel's function.
struct CellSums {
  double measure = 0;
  std::vector<double> channels;
};

/// Integrals over boxes of theta_h and theta_d times cells of phi_d, by the measure cos theta_d dwh
/// dwd. phi_d and the horizon in phi_d are closed (FactorArc); in theta_h and theta_d the limits
/// follow the horizon, so that a cell of which only a sliver is visible is done as well as any
/// other.
class CellIntegrator {
 public:
  /// phi_d_edges: ascending, radians, from 0 to at most one beyond pi/2 (the rest of the circle is
  /// its mirror image). add() throws Cancelled where the workers are.
  CellIntegrator(const std::vector<double>& phi_d_edges, std::size_t channels, double tolerance,
                 Workers workers);

  /// Adds the integrals over the box to sums[cell of phi_d].
  void add(const BoxFunctions& functions, std::span<CellSums> sums);

 private:
  void add_rule(const std::vector<QuadraturePoint>& rule, const BoxFunctions& functions,
                const ThetaBox& box, std::size_t first, std::span<CellSums> sums);
  void add_point(const BoxFunctions& functions, double theta_h, double theta_d, double weight,
                 std::size_t first, std::span<CellSums> sums);
  void add_adaptively(const BoxFunctions& functions, ThetaBox box, std::size_t cell, CellSums& sum,
                      const CellSums* whole, int depth);
  bool agrees(const CellSums& weak, const CellSums& strong, const CellSums& whole) const;
  CellSums empty() const { return {0, std::vector<double>(channels_, 0.0)}; }

  std::vector<FactorArc::Edge> edges_;
  std::vector<double> edge_cosines_;  // |cos|, descending to 0 at the right angle
  std::size_t channels_;
  double tolerance_;
  Workers workers_;
  const RulePair& rules_;
  std::vector<double> column_;  // functions at the current theta_h: [channel][node of theta_d]
  std::vector<double> value_;   // functions at the current point
};

}  // namespace clothbrdf
