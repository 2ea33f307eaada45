#include "fit/parameter_set.h"

#include <algorithm>
#include <cmath>

#include "fit/fit.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr double kMostTurn = 360;

// Name, column, unit, range of the fit, range of scattered starts, offset of the logarithm.
struct ParameterRow {
  const char* name;
  LocalColumn column;
  const char* unit;
  double lowest, highest;
  double scatter_low, scatter_high;
  double log_offset;
};

constexpr ParameterRow kYarnRows[] = {
    {"lobe_axes.0", kAlong, "1", 1e-3, 1, 0.03, 0.9, 0},
    {"lobe_axes.1", kAcross, "1", 1e-3, 1, 0.03, 0.9, 0},
    {"refractive_index", kIndex, "1", 1.2, 2, 1.3, 1.8, -1},
    {"scatter", kScatter, "1", 0, 1, 0.01, 0.3, 0.01},
    {"absorption", kAbsorption, "1", 0, 20, 0.05, 1, 0.02},
};

constexpr ParameterRow kClothRows[] = {
    {"rotation_deg", kRotation, "deg", -kMostTurn, kMostTurn, -45, 45, -1},
    {"weights.specular", kSpecular, "1", 0, 100, 1, 1, 0.02},
    {"weights.internal", kInternal, "1", 0, 100, 1, 1, 0.02},
    {"weights.diffuse", kDiffuse, "1", 0, 100, 0.3, 0.3, 0.02},
    {"diffuse_path", kDiffusePath, "layers", 0, 100, 0.5, 4, 0.1},
    {"warp_fraction", kFraction, "1", 0, 1, 0.3, 0.7, -1},
};

FitParameter from_row(const ParameterRow& row) {
  FitParameter p;
  p.name = row.name;
  p.unit = row.unit;
  p.column = row.column;
  p.lowest = p.widest_low = row.lowest;
  p.highest = p.widest_high = row.highest;
  p.scatter_low = row.scatter_low;
  p.scatter_high = row.scatter_high;
  p.log_offset = row.log_offset;
  return p;
}

// Whether `wish` names the parameter: all of it, the start of it, or that without the yarn.
bool names(const std::string& wish, const std::string& parameter) {
  constexpr std::array<std::string_view, 2> kYarns = {"warp.", "weft."};
  const auto leads = [](const std::string& part, std::string_view whole) {
    return whole == part || (whole.starts_with(part) && whole[part.size()] == '.');
  };
  if (leads(wish, parameter)) return true;
  return std::any_of(kYarns.begin(), kYarns.end(), [&](std::string_view yarn) {
    return parameter.starts_with(yarn) &&
           leads(wish, std::string_view(parameter).substr(yarn.size()));
  });
}

[[noreturn]] void refuse(const std::string& name, double value, double lowest, double highest) {
  throw InputError(name + ": " + number_text(value) + " is not allowed: a number from " +
                   number_text(lowest) + " to " + number_text(highest));
}

// The range that a material file allows, wider than what is searched.
std::pair<double, double> hard_range(const FitParameter& p) {
  for (const ParameterInfo& info : kParameters) {
    std::string name(info.pointer.substr(1));
    std::replace(name.begin(), name.end(), '/', '.');
    std::string asked = p.of_yarn ? "warp" + p.name.substr(4) : p.name;
    if (p.column == kAbsorption) asked = "warp.absorption.0";
    if (name == asked) return {info.lowest, info.highest};
  }
  throw std::logic_error("no parameter " + p.name);
}

Material default_material(const std::vector<FitParameter>& parameters, std::size_t channels) {
  Material material;
  for (Yarn* yarn : {&material.warp, &material.weft}) yarn->absorption.resize(channels);
  for (const FitParameter& p : parameters) {
    set_parameter(
        material, p,
        p.to_value((p.to_coordinate(p.scatter_low) + p.to_coordinate(p.scatter_high)) / 2));
  }
  material.warp.layers = material.weft.layers = 3;
  return material;
}

}  // namespace

double FitParameter::to_coordinate(double value) const {
  return log_offset < 0 ? value : std::log(value + log_offset);
}

double FitParameter::to_value(double coordinate) const {
  const double value = log_offset < 0 ? coordinate : std::exp(coordinate) - log_offset;
  return std::clamp(value, lowest, highest);
}

double FitParameter::value_slope(double value) const {
  return log_offset < 0 ? 1 : value + log_offset;
}

std::vector<FitParameter> fit_parameters(std::size_t channels) {
  std::vector<FitParameter> all;
  for (const ParameterRow& row : kClothRows) all.push_back(from_row(row));
  for (const std::size_t yarn : {0U, 1U}) {
    const std::string prefix = yarn == 0 ? "warp." : "weft.";
    for (const ParameterRow& row : kYarnRows) {
      const bool many = row.column == kAbsorption;
      for (std::size_t c = 0; c < (many ? channels : 1); ++c) {
        FitParameter p = from_row(row);
        p.name = prefix + row.name + (many ? "." + std::to_string(c) : "");
        p.of_yarn = true;
        p.yarn = yarn;
        p.channel = c;
        all.push_back(p);
      }
    }
  }
  return all;
}

