#include "scene/walk_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace clothbrdf {
namespace {

double peak(double slope2_along, double slope2_across, const LobeAxes<double>& axes) {
  return 1 + slope2_along / (axes.along * axes.along) + slope2_across / (axes.across * axes.across);
}

// An interface and a passage through a yarn at both ends of a range of incidence cosines: `low` has
// the smallest r, t and passage, `high` the largest.
struct Ends {
  Interface<double> low;
  Interface<double> high;
  double passage_low;
  double passage_high;
};

Ends ends_of(double refractive_index, double absorption, const Interval& cos_theta_d) {
  const Interface<double> grazing = fresnel(cos_theta_d.low, refractive_index);
  const Interface<double> steep = fresnel(cos_theta_d.high, refractive_index);
  return {{steep.reflected, grazing.transmitted, grazing.cos_theta_t},
          {grazing.reflected, steep.transmitted, steep.cos_theta_t},
          passage(absorption, grazing.cos_theta_t).once,
          passage(absorption, steep.cos_theta_t).once};
}

// Stacks of layers, from interface i (0 to 2 N) on, for one r and passage.
class Stacks {
 public:
  Stacks(int layers, double r, double once) : twice_(once * once) {
    const auto interfaces = 2 * static_cast<std::size_t>(layers);
    reflects_.assign(interfaces + 1, 0.0);
    for (std::size_t i = interfaces; i-- > 0;) {
      const double t = 1 - r;
      const double escapes = 1 - r * returned(i);
      // Nothing gets through, or nothing is lost: all comes back.
      reflects_[i] = escapes > 0 ? r + t * t * returned(i) / escapes : 1;
    }
  }
  double reflects(std::size_t i) const { return reflects_[i]; }
  /// Of what interface i lets through, what comes back to it.
  double returned(std::size_t i) const { return below(i) * reflects_[i + 1]; }
  /// What two passages leave of light between interfaces i and i + 1.
  double below(std::size_t i) const { return i % 2 == 0 ? twice_ : 1; }

