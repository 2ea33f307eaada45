#include "fit/profile.h"

#include <algorithm>
#include <cmath>

namespace clothbrdf {

Profile profile_likelihood(const Misfit& misfit, const ParameterSet& set, std::size_t parameter,
                           const Material& best, double noise, int points, Workers workers) {
  const FitParameter& p = set.parameters()[parameter];
  Profile profile;
  profile.name = p.name;
  const ParameterSet others = set.with_fixed(parameter);
  const double value = parameter_value(best, p);
  const double least = misfit.cost(best);
  // Evenly in the coordinate, up to four times the value or the bounds.
  constexpr double kReach = 4;
  const double unit = std::max(std::abs(value), p.log_offset > 0 ? p.log_offset : 0.05);
  double low = p.column == kRotation ? value - 45 : value - unit * (1 - 1 / kReach);
  double high = p.column == kRotation ? value + 45 : value + unit * (kReach - 1);
  low = std::max(low, p.lowest);
  high = std::min(high, p.highest);
  const double from = p.to_coordinate(low);
  const double to = p.to_coordinate(high);
  const double at = p.to_coordinate(value);
  const auto fit_at = [&](double coordinate, Material& start) {
    ProfilePoint point;
    point.value = p.to_value(coordinate);
    set_parameter(start, p, point.value);
    constexpr SolveLimits kLimits{
        .iterations = 40, .function_tolerance = 1e-3, .parameter_tolerance = 1e-8, .rounds = 1};
    const Solution solution = solve(misfit, others, start, kLimits, workers);
    point.chi2 = std::max(0.0, solution.cost - least) / (noise * noise);
    for (const std::size_t i : solution.at_bound) {
      point.at_bound.push_back(set.parameters()[i].name);
    }
    start = solution.material;
    return point;
  };
  const int half = std::max(1, points / 2);
  for (const double end : {from, to}) {
    Material start = best;
    for (int k = 1; k <= half; ++k) {
      const double coordinate = at + (end - at) * k / half;
      if (coordinate == at) break;
      profile.points.push_back(fit_at(coordinate, start));
    }
  }
  profile.points.push_back({value, 0, {}});
  std::sort(profile.points.begin(), profile.points.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.value < b.value; });
  return profile;
}

}  // namespace clothbrdf
