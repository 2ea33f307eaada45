#include "cost/cells_ratio.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace clothbrdf {
namespace {

using Curve = std::vector<std::pair<double, double>>;  // log rms, log cells; by cells

/// Settings of a dial that are otherwise as `like`. Where more cells err as much, they are no use
/// to anyone: left out, so that the error falls.
Curve curve_of(std::span<const CostSetting> settings, const std::string& dial,
               const CostSetting& like) {
  Curve all;
  for (const CostSetting& setting : settings) {
    if (setting.front == like.front && setting.dial == dial && setting.format == like.format &&
        setting.cells == like.cells && setting.reader == like.reader &&
        setting.stored == like.stored && setting.size > 0 && setting.error.rms > 0)
      all.emplace_back(std::log(setting.error.rms), std::log(setting.size));
  }
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return a.second < b.second; });
  Curve falling;
  for (const auto& point : all) {
    if (falling.empty() || point.first < falling.back().first) falling.push_back(point);
  }
  return falling;
}

double cells_at(const Curve& curve, double log_rms) {
  const auto after = std::find_if(curve.begin() + 1, curve.end() - 1,
                                  [&](const auto& point) { return point.first <= log_rms; });
  const auto& [rms_a, cells_a] = *(after - 1);
  const auto& [rms_b, cells_b] = *after;
  return cells_a + (cells_b - cells_a) * (log_rms - rms_a) / (rms_b - rms_a);
}

}  // namespace

std::optional<CellsRatio> chosen_nodes_ratio(std::span<const CostSetting> settings) {
  for (const CostSetting& first : settings) {
    if (first.front != "4-D" || first.dial != "chosen nodes" || first.reader != "linear") continue;
    const Curve chosen = curve_of(settings, "chosen nodes", first);
    const Curve uniform = curve_of(settings, "uniform axes", first);
    if (chosen.size() < 2 || uniform.size() < 2) continue;
    const double highest = std::min(chosen.front().first, uniform.front().first);
    const double lowest = std::max(chosen.back().first, uniform.back().first);
    if (lowest > highest) continue;
    const double middle = (lowest + highest) / 2;
    return CellsRatio{std::exp(cells_at(uniform, middle) - cells_at(chosen, middle)),
                      std::exp(middle)};
  }
  return std::nullopt;
}

}  // namespace clothbrdf
