#pragma once

#include <optional>

#include "fit/search.h"
#include "fit/solve.h"

namespace clothbrdf {

/// Of the noise: no weights, no values and no sums are exact to more.
inline constexpr double kLeastNoise = 1e-13;

/// A fit to all rows, with weights from itself.
struct SettledFit {
  Solution solution;
  Rows rows;
  double chi2 = 0;  ///< of all values, not over the noise
  bool settled = false;
};

/// What is fitted: the table's values, how they are weighted and which parameters are free. Holds
/// references.
struct FitProblem {
  const Observations& observations;
  const ValueSource& source;
  const ParameterSet& set;
  Weighting weighting = Weighting::kRelative;
  Loss loss = Loss::kSquared;
  std::optional<double> noise;    ///< where it is known
  double rounding = kLeastNoise;  ///< of the values as stored, in units of the weighting

  double degrees_of_freedom(const Rows& rows) const;
  /// The noise, as given or as the residual says. What the model cannot follow is alike within a
  /// group of cells and counts once for it, not once for each of its samples.
  double noise_of(const SettledFit& fit) const;
  /// Whether the fit is left with much more than the noise that is given, or its rows with much
  /// more than the scatter of the samples within their groups.
  bool misses_data(const SettledFit& fit) const;
  /// Rows with weights from a material; `scale` is the noise where none is given.
  Rows rows(const Material& material, double scale, Workers workers) const;
};

/// Fits `fit.rows`, then rows with weights from that fit, until a further round would move the
/// table by less than a thousandth of the noise.
void settle(const FitProblem& problem, SettledFit& fit, Workers workers);

/// Every pair of layer counts on all rows of a settled fit, each from where the table has it: all
/// roughly, to the end what comes near the best. The settled fit's own place is kept.
void compare_layers(const FitProblem& problem, const SettledFit& fit, LayerTable& table,
                    Workers workers);

/// Until a step changes chi2 by next to nothing.
SolveLimits to_the_end(const Rows& rows, double noise);

}  // namespace clothbrdf
