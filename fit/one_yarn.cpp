#include "fit/one_yarn.h"

namespace clothbrdf {

std::optional<ParameterSet> one_yarn_set(const ParameterSet& set, const FitOptions& options,
                                         bool with_phi_h) {
  if (set.layers_fixed(0) || set.layers_fixed(1) || set.layers_tied()) return std::nullopt;
  FitOptions tied = options;
  tied.wishes.push_back({ParameterWish::Kind::kTie, "weft", {}, {}, {}});
  for (std::size_t i = 0; i < set.parameters().size(); ++i) {
    const FitParameter& p = set.parameters()[i];
    const bool free = set.state(i) == ParameterSet::State::kFree;
    if (p.of_yarn && !free) return std::nullopt;
    if (p.column == kFraction && free && !with_phi_h) {
      constexpr double kHalf = 0.5;
      tied.wishes.push_back({ParameterWish::Kind::kFix, p.name, kHalf, {}, {}});
    }
  }
  return ParameterSet(tied, set.channels(), with_phi_h);
}

bool try_one_yarn(const FitProblem& problem, const FitOptions& options, bool with_phi_h,
                  SettledFit& fit, LayerTable& layers, Workers workers) {
  const std::optional<ParameterSet> tied = one_yarn_set(problem.set, options, with_phi_h);
  if (!tied) return false;
  Material start = fit.solution.material;
  const Yarn larger = start.warp_fraction >= 0.5 ? start.warp : start.weft;
  start.warp = start.weft = larger;
  if (!with_phi_h) start.warp_fraction = tied->defaults().warp_fraction;
  const Misfit misfit(problem.observations, fit.rows, kExact, workers);
  const double noise = problem.noise_of(fit);
  Solution one = solve(misfit, *tied, start, to_the_end(fit.rows, noise), workers);
  if ((one.cost - fit.solution.cost) / (noise * noise) > kToldApart) return false;
  one.start = fit.solution.start;
  fit.solution = one;
  fit.chi2 = fit.rows.constant + one.cost;
  layers.at(one.material.warp.layers, one.material.weft.layers) = one;
  return true;
}

}  // namespace clothbrdf
