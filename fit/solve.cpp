#include "fit/solve.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace clothbrdf {
namespace {

// All rows as one small block with the same sum of squares, the same gradient and the same
// Gauss-Newton matrix: with the products J'J = V L V' and J'r, the Jacobian is sqrt(L) V' and the
// residual 1/sqrt(L) V' J'r, and below it what is left of |r|^2. That is all that the solver sees
// of residuals, and memory does not grow with their number.
class ReducedMisfit final : public ceres::CostFunction {
 public:
  ReducedMisfit(const Misfit& misfit, const ParameterSet& set, const Material& base,
                Workers workers)
      : misfit_(misfit), set_(set), base_(base), workers_(workers) {
    const auto count = static_cast<int>(set.free().size());
    mutable_parameter_block_sizes()->push_back(count);
    set_num_residuals(count + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    workers_.check();
    const auto count = static_cast<Eigen::Index>(set_.free().size());
    const Material material =
        set_.material({parameters[0], static_cast<std::size_t>(count)}, base_);
    std::fill(residuals, residuals + count + 1, 0.0);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      residuals[count] = std::sqrt(misfit_.cost(material));
      return std::isfinite(residuals[count]);
    }
    const Eigen::MatrixXd products = misfit_.products(material, set_);
    if (!products.allFinite()) return false;
    // Columns of length 1, so that rounding is relative to each.
    Eigen::VectorXd scale = products.diagonal().head(count).cwiseSqrt();
    scale = (scale.array() > 0).select(scale, 1.0);
    const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() *
                                   products.topLeftCorner(count, count) *
                                   scale.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    const Eigen::VectorXd gradient =
        eigen.eigenvectors().transpose() * products.col(count).head(count).cwiseQuotient(scale);
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        jacobians[0], count + 1, count);
    jacobian.setZero();
    double left = products(count, count);
    constexpr double kRounding = 1e-15;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double value = eigen.eigenvalues()[k];
      if (!(value > kRounding * eigen.eigenvalues()[count - 1])) continue;
      const double root = std::sqrt(value);
      jacobian.row(k) = root * eigen.eigenvectors().col(k).cwiseProduct(scale).transpose();
      residuals[k] = gradient[k] / root;
      left -= residuals[k] * residuals[k];
    }
    residuals[count] = std::sqrt(std::max(left, 0.0));
    return true;
  }

 private:
  const Misfit& misfit_;
  const ParameterSet& set_;
  const Material& base_;
  Workers workers_;
};

Solution solve_free(const Misfit& misfit, const ParameterSet& set, const Material& start,
                    const SolveLimits& limits, Workers workers) {
  Solution solution;
  solution.material = start;
  std::vector<double> coordinates = set.coordinates(start);
  if (coordinates.empty()) {
    solution.material = set.material(coordinates, start);
    solution.cost = misfit.cost(solution.material);
    solution.converged = true;
    solution.termination = "CONVERGENCE";
    solution.message = "nothing is free";
    return solution;
  }
  ceres::Problem problem;
  problem.AddParameterBlock(coordinates.data(), static_cast<int>(coordinates.size()));
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    problem.SetParameterLowerBound(coordinates.data(), static_cast<int>(k),
                                   set.lowest_coordinate(k));
    problem.SetParameterUpperBound(coordinates.data(), static_cast<int>(k),
                                   set.highest_coordinate(k));
  }
  problem.AddResidualBlock(new ReducedMisfit(misfit, set, start, workers), nullptr,
                           coordinates.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = limits.iterations;
  options.function_tolerance = limits.function_tolerance;
  options.parameter_tolerance = limits.parameter_tolerance;
  options.gradient_tolerance = 0;
  // With bounds, steps are followed by a line search: with this one it needs no derivatives.
  options.line_search_interpolation_type = ceres::BISECTION;
  options.max_num_line_search_step_size_iterations = 6;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  workers.check();
  solution.material = set.material(coordinates, start);
  solution.cost = 2 * summary.final_cost;
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.termination = ceres::TerminationTypeToString(summary.termination_type);
  solution.message = summary.message;
  solution.iterations = static_cast<int>(summary.iterations.size());
  return solution;
}

}  // namespace

