#include "cost/convergence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cost/fit_line.h"
#include "model/layers.h"

namespace clothbrdf {
namespace {

constexpr double kRounding = 1e-13;  // errors below are those of the arithmetic
constexpr std::size_t kFewest = 3;
constexpr double kOrderOff = 0.35;
constexpr double kRatioOff = 0.25;  // of the ratio

/// Settings that differ only in size, by size.
using Line = std::map<double, double>;  // rms by size

std::string line_name(const CostSetting& setting) {
  std::string name = setting.front == "evaluation" ? "" : setting.front + " ";
  name += setting.dial;
  for (const std::string* part :
       {&setting.format, &setting.cells, &setting.reader, &setting.stored})
    if (!part->empty()) name += ", " + *part;
  return name;
}

Convergence named(const CostSetting& setting, const char* law) {
  Convergence named;
  named.dial = line_name(setting);
  named.law = law;
  return named;
}

/// What stops a table's error from falling as the grid gets finer: half the last digit of a half,
/// in the mean of squares over a binade.
constexpr double kHalfRounding = 2e-4;

std::string table_reason(const CostSetting& finest, double expected, double fitted) {
  if (fitted > expected)
    return "steeper: the coarsest grids miss the lobes, or an axis needs no more nodes";
  if (finest.stored == "half" && finest.error.rms < 5 * kHalfRounding)
    return "flatter: values stored as half round by about 0.02 %, below which no grid gets";
  return "flatter: the V-cavity's kink and cells cut by the horizon are of lower order";
}

Convergence table_law(const CostSetting& finest, const Line& line) {
  const double dimensions = finest.front == "3-D" ? 3 : 4;
  std::vector<double> x;
  std::vector<double> y;
  for (const auto& [cells, rms] : line) {
    x.push_back(-std::log(cells) / dimensions);
    y.push_back(std::log(rms));
  }
  Convergence law = named(finest, "rms ~ step^order");
  law.expected = finest.reader == "nearest" ? 1 : 2;
  law.fitted = fitted_slope(x, y);
  law.differs = std::abs(law.fitted - law.expected) > kOrderOff;
  if (law.differs) law.reason = table_reason(finest, law.expected, law.fitted);
  return law;
}

/// What a yarn reflects at normal incidence with so many layers, surface included.
double reflected(Yarn yarn, Paths paths, double absorption, int layers) {
  yarn.layers = std::min(layers, yarn.layers);
  std::vector<double> weights(static_cast<std::size_t>(lobe_count(yarn, paths)));
  path_weights(yarn, paths, fresnel(1.0, yarn.refractive_index), absorption,
               std::span<double>(weights));
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

struct LeastAbsorbing {
  const Yarn* yarn = nullptr;
  double absorption = std::numeric_limits<double>::infinity();
};

LeastAbsorbing least_absorbing(const Material& material) {
  const int most = std::max(material.warp.layers, material.weft.layers);
  LeastAbsorbing least;
  for (const Yarn* yarn : {&material.warp, &material.weft}) {
    if (yarn->layers < most) continue;
    for (const double absorption : yarn->absorption) {
      if (absorption < least.absorption) least = {yarn, absorption};
    }
  }
  return least;
}

std::optional<Convergence> layers_law(const Material& material, const CostSetting& any,
                                      const Line& line) {
  const LeastAbsorbing least = least_absorbing(material);
  const double whole = reflected(*least.yarn, material.paths, least.absorption, least.yarn->layers);
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> left_out;
  for (const auto& [layers, rms] : line) {
    const double kept =
        reflected(*least.yarn, material.paths, least.absorption, static_cast<int>(layers));
    if (!(whole > kept)) continue;
    x.push_back(layers);
    y.push_back(std::log(rms));
    left_out.push_back(std::log(whole - kept));
  }
  if (x.size() < kFewest) return std::nullopt;
  Convergence law = named(any, "rms ~ ratio^layers");
  law.expected = std::exp(fitted_slope(x, left_out));
  law.fitted = std::exp(fitted_slope(x, y));
  const bool clear = least.absorption == 0 && material.paths == Paths::kAll;
  law.differs = clear || std::abs(law.fitted / law.expected - 1) > kRatioOff;
  if (clear) {
    law.reason = "without absorption a pile of plates converges as 1 / layers, without a ratio";
  } else if (law.differs) {
    law.reason = law.fitted < law.expected
                     ? "steeper: oblique light and the other channels are absorbed sooner"
                     : "flatter: the yarns and channels that keep least light weigh more";
  }
  return law;
}

Convergence rotations_law(const CostSetting& any, const Line& line) {
  std::vector<std::pair<double, double>> last(line.rbegin(), line.rend());
  const auto order = [&](std::size_t k) {  // between points k and k + 1 from the end
    return -std::log(last[k].second / last[k + 1].second) /
           std::log(last[k].first / last[k + 1].first);
  };
  Convergence law = named(any, "rms ~ rotations^-order");
  law.expected = order(1);
  law.fitted = order(0);
  law.differs = !(law.fitted > law.expected + kOrderOff);
  if (law.differs) {
    law.reason = "so few rotations do not resolve the lobes";
  } else {
    law.law += ", faster than any power";
  }
  return law;
}

}  // namespace

std::vector<Convergence> convergence(const Material& material,
                                     std::span<const CostSetting> settings) {
  std::vector<Convergence> laws;
  std::vector<std::string> done;
  for (const CostSetting& first : settings) {
    const std::string name = line_name(first);
    if (std::find(done.begin(), done.end(), name) != done.end()) continue;
    done.push_back(name);
    const bool table = first.front != "evaluation";
    const bool layers = !table && first.dial == "layers kept";
    const bool rotations = !table && first.dial == "rotations";
    if (!table && !layers && !rotations) continue;
    Line line;
    const CostSetting* finest = &first;
    for (const CostSetting& setting : settings) {
      if (line_name(setting) != name || !(setting.error.rms > kRounding)) continue;
      if (!layers && !(setting.size > 0)) continue;
      line[setting.size] = setting.error.rms;
      if (setting.size >= finest->size) finest = &setting;
    }
    if (line.size() < kFewest) continue;
    if (table) {
      laws.push_back(table_law(*finest, line));
    } else if (layers) {
      if (auto law = layers_law(material, first, line)) laws.push_back(*std::move(law));
    } else {
      laws.push_back(rotations_law(first, line));
    }
  }
  return laws;
}

}  // namespace clothbrdf