 private:
  double twice_;
  std::vector<double> reflects_;
};

// Light from inside: what the stack reflects, less the surface.
Interval internal_total(int layers, const Ends& ends) {
  if (layers == 0) return {};
  const auto through = [](double r, double t, double returned) {
    return t > 0 ? std::min(1.0, t * t * returned / (1 - r * returned)) : 0;
  };
  const Stacks low(layers, ends.low.reflected, ends.passage_low);
  const Stacks high(layers, ends.high.reflected, ends.passage_high);
  return {through(ends.high.reflected, ends.low.transmitted, low.returned(0)),
          through(ends.low.reflected, ends.high.transmitted, high.returned(0))};
}

// What more layers add: the difference of two stacks' reflectance, as a product.
Interval added_total(int layers, int kept, const Ends& ends) {
  const auto added = [&](double r, double t, double once) {
    if (!(t > 0)) return 0.0;
    const Stacks all(layers, r, once);
    const Stacks few(kept, r, once);
    const auto last = 2 * static_cast<std::size_t>(kept);
    double product = all.reflects(last);
    for (std::size_t i = last; i-- > 0;) {
      product *= t * t * all.below(i) / ((1 - r * all.returned(i)) * (1 - r * few.returned(i)));
    }
    return std::min(1.0, product);  // where the ends of a range are apart it can be any number
  };
  return {added(ends.low.reflected, ends.low.transmitted, ends.passage_low),
          added(ends.high.reflected, ends.high.transmitted, ends.passage_high)};
}

Interval interreflected_total(int layers, const Ends& ends) {
  const auto total = [&](double r, double t, double once) {
    if (!(t > 0)) return 0.0;
    const Stacks stacks(layers, r, once);
    double at_once = 0;
    double later = 0;
    for (auto i = 2 * static_cast<std::size_t>(layers); i-- > 0;) {
      const double crossing = t * t * stacks.below(i);
      const double returns = r * stacks.returned(i);
      later = crossing * (later + at_once * returns) / (1 - returns);
      at_once = r + crossing * at_once;
    }
    return std::min(1.0, later);
  };
  return {total(ends.low.reflected, ends.low.transmitted, ends.passage_low),
          total(ends.high.reflected, ends.high.transmitted, ends.passage_high)};
}

// Weights of lobes 0, 1 ... and of all together.
struct LobeBounds {
  std::vector<Interval> lobes;
  Interval total;
};

void add(LobeBounds& to, const LobeBounds& more) {
  for (std::size_t j = 0; j < to.lobes.size(); ++j) to.lobes[j] = to.lobes[j] + more.lobes[j];
  to.total = to.total + more.total;
}

// Paths of one reflection. Both ends are sums of products, each falling or rising by itself.
template <class Add>
LobeBounds once_reflected(std::size_t count, const Ends& ends, const Add& add_weights) {
  std::vector<double> low(count, 0.0);
  std::vector<double> high(count, 0.0);
  add_weights(ends.low, std::span<double>(low));
  add_weights(ends.high, std::span<double>(high));
  LobeBounds bounds;
  for (std::size_t j = 0; j < count; ++j) {
    bounds.lobes.push_back(j == 0 ? Interval{} : Interval{low[j], high[j]});
    bounds.total = bounds.total + bounds.lobes.back();
  }
  return bounds;
}

// Light that is less than this part of all interreflections is no longer told apart.
constexpr double kNegligible = 1e-6;

// Walks of three and more reflections and more than `kept` events.
LobeBounds interreflected(const PreparedYarn<double>& yarn, double absorption, int layers, int kept,
                          const Ends& ends) {
  const std::size_t count = yarn.lobes.size();
  const int most = yarn.paths.most_events;
  LobeBounds bounds{std::vector<Interval>(count), {}};
  if (most == 0 || layers == 0) return bounds;
  const Interval total = interreflected_total(layers, ends);
  InterreflectionWalk<double> low(layers, ends.low, absorption);
  InterreflectionWalk<double> high(layers, ends.high, absorption);
  Interval walked;   // up to now, what was kept, too
  Interval dropped;  // less that
  std::size_t j = 0;
  bool stopped = most == PathSet::kAnyEvents;
  for (int events = 2; events <= most; ++events) {
    j = static_cast<std::size_t>(events - 1) / 2;
    if (j + 1 >= count && most == PathSet::kAnyEvents && events > kept) break;
    const Interval out = {low.step(), high.step()};
    // r + t of the larger end is above 1: nothing keeps its late sums finite.
    if (!(out.high < 1e3 * total.high)) {
      stopped = true;
      break;
    }
    walked = walked + out;
    if (events > kept) {
      Interval& lobe = bounds.lobes[std::min(j, count - 1)];
      lobe = lobe + out;
      dropped = dropped + out;
    }
    const bool rest_is_little =
        events % 2 == 1 && events > 4 * layers && out.high < kNegligible * total.high;
    if (rest_is_little && events > kept) {
      stopped = true;
      break;
    }
  }
  Interval rest;
  if (stopped)
    rest = {std::max(0.0, total.low - walked.high),
            std::max(0.0, std::min(total.high, total.high - walked.low))};
  // Whatever comes after the last step may be in any lobe from there on.
  for (std::size_t k = std::min(j, count - 1); k < count; ++k) {
    bounds.lobes[k].high = std::min(bounds.lobes[k].high + rest.high, total.high);
  }
  if (j + 1 >= count) bounds.lobes[count - 1].low += most == PathSet::kAnyEvents ? rest.low : 0;
  for (Interval& lobe : bounds.lobes) lobe.high = std::min(lobe.high, total.high);
  bounds.total = {dropped.low, std::min(total.high, dropped.high + rest.high)};
  if (most == PathSet::kAnyEvents && kept == 0) bounds.total = total;
  return bounds;
}

LobeBounds lobe_bounds(const PreparedYarn<double>& yarn, double absorption, const Walks& walks,
                       const Ends& ends) {
  const int layers = yarn.yarn.layers;
  const std::size_t count = yarn.lobes.size();
  const auto far_sides = [&](const Interface<double>& interface, std::span<double> weights) {
    single_path_weights(layers, interface, absorption, weights);
  };
  const auto near_sides = [&](const Interface<double>& interface, std::span<double> weights) {
    add_near_sides(layers, interface, absorption, weights);
  };
  switch (walks.kind) {
    case Walks::Kind::kNearSides: return once_reflected(count, ends, near_sides);
    case Walks::Kind::kInterreflections:
      return interreflected(yarn, absorption, layers, walks.kept, ends);
    case Walks::Kind::kAll: {
      LobeBounds all = once_reflected(count, ends, far_sides);
      if (yarn.paths.near_sides) add(all, once_reflected(count, ends, near_sides));
      add(all, interreflected(yarn, absorption, layers, 0, ends));
      if (yarn.paths.all()) all.total = internal_total(layers, ends);
      return all;
    }
    case Walks::Kind::kBeyond:
      if (walks.kept == 0) return lobe_bounds(yarn, absorption, {}, ends);
      if (walks.kept >= layers) return {std::vector<Interval>(count), {}};
      break;
  }
  // What reaches a deeper layer has at least that many events; what comes back from there is at
  // most what the deeper layers add to the stack.
  LobeBounds deeper = lobe_bounds(yarn, absorption, {}, ends);
  const std::size_t first = std::min(2 * static_cast<std::size_t>(walks.kept), count - 1);
  const Interval added = added_total(layers, walks.kept, ends);
  for (std::size_t j = 0; j < count; ++j) {
    deeper.lobes[j] = {0, j < first ? 0 : std::min(deeper.lobes[j].high, added.high)};
  }
  deeper.total = {yarn.paths.all() ? added.low : 0, added.high};
  return deeper;
}

}  // namespace