namespace {

template <class AnyMaterial>
auto& value_of(AnyMaterial& material, const FitParameter& p) {
  auto& yarn = p.yarn == 0 ? material.warp : material.weft;
  switch (p.column) {
    case kAlong: return yarn.lobe_axes[0];
    case kAcross: return yarn.lobe_axes[1];
    case kIndex: return yarn.refractive_index;
    case kScatter: return yarn.scatter;
    case kAbsorption: return yarn.absorption[p.channel];
    case kRotation: return material.rotation_deg;
    case kSpecular: return material.weights.specular;
    case kInternal: return material.weights.internal;
    case kDiffuse: return material.weights.diffuse;
    case kDiffusePath: return material.diffuse_path;
    default: return material.warp_fraction;
  }
}

}  // namespace

double parameter_value(const Material& material, const FitParameter& parameter) {
  return value_of(material, parameter);
}

void set_parameter(Material& material, const FitParameter& parameter, double value) {
  value_of(material, parameter) = value;
}

std::vector<std::string> parameter_names(std::size_t channels) {
  std::vector<std::string> result;
  for (const FitParameter& p : fit_parameters(channels)) result.push_back(p.name);
  return result;
}

void check_wishes(const FitOptions& options, std::size_t channels) {
  const ParameterSet set(options, channels, true);
}

ParameterSet::ParameterSet(const FitOptions& options, std::size_t channels, bool rotatable)
    : channels_(channels),
      parameters_(fit_parameters(channels)),
      states_(parameters_.size(), State::kFree),
      started_(parameters_.size(), false),
      defaults_(default_material(parameters_, channels)) {
  if (options.start) {
    if (options.start->channel_count() != channels) {
      throw InputError("start: a material of " + std::to_string(options.start->channel_count()) +
                       " channels; the table has " + std::to_string(channels));
    }
    defaults_ = *options.start;
    // The cloth looks the same turned by half a turn.
    defaults_.rotation_deg = std::remainder(defaults_.rotation_deg, 180);
    started_.assign(parameters_.size(), true);
    // A start beyond the usual bounds moves them out, as far as a material may go.
    for (FitParameter& p : parameters_) {
      const double value = parameter_value(defaults_, p);
      if (value < p.lowest) p.lowest = p.widest_low = hard_range(p).first;
      if (value > p.highest) p.highest = p.widest_high = hard_range(p).second;
    }
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i].column == kRotation && !rotatable) {
      states_[i] = State::kFixed;
      set_parameter(defaults_, parameters_[i], 0);
    }
  }
  for (const ParameterWish& wish : options.wishes) apply(wish);
  if (layers_tied_) tie_layers();
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const FitParameter& p = parameters_[i];
    const double value = parameter_value(defaults_, p);
    if (states_[i] == State::kFree) {
      set_parameter(defaults_, p, std::clamp(value, p.lowest, p.highest));
    }
  }
  index_free();
}