std::vector<std::size_t> held_by_bounds(const Misfit& misfit, const ParameterSet& set,
                                        const Material& material) {
  std::vector<std::size_t> result;
  const std::vector<double> at = set.coordinates(material);
  std::vector<int> side(at.size(), 0);
  bool any = false;
  constexpr double kNear = 1e-9;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (at[k] <= set.lowest_coordinate(k) + kNear) side[k] = -1;
    if (at[k] >= set.highest_coordinate(k) - kNear) side[k] = 1;
    any = any || side[k] != 0;
  }
  if (!any) return result;
  const Eigen::MatrixXd products = misfit.products(material, set);
  const auto last = static_cast<Eigen::Index>(at.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double gradient = products(static_cast<Eigen::Index>(k), last);
    if (side[k] != 0 && side[k] * gradient <= 0) result.push_back(set.free()[k]);
  }
  return result;
}

Solution solve(const Misfit& misfit, const ParameterSet& set, const Material& start,
               const SolveLimits& limits, Workers workers) {
  Solution best = solve_free(misfit, set, start, limits, workers);
  // Projected steps creep along a bound: with what it holds fixed they do not.
  for (int round = 0; round < limits.rounds; ++round) {
    std::vector<std::size_t> at_bound = held_by_bounds(misfit, set, best.material);
    const bool same = at_bound == best.at_bound;
    best.at_bound = at_bound;
    if (at_bound.empty() || same) break;
    ParameterSet fewer = set;
    for (const std::size_t parameter : at_bound) {
      fewer = fewer.with_fixed(parameter);
      const FitParameter& p = set.parameters()[parameter];
      const double value = parameter_value(best.material, p);
      set_parameter(best.material, p, value - p.lowest < p.highest - value ? p.lowest : p.highest);
    }
    Solution next = solve_free(misfit, fewer, best.material, limits, workers);
    next.iterations += best.iterations;
    next.at_bound = at_bound;
    best = next;
  }
  best.start = start;
  return best;
}

Material with_best_weights(const Misfit& misfit, const ParameterSet& set, const Material& start) {
  std::vector<std::size_t> columns;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < set.free().size(); ++k) {
    const FitParameter& p = set.parameters()[set.free()[k]];
    if (p.column >= kSpecular && p.column <= kDiffuse) {
      columns.push_back(k);
      places.push_back(set.free()[k]);
    }
  }
  Material result = start;
  if (columns.empty()) return result;
  const Eigen::MatrixXd products = misfit.products(start, set);
  // Active set by trial: with three columns, drop the most negative one until none is.
  std::vector<bool> in(columns.size(), true);
  for (;;) {
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (in[k]) kept.push_back(k);
    }
    const auto count = static_cast<Eigen::Index>(kept.size());
    Eigen::MatrixXd a(count, count);
    Eigen::VectorXd b(count);
    const auto slope = [&](std::size_t k) {
      const FitParameter& p = set.parameters()[places[k]];
      return p.value_slope(parameter_value(start, p));
    };
    const auto at = [&](std::size_t k) { return static_cast<Eigen::Index>(columns[k]); };
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t ki = kept[static_cast<std::size_t>(i)];
      b[i] = -products(at(ki), products.cols() - 1) / slope(ki);
      for (Eigen::Index j = 0; j < count; ++j) {
        const std::size_t kj = kept[static_cast<std::size_t>(j)];
        a(i, j) = products(at(ki), at(kj)) / (slope(ki) * slope(kj));
      }
      // Those that were dropped go from their start to 0.
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (in[k]) continue;
        b[i] += products(at(ki), at(k)) / (slope(ki) * slope(k)) *
                parameter_value(start, set.parameters()[places[k]]);
      }
      constexpr double kRidge = 1e-12;
      a(i, i) *= 1 + kRidge;
    }
    const Eigen::VectorXd change = a.ldlt().solve(b);
    double lowest = 0;
    std::size_t worst = columns.size();
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t k = kept[static_cast<std::size_t>(i)];
      const double value = parameter_value(start, set.parameters()[places[k]]) + change[i];
      if (value < lowest) {
        lowest = value;
        worst = k;
      }
    }
    if (worst < columns.size()) {
      in[worst] = false;
      continue;
    }
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!in[k]) set_parameter(result, set.parameters()[places[k]], 0);
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t k = kept[static_cast<std::size_t>(i)];
      const FitParameter& p = set.parameters()[places[k]];
      const double value = parameter_value(start, p) + change[i];
      if (std::isfinite(value)) set_parameter(result, p, std::clamp(value, p.lowest, p.highest));
    }
    return result;
  }
}

}  // namespace clothbrdf
