#include "scene/contribution.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clothbrdf {
namespace {

using Kind = Quantity::Kind;

// How far a group's lobes may differ. Where weights change in both directions, as with Fresnel's
// angle, what lobes of a group differ by stays even in the smallest box.
constexpr double kGrowth = 1.1;
constexpr double kNearlyOne = 1.02;

bool is_one_of(Kind kind, std::initializer_list<Kind> kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

Walks walks_of(const Quantity& quantity) {
  switch (quantity.kind) {
    case Kind::kLayers: return {Walks::Kind::kBeyond, quantity.kept};
    case Kind::kInterreflection: return {Walks::Kind::kInterreflections, quantity.kept};
    case Kind::kNearSide: return {Walks::Kind::kNearSides, 0};
    default: return {};
  }
}

const PreparedYarn<double>& smaller(const ClothModel<double>& model) {
  const auto yarns = model.yarns();
  return yarns.size() == 2 && yarns[0].share < yarns[1].share ? yarns[0] : yarns.back();
}

// Of a factor that may be unbounded.
Interval product(const Interval& factor, const Interval& sum) {
  if (std::isfinite(factor.high)) return factor * sum;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {sum.low < 0 ? -kInfinity : factor.low * sum.low, sum.high > 0 ? kInfinity : 0};
}

// b less a, both sums of the same walks with `b` weighing each more.
WalkBounds difference(const WalkBounds& more, const WalkBounds& less) {
  const auto positive = [](const Interval& i) {
    return Interval{std::max(0.0, i.low), std::max(0.0, i.high)};
  };
  WalkBounds result{{}, positive(more.total - less.total)};
  for (std::size_t g = 0; g < more.groups.size(); ++g) {
    result.groups.push_back(positive(more.groups[g] - less.groups[g]));
    result.groups.back().high = std::min(result.groups.back().high, result.total.high);
  }
  return result;
}

}  // namespace

Contribution::Contribution(const ClothModel<double>& model, const Quantity& quantity)
    : model_(model), quantity_(quantity) {
  const Kind kind = quantity.kind;
  has_surface_ = model.material().weights.specular > 0 &&
                 is_one_of(kind, {Kind::kWhole, Kind::kSpecular, Kind::kSmallerYarn,
                                  Kind::kFresnelAngle, Kind::kAnisotropy, Kind::kShadowing});
  has_walks_ = !is_one_of(kind, {Kind::kSpecular, Kind::kDiffuse});
  for (const PreparedYarn<double>& yarn : model.yarns()) {
    if (kind == Kind::kSmallerYarn && &yarn != &smaller(model)) continue;
    parts_.push_back({&yarn,
                      surface_group(yarn),
                      lobe_groups(yarn, kind == Kind::kFresnelAngle ? kNearlyOne : kGrowth),
                      std::vector<Paths>(model.channel_count()),
                      {},
                      {},
                      {}});
    parts_.back().densities.resize(parts_.back().groups.size());
    Effects grey;
    grey.colour = false;
    const Material without = apply_effects(model.material(), grey);
    grey_.push_back((yarn.warp ? without.warp : without.weft).absorption);
    for (std::size_t c = 0; c < model.channel_count(); ++c) {
      // Each walk weighs more where less is absorbed.
      if (kind == Kind::kColour && yarn.yarn.absorption[c] > grey_.back()[c])
        parts_.back().channels[c].sign = -1;
    }
  }
  for (std::size_t c = 0; c < model.channel_count(); ++c) constants_.push_back(constant(c));
}

void Contribution::take_densities(YarnPart& part, const GeometryBounds& g) const {
  const bool warp = part.yarn->warp;
  const Interval& along = warp ? g.slope_warp : g.slope_weft;
  const Interval& across = warp ? g.slope_weft : g.slope_warp;
  const auto density = [&](const LobeGroup& group) {
    if (!model_.effects().anisotropy) return group.mean_density(g.slope2);
    const Interval there = group.density(along, across, g.slope2);
    return quantity_.kind == Kind::kAnisotropy ? there - group.mean_density(g.slope2) : there;
  };
  part.surface_density = density(part.surface);
  for (std::size_t k = 0; k < part.groups.size(); ++k) {
    part.densities[k] = density(part.groups[k]);
    if (quantity_.kind == Kind::kScatter)
      part.densities[k] = part.densities[k] - part.surface_density;
  }
}

Interval Contribution::surface_weight(const YarnPart& part, const Interval& x) const {
  const double index = part.yarn->yarn.refractive_index;
  const Interval r = surface_bounds(index, x);
  if (quantity_.kind != Kind::kFresnelAngle) return r;
  return r - surface_bounds(index, {quantity_.cos_theta_d, quantity_.cos_theta_d});
}

WalkBounds Contribution::walks(const YarnPart& part, std::size_t channel, const Interval& x) const {
  const PreparedYarn<double>& yarn = *part.yarn;
  const double absorption = yarn.yarn.absorption[channel];
  const auto bounds = [&](double of, const Interval& at) {
    return walk_bounds(yarn, of, walks_of(quantity_), part.groups, at);
  };
  if (quantity_.kind == Kind::kColour) {
    const std::size_t index = static_cast<std::size_t>(&part - parts_.data());
    const double other = grey_[index][channel];
    return difference(bounds(std::min(absorption, other), x),
                      bounds(std::max(absorption, other), x));
  }
  return bounds(absorption, x);
}

WalkBounds Contribution::walks_in_cells(YarnPart& part, std::size_t channel, const Interval& x) {
  // Cells of 2^-level: a box's range lies in a few, and boxes share them.
  constexpr int kFinest = 11;
  const double width = std::max(x.width(), 1e-9);
  const int level = std::clamp(static_cast<int>(std::ceil(-std::log2(width))) + 1, 1, kFinest);
  const double size = std::ldexp(1.0, -level);
  const auto last_cell = (std::uint32_t{1} << static_cast<unsigned>(level)) - 1;
  const auto cell_of = [&](double at) {
    return std::min(static_cast<std::uint32_t>(std::max(0.0, at) / size), last_cell);
  };
  const WalkBounds* first = nullptr;
  WalkBounds all;
  const std::uint32_t last = cell_of(x.high);
  for (std::uint32_t cell = cell_of(x.low); cell <= last; ++cell) {
    const std::uint32_t key = (last_cell + 1) | cell;  // level and cell
    auto [found, missing] = part.channels[channel].cells.try_emplace(key);
    if (missing) found->second = walks(part, channel, {cell * size, (cell + 1) * size});
    if (first == nullptr) {
      first = &found->second;
      all = *first;
      continue;
    }
    for (std::size_t g = 0; g < all.groups.size(); ++g)
      all.groups[g] = hull(all.groups[g], found->second.groups[g]);
    all.total = hull(all.total, found->second.total);
  }
  return all;
}

// Of one channel: the sum over yarns and lobes of weights times densities.
Interval Contribution::directional(std::size_t channel, const Interval& x) {
  const Weights& k = model_.material().weights;
  Interval sum;
  for (YarnPart& part : parts_) {
    const double share = part.yarn->share;
    if (has_surface_) {
      const double scale = share * k.specular;
      sum = sum + Interval{scale, scale} * (part.surface_weight * part.surface_density);
    }
    if (!has_walks_ || part.groups.empty()) continue;
    Interval walked;
    if (quantity_.kind == Kind::kFresnelAngle) {
      const double there = quantity_.cos_theta_d;
      const WalkBounds now = walks_in_cells(part, channel, x);
      const WalkBounds fixed = walks(part, channel, {there, there});
      for (std::size_t g = 0; g < part.groups.size(); ++g) {
        // Lobes of a group may gain and lose weight: their densities are one and how far from it.
        const double density = part.densities[g].middle();
        const double off =
            part.densities[g].width() / 2 * (now.groups[g].high + fixed.groups[g].high);
        walked = walked + (now.groups[g] - fixed.groups[g]) * Interval{density, density} +
                 Interval{-off, off};
      }
    } else {
      walked = sum_bounds(walks_in_cells(part, channel, x), part.densities);
    }
    const double scale = share * k.internal * part.channels[channel].sign;
    sum = sum + Interval{scale, scale} * walked;
  }
  return sum;
}

// Of one channel: f of the light without direction.
double Contribution::constant(std::size_t channel) const {
  const Material& material = model_.material();
  switch (quantity_.kind) {
    case Kind::kWhole:
    case Kind::kDiffuse: return model_.diffuse(channel);
    case Kind::kSmallerYarn: {
      const PreparedYarn<double>& yarn = *parts_.front().yarn;
      return diffuse_reflectance(material, {yarn.warp ? yarn.share : 0, yarn.warp ? 0 : yarn.share},
                                 channel);
    }
    case Kind::kColour: {
      Effects grey = model_.effects();
      grey.colour = false;
      return model_.diffuse(channel) - ClothModel<double>(material, grey).diffuse(channel);
    }
    default: return 0;
  }
}

Interval Contribution::operator()(const AngleBox& box, std::span<const double> radiance) {
  const bool paper = model_.material().reflectance == Reflectance::kPaper;
  const GeometryBounds g = paper ? paper_geometry_bounds(box) : geometry_bounds(box);
  Interval x = g.cos_theta_d;
  if (model_.effects().cos_theta_d)
    x = {*model_.effects().cos_theta_d, *model_.effects().cos_theta_d};
  const Interval& factor = quantity_.kind == Kind::kShadowing ? g.shadow
                           : model_.effects().shadowing       ? g.shadowed
                                                              : g.unshadowed;
  const bool lit = has_surface_ || has_walks_;
  for (YarnPart& part : parts_) {
    if (!lit) break;
    take_densities(part, g);
    if (has_surface_) part.surface_weight = surface_weight(part, x);
  }
  Interval largest;
  for (std::size_t c = 0; c < radiance.size(); ++c) {
    if (!(radiance[c] > 0)) continue;
    Interval value = Interval{constants_[c], constants_[c]} * g.cos_theta_i;
    if (lit) {
      const Interval sum = directional(c, x);
      // An unbounded factor times nothing is nothing.
      if (sum.high != 0 || sum.low != 0) value = value + product(factor, sum);
    }
    largest.low = std::max(largest.low, radiance[c] * value.least_magnitude());
    largest.high = std::max(largest.high, radiance[c] * value.magnitude());
  }
  return largest;
}

}  // namespace clothbrdf