void ParameterSet::apply(const ParameterWish& wish) {
  using Kind = ParameterWish::Kind;
  bool found = false;
  for (const std::size_t yarn : {0U, 1U}) {
    if (!names(wish.name, yarn == 0 ? "warp.layers" : "weft.layers")) continue;
    found = true;
    if (wish.kind == Kind::kTie) {
      layers_tied_ = true;
      continue;
    }
    // "warp" stands for all of a yarn's parameters; a value then is none of the layers.
    const bool whole_yarn = !wish.name.ends_with("layers");
    int& layers = (yarn == 0 ? defaults_.warp : defaults_.weft).layers;
    if (wish.value && !whole_yarn) {
      if (!(*wish.value >= 0 && *wish.value <= 64 && *wish.value == std::floor(*wish.value))) {
        throw InputError(wish.name + ": " + number_text(*wish.value) +
                         " is not allowed: an integer from 0 to 64");
      }
      layers = static_cast<int>(*wish.value);
    }
    if (wish.kind == Kind::kFix) layers_fixed_[yarn] = true;
    if (wish.kind == Kind::kFree) {
      if (!whole_yarn && (wish.lowest || wish.highest)) {
        throw InputError(wish.name + ": the range of layer counts is asked for with --layers");
      }
      layers_fixed_[yarn] = false;
      layers_tied_ = false;
    }
    layers_started_[yarn] = layers_started_[yarn] || (wish.value && !whole_yarn);
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    FitParameter& p = parameters_[i];
    if (!names(wish.name, p.name)) continue;
    found = true;
    if (wish.kind == Kind::kTie) {
      if (!p.of_yarn) throw InputError(wish.name + ": only parameters of yarns can be tied");
      states_[p.yarn == 1 ? i : partner(i)] = State::kTied;
      continue;
    }
    const auto [lowest, highest] = hard_range(p);
    for (const std::optional<double>& v : {wish.value, wish.lowest, wish.highest}) {
      if (v && !(*v >= lowest && *v <= highest)) refuse(p.name, *v, lowest, highest);
    }
    if (wish.kind == Kind::kFree || wish.kind == Kind::kFix) {
      p.lowest = wish.lowest.value_or(p.widest_low);
      p.highest = wish.highest.value_or(p.widest_high);
    }
    if (!(p.lowest <= p.highest)) {
      throw InputError(p.name + ": bounds " + number_text(p.lowest) + " to " +
                       number_text(p.highest) + " hold no number");
    }
    p.scatter_low = std::clamp(p.scatter_low, p.lowest, p.highest);
    p.scatter_high = std::clamp(p.scatter_high, p.lowest, p.highest);
    if (wish.value) {
      set_parameter(defaults_, p, *wish.value);
      started_[i] = true;
    }
    if (wish.kind == Kind::kFix) {
      states_[i] = State::kFixed;
      const double at = parameter_value(defaults_, p);
      p.lowest = std::min(p.lowest, at);
      p.highest = std::max(p.highest, at);
    }
    if (wish.kind == Kind::kFree) states_[i] = State::kFree;
    if (wish.kind == Kind::kStart && wish.value &&
        (*wish.value < p.lowest || *wish.value > p.highest)) {
      refuse(p.name, *wish.value, p.lowest, p.highest);
    }
  }
  if (!found)
    throw InputError("'" + wish.name + "' is no parameter; known: layers, " + [&] {
      std::string known;
      for (const FitParameter& p : parameters_) known += (known.empty() ? "" : ", ") + p.name;
      return known;
    }());
}

void ParameterSet::tie_layers() {
  int& warp = defaults_.warp.layers;
  int& weft = defaults_.weft.layers;
  if (layers_fixed_[0] && layers_fixed_[1] && warp != weft) {
    throw InputError("layers: tied, but fixed at " + std::to_string(warp) + " and " +
                     std::to_string(weft));
  }
  if (layers_fixed_[1]) warp = weft;
  weft = warp;
  layers_fixed_[0] = layers_fixed_[1] = layers_fixed_[0] || layers_fixed_[1];
}

std::size_t ParameterSet::partner(std::size_t warp) const {
  const FitParameter& p = parameters_[warp];
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const FitParameter& weft = parameters_[i];
    if (weft.of_yarn && weft.yarn == 1 && weft.column == p.column && weft.channel == p.channel) {
      return i;
    }
  }
  throw std::logic_error("no weft of " + p.name);
}

void ParameterSet::index_free() {
  free_.clear();
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (states_[i] == State::kFree) free_.push_back(i);
  }
}

ParameterSet ParameterSet::with_fixed(std::size_t parameter) const {
  ParameterSet result = *this;
  result.states_[parameter] = State::kFixed;
  result.index_free();
  return result;
}

std::vector<double> ParameterSet::coordinates(const Material& material) const {
  std::vector<double> result;
  for (const std::size_t i : free_) {
    const FitParameter& p = parameters_[i];
    const double value = std::clamp(parameter_value(material, p), p.lowest, p.highest);
    result.push_back(p.to_coordinate(value));
  }
  return result;
}

double ParameterSet::lowest_coordinate(std::size_t free) const {
  const FitParameter& p = parameters_[free_[free]];
  return p.to_coordinate(p.lowest);
}

double ParameterSet::highest_coordinate(std::size_t free) const {
  const FitParameter& p = parameters_[free_[free]];
  return p.to_coordinate(p.highest);
}

Material ParameterSet::material(std::span<const double> coordinates, const Material& base) const {
  Material result = base;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const FitParameter& p = parameters_[free_[k]];
    set_parameter(result, p, p.to_value(coordinates[k]));
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (states_[i] != State::kTied) continue;
    FitParameter warp = parameters_[i];
    warp.yarn = 0;
    set_parameter(result, parameters_[i], parameter_value(result, warp));
  }
  return result;
}

std::vector<ParameterSet::Slope> ParameterSet::slopes(const Material& material,
                                                      std::size_t channel) const {
  std::vector<Slope> result;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const FitParameter& p = parameters_[free_[k]];
    if (p.column == kAbsorption && p.channel != channel) continue;
    const double scale = p.value_slope(parameter_value(material, p));
    result.push_back({k, p.column + (p.of_yarn ? p.yarn * kYarnColumns : 0), scale});
    if (!p.of_yarn || p.yarn != 0) continue;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const FitParameter& weft = parameters_[i];
      if (states_[i] == State::kTied && weft.yarn == 1 && weft.column == p.column &&
          weft.channel == p.channel) {
        result.push_back({k, p.column + kYarnColumns, scale});
      }
    }
  }
  return result;
}

}  // namespace clothbrdf
