#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace clothbrdf::test {

/// Where a derivative is taken from.
enum class Side { kBoth, kAbove, kBelow };

/// The derivative of every element of `function` at x by Ridders' method: differences of ever
/// smaller steps, extrapolated to none. Each element keeps its own best extrapolation.
inline std::vector<double> ridders(const std::function<std::vector<double>(double)>& function,
                                   double x, double first_step, Side side) {
  constexpr int kSteps = 9;
  constexpr double kShrink = 2;
  const double growth = side == Side::kBoth ? kShrink * kShrink : kShrink;
  const std::vector<double> here = side == Side::kBoth ? std::vector<double>{} : function(x);
  std::vector<std::vector<double>> above;  // the row of the tableau before
  std::vector<double> best;
  std::vector<double> least;
  double step = first_step;
  for (int i = 0; i < kSteps; ++i, step /= kShrink) {
    const double signed_step = side == Side::kBelow ? -step : step;
    const std::vector<double> there = function(x + signed_step);
    const std::vector<double> from = side == Side::kBoth ? function(x - step) : here;
    const double length = side == Side::kBoth ? 2 * step : signed_step;
    std::vector<std::vector<double>> row(static_cast<std::size_t>(i) + 1);
    row[0].resize(there.size());
    for (std::size_t e = 0; e < there.size(); ++e) row[0][e] = (there[e] - from[e]) / length;
    if (i == 0) {
      best = row[0];
      least.assign(best.size(), std::numeric_limits<double>::infinity());
    }
    double factor = growth;
    for (std::size_t j = 1; j < row.size(); ++j, factor *= growth) {
      row[j].resize(there.size());
      for (std::size_t e = 0; e < there.size(); ++e) {
        row[j][e] = (row[j - 1][e] * factor - above[j - 1][e]) / (factor - 1);
        const double error =
            std::max(std::abs(row[j][e] - row[j - 1][e]), std::abs(row[j][e] - above[j - 1][e]));
        if (error < least[e]) {
          least[e] = error;
          best[e] = row[j][e];
        }
      }
    }
    above = std::move(row);
  }
  return best;
}

}  // namespace clothbrdf::test
