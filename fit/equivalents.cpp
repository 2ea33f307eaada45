#include "fit/equivalents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "fit/misfit.h"
#include "fit/uncertainty.h"

namespace clothbrdf {
namespace {

struct Exchange {
  const char* words;
  void (*make)(Material&);
};

// What can be exchanged without leaving the model; turns apart.
constexpr Exchange kExchanges[] = {
    {"the warp's lobe axes exchanged",
     [](Material& m) { std::swap(m.warp.lobe_axes[0], m.warp.lobe_axes[1]); }},
    {"the weft's lobe axes exchanged",
     [](Material& m) { std::swap(m.weft.lobe_axes[0], m.weft.lobe_axes[1]); }},
    {"shares exchanged", [](Material& m) { m.warp_fraction = 1 - m.warp_fraction; }},
    {"lobe axes exchanged between the yarns",
     [](Material& m) {
       std::swap(m.warp.lobe_axes, m.weft.lobe_axes);
       std::swap(m.warp.scatter_limit, m.weft.scatter_limit);
     }},
    {"absorption exchanged between the yarns",
     [](Material& m) { std::swap(m.warp.absorption, m.weft.absorption); }},
    {"refractive indices exchanged between the yarns",
     [](Material& m) { std::swap(m.warp.refractive_index, m.weft.refractive_index); }},
    {"scatter exchanged between the yarns",
     [](Material& m) { std::swap(m.warp.scatter, m.weft.scatter); }},
    {"layer counts exchanged between the yarns",
     [](Material& m) { std::swap(m.warp.layers, m.weft.layers); }},
};
constexpr unsigned kExchangeCount = std::size(kExchanges);
constexpr unsigned kShares = 1U << 2U;
constexpr unsigned kWholeYarns = 0xF8 | kShares;  // all that belongs to a yarn, and its share
constexpr int kTurnSteps = 12;  // of half a turn: the cloth looks the same after that

double into_half_turn(double degrees) {  // (-90, 90]
  const double turned = std::remainder(degrees, 180);
  return turned <= -90 ? turned + 180 : turned;
}

std::string words_of(unsigned exchanges, double turn_deg) {
  std::string words;
  const auto add = [&](const std::string& more) { words += (words.empty() ? "" : ", ") + more; };
  if ((exchanges & kWholeYarns) == kWholeYarns) {
    add("the yarns exchanged");
    exchanges &= ~kWholeYarns;
  }
  for (unsigned k = 0; k < kExchangeCount; ++k) {
    if (exchanges >> k & 1U) add(kExchanges[k].words);
  }
  if (turn_deg != 0) add("turned by " + std::to_string(static_cast<int>(turn_deg)) + " degrees");
  return words;
}

// All sets of exchanges, those of whole yarns before those of some of their parameters: of several
// ways to one material the plainest is named.
std::vector<unsigned> exchange_sets() {
  std::vector<unsigned> sets;
  for (unsigned set = 0; set < 1U << kExchangeCount; ++set) sets.push_back(set);
  std::stable_partition(sets.begin(), sets.end(), [](unsigned set) {
    return (set & kWholeYarns) == 0 || (set & kWholeYarns) == kWholeYarns;
  });
  return sets;
}

bool same_table(const ModelValues& a, const ModelValues& b) {
  constexpr double kRounding = 1e-9;
  double largest = 0;
  for (const double value : a.site) largest = std::max(largest, value);
  for (const double value : a.diffuse) largest = std::max(largest, value);
  const auto same = [&](const std::vector<double>& x, const std::vector<double>& y) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (!(std::abs(x[k] - y[k]) <= kRounding * (std::abs(x[k]) + 1e-6 * largest))) return false;
    }
    return true;
  };
  return same(a.diffuse, b.diffuse) && same(a.site, b.site);
}

// A fit's rounding apart: what same_table() would not see.
bool same_material(const Material& a, const Material& b, const ParameterSet& set) {
  constexpr double kRounding = 1e-8;
  for (const FitParameter& p : set.parameters()) {
    const double x = parameter_value(a, p);
    const double y = parameter_value(b, p);
    const double turn = p.column == kRotation ? std::remainder(x - y, 180) : x - y;
    if (!(std::abs(turn) <= kRounding * (std::abs(x) + 1))) return false;
  }
  return a.warp.layers == b.warp.layers && a.weft.layers == b.weft.layers;
}

