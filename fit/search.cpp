#include "fit/search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace clothbrdf {
namespace {

// A start's solve need not end: what is promising goes on from there.
constexpr SolveLimits kFirstLook{
    .iterations = 25, .function_tolerance = 1e-4, .parameter_tolerance = 1e-5, .rounds = 0};
constexpr SolveLimits kNeighbour{
    .iterations = 20, .function_tolerance = 1e-4, .parameter_tolerance = 1e-6, .rounds = 0};

// Starts that go on to look for better layer counts.
constexpr std::size_t kPromising = 6;

// Where the best fit is no match for the data, or where a single start reached it, a better one may
// have been missed: as many starts again, up to so many times.
constexpr std::size_t kMostBatches = 4;

// [0, 1), the same on every platform.
double unit(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-53; }

// Number 0 is the estimate itself; of the others every second one keeps its axes and absorption,
// up to a factor.
Material scattered_start(const ParameterSet& set, const FitOptions& options,
                         const Material& estimate, std::uint64_t number) {
  std::mt19937_64 engine(options.seed * 0x9e3779b97f4a7c15ULL + number);
  Material material = estimate;
  const auto near_estimate = [&](const FitParameter& p) {
    return number % 2 == 1 &&
           (p.column == kAlong || p.column == kAcross || p.column == kAbsorption);
  };
  const double reach = std::log(3.0);
  for (std::size_t i = 0; i < set.parameters().size(); ++i) {
    const double u = unit(engine);
    if (number == 0 || set.has_start(i) || set.state(i) != ParameterSet::State::kFree) continue;
    const FitParameter& p = set.parameters()[i];
    if (near_estimate(p)) {
      const double value = parameter_value(estimate, p) * std::exp(reach * (2 * u - 1));
      set_parameter(material, p, std::clamp(value, p.lowest, p.highest));
      continue;
    }
    const double low = p.to_coordinate(p.scatter_low);
    const double high = p.to_coordinate(p.scatter_high);
    set_parameter(material, p, p.to_value(low + (high - low) * u));
  }
  for (const std::size_t yarn : {0U, 1U}) {
    const double u = unit(engine);
    const LayerRange range = layer_range(set, options, yarn);
    // At least one: without layers most parameters have no effect to start from.
    const int fewest = std::min(std::max(range.fewest, 1), range.most);
    if (number == 0 && set.layers_started(yarn)) continue;
    int& layers = (yarn == 0 ? material.warp : material.weft).layers;
    layers = std::min(fewest + static_cast<int>(u * (range.most - fewest + 1)), range.most);
  }
  if (set.layers_tied()) material.weft.layers = material.warp.layers;
  return set.material(set.coordinates(material), material);
}

class Searcher {
 public:
  Searcher(const Misfit& misfit, const ParameterSet& set, Workers workers)
      : misfit_(misfit), set_(set), workers_(workers), single_(1, workers.progress) {}

  Solution fit(const Material& start, const SolveLimits& limits) const {
    return solve(misfit_, set_, start, limits, single_);
  }

  // On from where another solve ended, with layer counts of its own.
  Solution go_on(const Solution& from, int warp, int weft) const {
    Solution next = fit(with_layers(from.material, warp, weft), kNeighbour);
    next.start = from.start;
    return next;
  }
  Solution go_on(const Solution& from) const {
    return go_on(from, from.material.warp.layers, from.material.weft.layers);
  }

