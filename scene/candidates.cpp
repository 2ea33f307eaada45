#include "scene/candidates.h"

#include <algorithm>
#include <cmath>

#include "model/parameters.h"

namespace clothbrdf {
namespace {

using Kind = Quantity::Kind;

// The yarns that a cloth shows.
std::vector<const Yarn*> shown(const Material& material) {
  std::vector<const Yarn*> yarns;
  if (material.warp_fraction > 0) yarns.push_back(&material.warp);
  if (material.warp_fraction < 1) yarns.push_back(&material.weft);
  return yarns;
}

template <class Property>
int largest(const Material& material, const Property& property) {
  int most = 0;
  for (const Yarn* yarn : shown(material)) most = std::max(most, property(*yarn));
  return most;
}

bool grey(const Material& material) {
  const std::vector<const Yarn*> yarns = shown(material);
  return std::all_of(yarns.begin(), yarns.end(), [](const Yarn* yarn) {
    const auto& a = yarn->absorption;
    return std::equal(a.begin() + 1, a.end(), a.begin());
  });
}

// Layer counts to try: all of a few, then ever fewer.
std::vector<int> layer_counts(int layers) {
  std::vector<int> counts;
  for (int n = 0; n < layers; n += std::max(1, n / 6)) counts.push_back(n);
  return counts;
}

std::string layers_text(int kept, int layers) {
  if (kept == 0) return "all light from inside the yarns";
  if (kept + 1 == layers) return "layer " + std::to_string(layers);
  return "layers " + std::to_string(kept + 1) + " to " + std::to_string(layers);
}

}  // namespace

std::vector<std::vector<Candidate>> candidates(const Material& whole, double mean_cosine) {
  const Material material = apply_effects(whole, {});
  const bool both = shown(material).size() == 2;
  const bool warp_smaller = material.warp_fraction < 1 - material.warp_fraction;
  const int layers = largest(material, [](const Yarn& yarn) { return yarn.layers; });
  const bool walks = layers > 0 && material.paths == Paths::kAll;
  const bool scatters = layers > 0 && largest(material, [](const Yarn& yarn) {
                                        return yarn.scatter > 0 ? 1 : 0;
                                      }) > 0;
  const bool lobes = layers > 0 || material.weights.specular > 0;
  const bool microfacet = material.reflectance == Reflectance::kMicrofacet;

  std::vector<std::vector<Candidate>> all;
  const auto add = [&](Candidate candidate) { all.push_back({std::move(candidate)}); };
  add({"second_yarn",
       warp_smaller ? "the warp yarn" : "the weft yarn",
       {Kind::kSmallerYarn},
       both});
  add({"diffuse", "light without direction", {Kind::kDiffuse}, material.weights.diffuse > 0});
  add({"specular", "the surface reflection", {Kind::kSpecular}, material.weights.specular > 0});
  std::vector<Candidate> counts;
  for (const int kept : layer_counts(layers)) {
    counts.push_back({kept == 0 ? "internal" : "internal:" + std::to_string(kept),
                      layers_text(kept, layers),
                      {Kind::kLayers, kept},
                      true});
  }
  if (counts.empty()) counts.push_back({"internal", layers_text(0, 0), {Kind::kLayers}, false});
  all.push_back(std::move(counts));
  std::vector<Candidate> reflections = {
      {"interreflection", "paths of three and more reflections", {Kind::kInterreflection}, walks}};
  for (const int kept : {9, 21}) {
    if (!walks) break;
    reflections.push_back({"interreflection:" + std::to_string(kept),
                           "interreflections of more than " + std::to_string(kept) + " events",
                           {Kind::kInterreflection, kept},
                           true});
  }
  all.push_back(std::move(reflections));
  add({"near_side",
       "reflections at the near sides of deeper layers",
       {Kind::kNearSide},
       walks && layers > 1});
  add({"scatter", "lobes that widen from event to event", {Kind::kScatter}, scatters});
  add({"colour", "channels other than their mean", {Kind::kColour}, !grey(material)});
  add({"fresnel_angle",
       "Fresnel terms and path lengths at other angles than " + number_text(mean_cosine),
       {Kind::kFresnelAngle, 0, mean_cosine},
       lobes});
  add({"anisotropy", "the axis phi_h: the mean over it instead", {Kind::kAnisotropy}, true});
  add({"shadowing", "shadowing of facets by one another", {Kind::kShadowing}, lobes && microfacet});
  return all;
}

void leave_out(Effects& effects, const Candidate& candidate) {
  const Quantity& q = candidate.quantity;
  switch (q.kind) {
    case Kind::kWhole: break;
    case Kind::kSpecular: effects.specular = false; break;
    case Kind::kDiffuse: effects.diffuse = false; break;
    case Kind::kSmallerYarn: effects.second_yarn = false; break;
    case Kind::kLayers:
      if (q.kept == 0) {
        effects.internal = false;
      } else {
        effects.layers = q.kept;
      }
      break;
    case Kind::kInterreflection:
      if (q.kept == 0) {
        effects.interreflection = false;
      } else {
        effects.events = q.kept;
      }
      break;
    case Kind::kNearSide: effects.near_side = false; break;
    case Kind::kScatter: effects.scatter = false; break;
    case Kind::kColour: effects.colour = false; break;
    case Kind::kFresnelAngle: effects.cos_theta_d = q.cos_theta_d; break;
    case Kind::kAnisotropy: effects.anisotropy = false; break;
    case Kind::kShadowing: effects.shadowing = false; break;
  }
}

double evaluation_cost(const Material& whole, const Effects& effects) {
  const Material material = apply_effects(whole, effects);
  std::vector<const Yarn*> yarns = shown(material);
  if (yarns.size() == 2 && !effects.second_yarn) {
    yarns = {material.warp_fraction < 1 - material.warp_fraction ? &material.weft : &material.warp};
  }
  if (yarns.size() == 2 && !effects.anisotropy && material.warp == material.weft) yarns.pop_back();
  // A few lobes stand for all of a yarn that scatters (model.md, section 8.3).
  constexpr double kFewLobes = 7;
  double lanes = 0;
  double walking = 0;
  for (const Yarn* yarn : yarns) {
    if (yarn->layers == 0) continue;
    const PathSet paths = path_set(material.paths, effects, yarn->layers);
    const auto lobes = static_cast<double>(lobe_count(*yarn, paths) - 1);
    lanes += std::min(lobes, kFewLobes);
    const double events = paths.most_events > 0 ? 2 * lobes : 0;
    walking += yarn->layers * (1 + (paths.near_sides ? 1 : 0) + events);
  }
  const double surfaces = material.weights.specular > 0 ? static_cast<double>(yarns.size()) : 0;
  const auto channels = static_cast<double>(material.channel_count());
  if (lanes + surfaces == 0) return channels;
  const double mean = effects.anisotropy ? 0 : 1;
  const double geometry = 9 + 2 * channels;
  if (lanes == 0) return geometry + surfaces * (4 + mean);
  const double sums = grey(material) ? 1 : channels;
  const double powers = effects.cos_theta_d ? 1 : 5;
  constexpr double kLanesOfRegister = 8;
  const double registers = std::ceil((lanes + surfaces) / kLanesOfRegister);
  constexpr double kOfPathSums = 1e-4;  // path sums are made once for many pairs
  return geometry + 6 + 3 * sums + registers * (4 + 3 * mean + sums * powers) +
         (effects.shadowing ? 0.5 : 0) + kOfPathSums * walking * sums;
}

}  // namespace clothbrdf