// Whether the set's fixed values, ties and bounds allow the other material.
bool allowed(const Material& from, const Material& to, const ParameterSet& set) {
  for (std::size_t i = 0; i < set.parameters().size(); ++i) {
    const FitParameter& p = set.parameters()[i];
    const double value = parameter_value(to, p);
    if (set.state(i) == ParameterSet::State::kFixed && value != parameter_value(from, p)) {
      return false;
    }
    if (set.state(i) == ParameterSet::State::kFree && (value < p.lowest || value > p.highest)) {
      return false;
    }
  }
  // Ties hold of the warp and the weft.
  for (std::size_t i = 0; i < set.parameters().size(); ++i) {
    if (set.state(i) != ParameterSet::State::kTied) continue;
    FitParameter warp = set.parameters()[i];
    warp.yarn = 0;
    if (parameter_value(to, warp) != parameter_value(to, set.parameters()[i])) return false;
  }
  if (set.layers_tied() && to.warp.layers != to.weft.layers) return false;
  return !(set.layers_fixed(0) && from.warp.layers != to.warp.layers) &&
         !(set.layers_fixed(1) && from.weft.layers != to.weft.layers);
}

}  // namespace

Material Relabelling::apply(const Material& material) const {
  Material result = material;
  for (unsigned k = 0; k < kExchangeCount; ++k) {
    if (exchanges >> k & 1U) kExchanges[k].make(result);
  }
  result.rotation_deg = into_half_turn(result.rotation_deg + turn_deg);
  return result;
}

std::vector<Relabelling> find_equivalents(const Observations& places, const Material& material,
                                          const ParameterSet& set) {
  // One place settles most candidates.
  Observations first = thinned(places, 1, 1);
  const ModelValues here = model_values(places, material, kExact, 1);
  const ModelValues here_first = model_values(first, material, kExact, 1);
  std::vector<Relabelling> result = {{"as it is", 0, 0}};
  std::vector<Material> materials = {material};
  for (const unsigned exchanges : exchange_sets()) {
    for (int step = 0; step < kTurnSteps; ++step) {
      const double turn_deg = into_half_turn(step * (180.0 / kTurnSteps));
      const Relabelling candidate = {words_of(exchanges, turn_deg), exchanges, turn_deg};
      const Material other = candidate.apply(material);
      if (!allowed(material, other, set)) continue;
      if (std::any_of(materials.begin(), materials.end(),
                      [&](const Material& known) { return same_material(known, other, set); })) {
        continue;
      }
      if (!same_table(here_first, model_values(first, other, kExact, 1))) continue;
      if (!same_table(here, model_values(places, other, kExact, 1))) continue;
      result.push_back(candidate);
      materials.push_back(other);
    }
  }
  return result;
}

double distance(const Material& a, const Material& b, const ParameterSet& set) {
  double sum = 0;
  for (const FitParameter& p : set.parameters()) {
    const double value = parameter_value(a, p);
    const double step = parameter_value(b, p) - value;
    const double change =
        (p.column == kRotation ? std::remainder(step, 180) : step) / unit_of_change(p, value);
    sum += std::min(change * change, 1.0);
  }
  return sum + std::abs(a.warp.layers - b.warp.layers) + std::abs(a.weft.layers - b.weft.layers);
}

Material nearest(const std::vector<Relabelling>& equivalents, const Material& material,
                 const Material& target, const ParameterSet& set) {
  Material best = material;
  double least = distance(target, material, set);
  for (const Relabelling& relabelling : equivalents) {
    const Material other = relabelling.apply(material);
    if (!allowed(material, other, set)) continue;
    if (const double d = distance(target, other, set); d < least) {
      least = d;
      best = other;
    }
  }
  return best;
}

Relabelling canonical(const std::vector<Relabelling>& equivalents, const Material& material,
                      bool with_phi_h) {
  // Smaller is better.
  const auto rank = [&](const Relabelling& relabelling) {
    const Material m = relabelling.apply(material);
    const double rotation = into_half_turn(m.rotation_deg);
    const bool turned = with_phi_h && !(rotation > -45 && rotation <= 45);
    const auto crossed = [](const Yarn& yarn) { return yarn.lobe_axes[0] > yarn.lobe_axes[1]; };
    constexpr double kEqualShares = 1e-6;
    const bool equal = std::abs(m.warp_fraction - 0.5) <= kEqualShares;
    const bool warp_larger = equal || m.warp_fraction > 0.5;
    const int axes =
        with_phi_h ? crossed(warp_larger ? m.warp : m.weft) : crossed(m.warp) + crossed(m.weft);
    // Of equal shares without phi_h the narrower yarn is the warp: the same for every start.
    const double narrow =
        !with_phi_h && equal ? std::min(m.warp.lobe_axes[0], m.warp.lobe_axes[1]) : 0.0;
    return std::tuple(turned, axes, !with_phi_h && !warp_larger, narrow, relabelling.exchanges);
  };
  return *std::min_element(
      equivalents.begin(), equivalents.end(),
      [&](const Relabelling& a, const Relabelling& b) { return rank(a) < rank(b); });
}

}  // namespace clothbrdf