  // Better counts beside those of `from`, one step at a time.
  Solution descend(Solution from, const LayerTable& table) const {
    for (;;) {
      Solution best = from;
      for (const auto& [dw, df] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}}) {
        if (std::abs(dw + df) != 1 && !set_.layers_tied()) continue;
        const int warp = from.material.warp.layers + dw;
        const int weft = from.material.weft.layers + df;
        if (!table.holds(warp, weft)) continue;
        Solution next = go_on(from, warp, weft);
        if (next.cost < best.cost) best = next;
      }
      if (!(best.cost < from.cost * (1 - 1e-3))) return from;
      from = best;
    }
  }

  static Material with_layers(Material material, int warp, int weft) {
    material.warp.layers = warp;
    material.weft.layers = weft;
    return material;
  }

  // Every pair of counts, from the best outward, each from its best neighbours.
  void fill(LayerTable& table) const {
    const std::pair<int, int> centre = table.best();
    const auto distance = [&](const std::pair<int, int>& pair) {
      return std::abs(pair.first - centre.first) + std::abs(pair.second - centre.second);
    };
    int farthest = 0;
    for (const auto& pair : table.pairs()) farthest = std::max(farthest, distance(pair));
    for (int ring = 1; ring <= farthest; ++ring) {
      std::vector<std::pair<int, int>> pairs;
      for (const auto& pair : table.pairs()) {
        if (distance(pair) == ring) pairs.push_back(pair);
      }
      std::vector<Solution> found(pairs.size());
      run_parallel(pairs.size(), workers_, [&](std::size_t k) {
        found[k] = from_neighbours(table, pairs[k].first, pairs[k].second);
      });
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        Solution& to = table.at(pairs[k].first, pairs[k].second);
        if (found[k].cost < to.cost) to = found[k];
      }
      workers_.advance(pairs.size());
    }
  }

 private:
  Solution from_neighbours(const LayerTable& table, int warp, int weft) const {
    const Solution* nearest = nullptr;
    for (int dw = -1; dw <= 1; ++dw) {
      for (int df = -1; df <= 1; ++df) {
        if (!table.holds(warp + dw, weft + df)) continue;
        const Solution& beside = table.at(warp + dw, weft + df);
        if (nearest == nullptr || beside.cost < nearest->cost) nearest = &beside;
      }
    }
    // The best of all, too: where a yarn hardly shows, its neighbours may be far out.
    const auto [best_warp, best_weft] = table.best();
    const Solution beside = go_on(*nearest, warp, weft);
    const Solution from_best = go_on(table.at(best_warp, best_weft), warp, weft);
    return from_best.cost < beside.cost ? from_best : beside;
  }

  const Misfit& misfit_;
  const ParameterSet& set_;
  Workers workers_;
  Workers single_;
};

// Starts that ended within this of each other are in one minimum. `rounding`: a cost that the sums'
// own error explains.
bool same_minimum(double a, double b, double rounding) {
  constexpr double kShare = 0.05;
  return std::abs(a - b) <= kShare * a + rounding;
}

// Whether what a fit leaves is no more than the scatter of the samples within their groups, which
// no material changes.
bool matches_data(const Rows& rows, double cost, double rounding) {
  const auto count = static_cast<double>(rows.row_count());
  const double within = static_cast<double>(rows.values) - count;
  constexpr double kEnough = 100;
  if (within < kEnough) return false;
  constexpr double kDeviations = 6;
  return cost <= rounding + rows.constant / within * (count + kDeviations * std::sqrt(2 * count));
}

void count_optima(const std::vector<Solution>& ends, double best, double rounding, Search& result) {
  const auto same = [&](double a, double b) { return same_minimum(a, b, rounding); };
  for (const Solution& end : ends) {
    if (same(best, end.cost)) ++result.starts_at_best;
    bool known = false;
    for (Optimum& optimum : result.optima) {
      if (same(optimum.chi2, end.cost)) {
        ++optimum.starts;
        known = true;
        break;
      }
    }
    if (!known) {
      result.optima.push_back({end.cost, 1, end.material.warp.layers, end.material.weft.layers});
    }
  }
  std::sort(result.optima.begin(), result.optima.end(),
            [](const Optimum& a, const Optimum& b) { return a.chi2 < b.chi2; });
}

}  // namespace

LayerRange layer_range(const ParameterSet& set, const FitOptions& options, std::size_t yarn) {
  if (!set.layers_fixed(yarn)) return {options.fewest_layers, options.most_layers};
  const int layers = (yarn == 0 ? set.defaults().warp : set.defaults().weft).layers;
  return {layers, layers};
}