Interval LobeGroup::density(const Interval& along, const Interval& across,
                            const Interval& slope2) const {
  const Interval along2 = squared(along);
  const Interval across2 = squared(across);
  // Twice: by the slopes along and across, and by their sum alone.
  const double least =
      std::max(peak(along2.low, across2.low, widest),
               1 + slope2.low / std::pow(std::max(widest.along, widest.across), 2));
  const double most =
      std::min(peak(along2.high, across2.high, narrowest),
               1 + slope2.high / std::pow(std::min(narrowest.along, narrowest.across), 2));
  return {1 / (norm.high * most), 1 / (norm.low * least)};
}

Interval LobeGroup::mean_density(const Interval& slope2) const {
  const auto mean = [](double slope2_at, const LobeAxes<double>& axes) {
    return 1 / std::sqrt(peak(slope2_at, 0, axes) * peak(0, slope2_at, axes));
  };
  return {mean(slope2.high, narrowest) / norm.high, mean(slope2.low, widest) / norm.low};
}

LobeGroup surface_group(const PreparedYarn<double>& yarn) {
  const Lobe<double>& lobe = yarn.lobes.front();
  return {0, 0, lobe.axes, lobe.axes, {lobe.norm, lobe.norm}};
}

std::vector<LobeGroup> lobe_groups(const PreparedYarn<double>& yarn, double growth) {
  std::vector<LobeGroup> groups;
  for (std::size_t j = 1; j < yarn.lobes.size(); ++j) {
    const Lobe<double>& lobe = yarn.lobes[j];
    const double area = lobe.axes.along * lobe.axes.across;
    if (j > 2 && area <= growth * groups.back().narrowest.along * groups.back().narrowest.across) {
      groups.back().last = j;
      groups.back().widest = lobe.axes;
      groups.back().norm.high = lobe.norm;
    } else {
      groups.push_back({j, j, lobe.axes, lobe.axes, {lobe.norm, lobe.norm}});
    }
  }
  return groups;
}

WalkBounds walk_bounds(const PreparedYarn<double>& yarn, double absorption, const Walks& walks,
                       const std::vector<LobeGroup>& groups, const Interval& cos_theta_d) {
  const Ends ends = ends_of(yarn.yarn.refractive_index, absorption, cos_theta_d);
  const LobeBounds lobes = lobe_bounds(yarn, absorption, walks, ends);
  WalkBounds bounds{{}, lobes.total};
  Interval sum;
  for (const LobeGroup& group : groups) {
    Interval of_group;
    for (std::size_t j = group.first; j <= group.last; ++j) of_group = of_group + lobes.lobes[j];
    of_group.high = std::min(of_group.high, lobes.total.high);
    bounds.groups.push_back(of_group);
    sum = sum + of_group;
  }
  bounds.total = {std::max(lobes.total.low, sum.low), std::min(lobes.total.high, sum.high)};
  bounds.total.low = std::min(bounds.total.low, bounds.total.high);
  // What all others leave at most.
  for (Interval& group : bounds.groups) {
    group.high =
        std::max(group.low, std::min(group.high, bounds.total.high - (sum.low - group.low)));
  }
  return bounds;
}

Interval surface_bounds(double refractive_index, const Interval& cos_theta_d) {
  return {fresnel(cos_theta_d.high, refractive_index).reflected,
          fresnel(cos_theta_d.low, refractive_index).reflected};
}

namespace {

// The largest sum: weights at their lower ends, and as much more as the total allows (or needs)
// where densities are largest.
double largest_sum(const WalkBounds& weights, const std::vector<double>& densities) {
  std::array<std::size_t, 64> small;
  std::vector<std::size_t> large;
  std::span<std::size_t> order(small.data(), std::min(small.size(), densities.size()));
  if (densities.size() > small.size()) {
    large.resize(densities.size());
    order = large;
  }
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return densities[a] > densities[b]; });
  double sum = 0;
  double used = 0;
  for (std::size_t g = 0; g < densities.size(); ++g) {
    sum += weights.groups[g].low * densities[g];
    used += weights.groups[g].low;
  }
  for (const std::size_t g : order) {
    const double allowed = densities[g] > 0 ? weights.total.high : weights.total.low;
    const double more = std::clamp(allowed - used, 0.0, weights.groups[g].width());
    sum += more * densities[g];
    used += more;
  }
  return sum;
}

}  // namespace

Interval sum_bounds(const WalkBounds& weights, const std::vector<Interval>& densities) {
  std::vector<double> ends;
  ends.reserve(densities.size());
  for (const Interval& density : densities) ends.push_back(density.high);
  const double high = largest_sum(weights, ends);
  for (std::size_t g = 0; g < densities.size(); ++g) ends[g] = -densities[g].low;
  return {-largest_sum(weights, ends), high};
}

}  // namespace clothbrdf
