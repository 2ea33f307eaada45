#pragma once

#include <string>
#include <vector>

#include "fit/misfit.h"
#include "fit/parameter_set.h"

namespace clothbrdf {

/// Where a solve ended.
struct Solution {
  Material material;
  Material start;   ///< that led there
  double cost = 0;  ///< sum of squares, without Rows::constant
  bool converged = false;
  std::string termination;  ///< Ceres' name of it
  std::string message;      ///< and its words
  int iterations = 0;
  std::vector<std::size_t> at_bound;  ///< parameters that are held by a bound
};

struct SolveLimits {
  int iterations = 200;
  double function_tolerance = 1e-15;
  double parameter_tolerance = 1e-12;
  int rounds = 3;  ///< of fixing what bounds hold
};

/// Levenberg-Marquardt (Ceres) from `start`; parameters that are not free, layer counts and
/// conventions are those of `start`. Parameters that a bound holds are fixed there and the others
/// fitted again.
Solution solve(const Misfit& misfit, const ParameterSet& set, const Material& start,
               const SolveLimits& limits, Workers workers);

/// Free parameters that lie on a bound which keeps the cost from falling.
std::vector<std::size_t> held_by_bounds(const Misfit& misfit, const ParameterSet& set,
                                        const Material& material);

/// k_s, k_i and k_d (those that are free) that fit best, all else given: the model is linear in
/// them. None is negative.
Material with_best_weights(const Misfit& misfit, const ParameterSet& set, const Material& start);

}  // namespace clothbrdf
