#include "fit/remedies.h"

#include <algorithm>
#include <cmath>

#include "fit/misfit.h"
#include "fit/noisy_values.h"
#include "fit/uncertainty.h"

namespace clothbrdf {
namespace {

std::vector<bool> settled(const TableSpec& spec, const Material& whole, const FitOptions& given,
                          double noise, Workers workers) {
  FitOptions options = given;
  const Material material = without_effects(spec, whole, options);
  const ParameterSet set = identified_set(spec, material, options);
  const Observations observations = observe(spec, material.reflectance, workers);
  const ModelValues model = model_values(observations, material, kExact, workers);
  const std::vector<unsigned char> all;
  const ValueSource source =
      measured_values(observations, spec, all, model, options.weighting, 0, 0);
  const Rows rows = make_rows(observations, source, {options.weighting, Loss::kSquared, 0}, &model,
                              true, workers);
  const Misfit misfit(observations, rows, kExact, workers);
  const Uncertainty found = uncertainty(misfit.triangle(material, set), set, material, noise);
  std::vector<bool> result(set.parameters().size(), false);
  for (std::size_t k = 0; k < set.free().size(); ++k) {
    const FitParameter& p = set.parameters()[set.free()[k]];
    result[set.free()[k]] = verdict_of(p, parameter_value(material, p), found.standard_errors[k]) ==
                            Verdict::kIdentifiable;
  }
  return result;
}

}  // namespace

Material without_effects(const TableSpec& spec, const Material& material, FitOptions& options) {
  const Effects& effects = spec.provenance.effects;
  const auto fix = [&](const std::string& name) {
    options.wishes.push_back({ParameterWish::Kind::kFix, name, {}, {}, {}});
  };
  if (!effects.specular) fix("weights.specular");
  if (!effects.diffuse) fix("weights.diffuse");
  if (!effects.internal) {
    fix("weights.internal");
    fix("layers");
  }
  return apply_effects(material, effects);
}

bool has_phi_h(const TableSpec& spec) { return !spec.isotropic(); }

bool lies_at_bound(const ParameterSet& set, std::size_t parameter, const Material& material) {
  const FitParameter& p = set.parameters()[parameter];
  const double value = parameter_value(material, p);
  constexpr double kNear = 1e-9;
  return value <= p.lowest + kNear * std::abs(p.lowest) || value >= p.highest - kNear * p.highest;
}

ParameterSet asked_set(const TableSpec& spec, const Material& material, const FitOptions& options) {
  FitOptions at_truth = options;
  at_truth.start = material;
  return ParameterSet(at_truth, material.channel_count(), has_phi_h(spec));
}

ParameterSet identified_set(const TableSpec& spec, const Material& material,
                            const FitOptions& options) {
  ParameterSet set = asked_set(spec, material, options);
  const std::vector<std::size_t> free = set.free();
  for (const std::size_t i : free) {
    if (lies_at_bound(set, i, material)) set = set.with_fixed(i);
  }
  return set;
}

std::vector<Remedy> try_remedies(const TableSpec& spec, const Material& material,
                                 const FitOptions& options, double noise, Workers workers) {
  std::vector<Remedy> remedies;
  const auto add = [&](const std::string& words, const TableSpec& other, const FitOptions& known,
                       double less_noise) {
    workers.check();
    remedies.push_back({words, settled(other, material, known, less_noise, workers)});
  };
  if (!has_phi_h(spec)) {
    TableSpec with_phi_h = spec;
    with_phi_h.samples = halfdiff4d(24, 18, 24, 24);
    with_phi_h.cells = {};
    add("a table with phi_h, as " + with_phi_h.grid().description(), with_phi_h, options, noise);
  }
  if (spec.provenance.effects != Effects{}) {
    TableSpec whole = spec;
    whole.provenance.effects = {};
    add("a table with all components", whole, options, noise);
  }
  constexpr double kLessNoise = 10;
  add("a tenth of the noise", spec, options, noise / kLessNoise);
  const auto given = [&](const std::string& name, const std::string& words) {
    FitOptions known = options;
    known.wishes.push_back({ParameterWish::Kind::kFix, name, {}, {}, {}});
    add(words, spec, known, noise);
  };
  given("refractive_index", "the refractive indices, from elsewhere");
  given("warp_fraction", "the warp's share of the surface, from a picture of the weave");
  given("weights", "the weights of the components, from a measurement of each");
  FitOptions tied = options;
  tied.wishes.push_back({ParameterWish::Kind::kTie, "weft", {}, {}, {}});
  if (material.warp == material.weft && !has_phi_h(spec)) {
    tied.wishes.push_back({ParameterWish::Kind::kFix, "warp_fraction", {}, {}, {}});
    add("knowing that both yarns are equal", spec, tied, noise);
  }
  return remedies;
}

}  // namespace clothbrdf
