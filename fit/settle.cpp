#include "fit/settle.h"

#include <algorithm>
#include <cmath>

#include "support/threads.h"

namespace clothbrdf {
namespace {

// Rounds of weights from the current fit.
constexpr int kMostRounds = 20;

// Of the noise: a change of the table that does not count.
constexpr double kSettled = 1e-3;

// How far apart two fits are: the change of the table over the noise.
double moved(const Material& a, const Material& b, const Misfit& misfit, const ParameterSet& set,
             double noise) {
  const std::vector<double> from = set.coordinates(a);
  const std::vector<double> to = set.coordinates(b);
  const Eigen::MatrixXd products = misfit.products(b, set);
  const auto count = static_cast<Eigen::Index>(from.size());
  Eigen::VectorXd step(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    step[k] = to[static_cast<std::size_t>(k)] - from[static_cast<std::size_t>(k)];
  }
  const double square = step.dot(products.topLeftCorner(count, count) * step);
  return std::sqrt(std::max(square, 0.0)) / std::max(noise, kLeastNoise);
}

}  // namespace

double FitProblem::degrees_of_freedom(const Rows& rows) const {
  return std::max(1.0, static_cast<double>(rows.values) - static_cast<double>(set.free().size()));
}

double FitProblem::noise_of(const SettledFit& fit) const {
  if (noise) return std::max(*noise, rounding);
  const double free = static_cast<double>(set.free().size());
  const double rows = std::max(1.0, static_cast<double>(fit.rows.row_count()) - free);
  const double square = std::max(fit.chi2 / degrees_of_freedom(fit.rows), fit.solution.cost / rows);
  return std::max(std::sqrt(square), rounding);
}

bool FitProblem::misses_data(const SettledFit& fit) const {
  const auto rows = static_cast<double>(fit.rows.row_count());
  const double within = static_cast<double>(fit.rows.values) - rows;
  constexpr double kEnough = 100;
  constexpr double kMuch = 4;
  if (noise) {
    const double expected = std::max(*noise, rounding) * std::max(*noise, rounding);
    return fit.solution.cost > kMuch * expected * (rows + kEnough);
  }
  if (within < kEnough) return false;
  // A row stands for many values, whose rounding may be alike.
  const double alike = rounding * rounding * static_cast<double>(fit.rows.values) / rows;
  const double scatter = std::max(fit.rows.constant / within, alike);
  return fit.solution.cost / rows > kMuch * scatter;
}

Rows FitProblem::rows(const Material& material, double scale, Workers workers) const {
  const ModelValues values = model_values(observations, material, kExact, workers);
  return make_rows(observations, source, {weighting, loss, noise.value_or(scale)}, &values, true,
                   workers);
}

SolveLimits to_the_end(const Rows& rows, double noise) {
  // Without an estimate of the noise, the weights are about to change anyway.
  if (!(noise > 0)) return {.function_tolerance = 1e-6, .rounds = 1};
  return {.function_tolerance = kSettled * kSettled / static_cast<double>(rows.row_count())};
}

void settle(const FitProblem& problem, SettledFit& fit, Workers workers) {
  double noise = 0;
  fit.settled = false;
  for (int round = 0; round < kMostRounds; ++round) {
    const Solution before = fit.solution;
    if (round > 0) fit.rows = problem.rows(before.material, noise, workers);
    const Misfit misfit(problem.observations, fit.rows, kExact, workers);
    fit.solution =
        solve(misfit, problem.set, before.material, to_the_end(fit.rows, noise), workers);
    fit.solution.start = before.start;
    if (round > 0) fit.solution.iterations += before.iterations;
    fit.chi2 = fit.rows.constant + fit.solution.cost;
    if (!std::isfinite(fit.chi2)) return;
    noise = std::sqrt(fit.chi2 / problem.degrees_of_freedom(fit.rows));
    if (round > 0 &&
        moved(before.material, fit.solution.material, misfit, problem.set, noise) < kSettled) {
      fit.settled = true;
      break;
    }
  }
}

void compare_layers(const FitProblem& problem, const SettledFit& fit, LayerTable& table,
                    Workers workers) {
  const Workers single(1, workers.progress);
  const Misfit rough(problem.observations, fit.rows, kSearching, single);
  const Misfit exact(problem.observations, fit.rows, kExact, single);
  const double unit = problem.noise_of(fit) * problem.noise_of(fit);
  const double rows_cost = static_cast<double>(fit.rows.row_count()) * unit;
  constexpr SolveLimits kLook{
      .iterations = 5, .function_tolerance = 1e-2, .parameter_tolerance = 1e-6, .rounds = 0};
  // What is near is fitted until a step changes chi2 by a hundredth.
  constexpr double kNear = 10;
  constexpr double kEnough = 0.01;
  const auto& pairs = table.pairs();
  std::vector<Solution> found(pairs.size());
  run_parallel(pairs.size(), workers, [&](std::size_t k) {
    const auto [warp, weft] = pairs[k];
    const Material& best = fit.solution.material;
    if (warp == best.warp.layers && weft == best.weft.layers) {
      found[k] = fit.solution;
    } else {
      const Solution& from = table.at(warp, weft);
      Solution& to = found[k];
      to = solve(rough, problem.set, from.material, kLook, single);
      if (to.cost - fit.solution.cost < kNear * kToldApart * unit) {
        const SolveLimits limits{
            .iterations = 50,
            .function_tolerance = kEnough * unit / std::max(to.cost, rows_cost),
            .parameter_tolerance = 1e-9,
            .rounds = 1};
        to = solve(exact, problem.set, to.material, limits, single);
      }
      to.start = from.start;
    }
    workers.advance(1);
  });
  for (std::size_t k = 0; k < pairs.size(); ++k)
    table.at(pairs[k].first, pairs[k].second) = found[k];
}

}  // namespace clothbrdf