LayerTable::LayerTable(LayerRange warp, LayerRange weft, bool tied)
    : warp_(warp), weft_(weft), tied_(tied) {
  Solution none;
  none.cost = HUGE_VAL;
  for (int a = warp.fewest; a <= warp.most; ++a) {
    for (int b = weft.fewest; b <= weft.most; ++b) {
      if (!tied || a == b) pairs_.emplace_back(a, b);
      fits_.push_back(none);
    }
  }
}

bool LayerTable::holds(int warp, int weft) const {
  return warp >= warp_.fewest && warp <= warp_.most && weft >= weft_.fewest && weft <= weft_.most &&
         (!tied_ || warp == weft);
}

std::size_t LayerTable::index(int warp, int weft) const {
  return static_cast<std::size_t>((warp - warp_.fewest) * (weft_.most - weft_.fewest + 1) + weft -
                                  weft_.fewest);
}

std::pair<int, int> LayerTable::best() const {
  std::pair<int, int> best = pairs_.front();
  for (const auto& pair : pairs_) {
    if (at(pair.first, pair.second).cost < at(best.first, best.second).cost) best = pair;
  }
  return best;
}

Search search(const Misfit& misfit, const ParameterSet& set, const FitOptions& options,
              const Material& estimate, Reflectance reflectance, Paths paths, Workers workers) {
  Search result{
      LayerTable(layer_range(set, options, 0), layer_range(set, options, 1), set.layers_tied()),
      0,
      0,
      {}};
  const Searcher searcher(misfit, set, workers);
  const bool asked = options.start.has_value();
  const auto starts = static_cast<std::size_t>(asked ? 1 : std::max(options.starts, 1));
  const auto run_start = [&](std::size_t k) {
    Material start = asked ? set.defaults() : scattered_start(set, options, estimate, k);
    start.reflectance = reflectance;
    start.paths = paths;
    const auto inside = [&](int layers, std::size_t yarn) {
      const LayerRange range = layer_range(set, options, yarn);
      return std::clamp(layers, range.fewest, range.most);
    };
    start =
        Searcher::with_layers(start, inside(start.warp.layers, 0), inside(start.weft.layers, 1));
    if (!asked) start = with_best_weights(misfit, set, start);
    return searcher.fit(start, kFirstLook);
  };
  const double rounding = kSearching.tolerance * kSearching.tolerance * misfit.rows().target_square;
  std::vector<Solution> ends;
  for (std::size_t batch = 0; batch < kMostBatches; ++batch) {
    std::vector<Solution> found(starts);
    run_parallel(starts, workers, [&](std::size_t k) {
      found[k] = run_start(batch * starts + k);
      if (batch == 0) workers.advance(1);
    });
    std::stable_sort(found.begin(), found.end(),
                     [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
    run_parallel(std::min(starts, kPromising), workers, [&](std::size_t k) {
      found[k] = searcher.descend(searcher.go_on(found[k]), result.layers);
    });
    ends.insert(ends.end(), found.begin(), found.end());
    double lowest = HUGE_VAL;
    for (const Solution& end : ends) lowest = std::min(lowest, end.cost);
    const auto at_best = std::count_if(ends.begin(), ends.end(), [&](const Solution& end) {
      return same_minimum(lowest, end.cost, rounding);
    });
    if (asked || starts == 1 || matches_data(misfit.rows(), lowest, rounding)) break;
    // Measured tables match no model: then the starts decide.
    if (at_best > static_cast<std::ptrdiff_t>(kPromising)) break;
  }
  if (!asked) result.starts = static_cast<int>(ends.size());
  for (const Solution& end : ends) {
    Solution& to = result.layers.at(end.material.warp.layers, end.material.weft.layers);
    if (end.cost < to.cost) to = end;
  }
  const std::pair<int, int> best = result.layers.best();
  count_optima(ends, result.layers.at(best.first, best.second).cost, rounding, result);
  searcher.fill(result.layers);
  return result;
}

void fill_layers(const Misfit& misfit, const ParameterSet& set, LayerTable& table,
                 Workers workers) {
  Searcher(misfit, set, workers).fill(table);
}

}  // namespace clothbrdf
