#include "cost/front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "cost/cells_ratio.h"
#include "cost/fidelity.h"

namespace clothbrdf {
namespace {

constexpr std::array<double, 6> kTargets = {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003};

bool same_front(const CostSetting& a, const CostSetting& b) {
  return a.front == b.front && (a.dial == "rotations") == (b.dial == "rotations");
}

bool beats(const CostSetting& a, const CostSetting& b) {
  const bool no_worse = a.seconds.median <= b.seconds.median && a.error.rms <= b.error.rms;
  return no_worse && (a.seconds.median < b.seconds.median || a.error.rms < b.error.rms);
}

/// Two significant digits, never with an exponent.
std::string two_digits(double value) {
  const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double unit = std::pow(10.0, magnitude - 1);
  const double rounded = value == 0 ? 0 : std::round(value / unit) * unit;
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", std::clamp(1 - magnitude, 0, 20), rounded);
  std::string digits = text.data();
  if (digits.find('.') != std::string::npos) {
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
  }
  return digits;
}

std::string percent(double share) { return two_digits(100 * share) + " %"; }

std::string file_size(std::uint64_t bytes) {
  constexpr std::array<const char*, 4> kUnits = {"bytes", "kB", "MB", "GB"};
  auto size = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (size >= 999.5 && unit + 1 < kUnits.size()) {
    size /= 1000;
    ++unit;
  }
  return two_digits(size) + " " + kUnits[unit];
}

std::string costs(double target, const CostSetting& setting) {
  std::string text = setting.front + ": " + percent(target) + " rms costs " +
                     two_digits(setting.seconds.median) + " s";
  if (setting.bytes) text += " and " + file_size(*setting.bytes);
  return text + " (" + setting.name + ")";
}

void add_targets(std::span<const CostSetting> settings, const std::string& front,
                 std::vector<std::string>& said) {
  std::vector<std::pair<double, const CostSetting*>> reached;
  const CostSetting* best = nullptr;
  for (const CostSetting& setting : settings) {
    if (setting.front != front || !setting.pareto) continue;
    if (best == nullptr || setting.error.rms < best->error.rms) best = &setting;
  }
  if (best == nullptr) return;
  std::optional<double> missed;
  for (const double target : kTargets) {
    const CostSetting* cheapest = nullptr;
    for (const CostSetting& setting : settings) {
      if (setting.front != front || !setting.pareto || !(setting.error.rms <= target)) continue;
      if (cheapest == nullptr || setting.seconds.median < cheapest->seconds.median)
        cheapest = &setting;
    }
    if (cheapest == nullptr) {
      missed = target;
      break;
    }
    if (!reached.empty() && reached.back().second == cheapest) reached.pop_back();
    reached.emplace_back(target, cheapest);
  }
  for (const auto& [target, setting] : reached) said.push_back(costs(target, *setting));
  if (missed) {
    said.push_back(front + ": no setting reaches " + percent(*missed) + " rms; the best has " +
                   percent(best->error.rms) + " (" + best->name + ")");
  }
}

/// Differences that timings of the same work show, too, are none.
std::string saving(const CostSetting& setting, const CostSetting& all) {
  constexpr double kNoticed = 0.05;
  const Timing& a = setting.seconds;
  const Timing& b = all.seconds;
  const double change = a.median / b.median - 1;
  if (std::abs(change) < kNoticed || (a.lowest <= b.highest && b.lowest <= a.highest))
    return "saves no time";
  return change < 0 ? "saves " + percent(-change) + " of the time"
                    : "takes " + percent(change) + " more time";
}

void add_evaluations(std::span<const CostSetting> settings, std::vector<std::string>& said) {
  const auto all = std::find_if(settings.begin(), settings.end(),
                                [](const CostSetting& s) { return s.name == kAllPaths; });
  if (all == settings.end()) return;
  const auto add = [&](const CostSetting& setting, const std::string& what) {
    said.push_back(what + " " + saving(setting, *all) + " and costs " + percent(setting.error.rms) +
                   " rms");
  };
  for (const CostSetting& setting : settings) {
    if (setting.dial == "paths" && setting.name != kAllPaths)
      add(setting, setting.name + " in place of all paths");
  }
  std::vector<const CostSetting*> layers;
  for (const CostSetting& setting : settings) {
    if (setting.dial == "layers kept") layers.push_back(&setting);
  }
  std::sort(layers.begin(), layers.end(),
            [](const CostSetting* a, const CostSetting* b) { return a->size < b->size; });
  for (const CostSetting* setting : layers) add(*setting, setting->name + ":");
}

}  // namespace

void mark_fronts(std::vector<CostSetting>& settings) {
  for (CostSetting& setting : settings) {
    setting.pareto = std::none_of(settings.begin(), settings.end(), [&](const CostSetting& other) {
      return same_front(other, setting) && beats(other, setting);
    });
  }
  // In the order of the alphabet, as it happens.
  std::stable_sort(
      settings.begin(), settings.end(), [](const CostSetting& a, const CostSetting& b) {
        return std::pair(a.front, a.seconds.median) < std::pair(b.front, b.seconds.median);
      });
}

std::vector<std::string> sentences(std::span<const CostSetting> settings) {
  std::vector<std::string> said;
  for (const char* front : {"3-D", "4-D"}) add_targets(settings, front, said);
  if (const auto ratio = chosen_nodes_ratio(settings)) {
    said.push_back("4-D: chosen nodes need " + two_digits(ratio->times_fewer) +
                   " times fewer cells than axes uniform in angle at " + percent(ratio->rms) +
                   " rms");
  }
  add_evaluations(settings, said);
  return said;
}

}  // namespace clothbrdf
