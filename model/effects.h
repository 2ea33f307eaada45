#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/layers.h"
#include "model/material.h"

namespace clothbrdf {

/// The parts of the model that can be left out, each on its own. What is off costs nothing: its
/// code does not run.
struct Effects {
  bool specular = true;         ///< off: no surface reflection
  bool internal = true;         ///< off: no light from inside the yarns
  bool diffuse = true;          ///< off: no light without direction
  bool near_side = true;        ///< off: no reflections at the near side of a deeper layer
  bool interreflection = true;  ///< off: no paths of three and more reflections
  bool scatter = true;          ///< off: scatter 0
  bool colour = true;           ///< off: absorption of every channel is the mean over channels
  bool second_yarn = true;  ///< off: without the yarn of the smaller share (the weft where equal);
                            ///< the other one is not rescaled
  bool anisotropy = true;   ///< off: the mean over the azimuth of the half vector
  bool shadowing = true;    ///< off: G = 1 (adds light; unbounded at grazing incidence)
  std::optional<int> layers = {};  ///< internal:N, layers beyond are left out, [0, 64]
  std::optional<int> events = {};  ///< interreflection:E, paths of more events are, [1, 1025]
  std::optional<double> cos_theta_d = {};  ///< no-fresnel_angle=X: stands for cos theta_d in the
                                           ///< Fresnel terms and path lengths, [0, 1]

  bool operator==(const Effects&) const = default;
};

/// The three parts that f_r is the sum of.
inline constexpr std::pair<std::string_view, bool Effects::*> kComponentEffects[] = {
    {"specular", &Effects::specular},
    {"internal", &Effects::internal},
    {"diffuse", &Effects::diffuse}};

/// What is off only where "no-NAME" says so.
inline constexpr std::pair<std::string_view, bool Effects::*> kOtherEffects[] = {
    {"near_side", &Effects::near_side},     {"interreflection", &Effects::interreflection},
    {"scatter", &Effects::scatter},         {"colour", &Effects::colour},
    {"second_yarn", &Effects::second_yarn}, {"anisotropy", &Effects::anisotropy},
    {"shadowing", &Effects::shadowing}};

/// The words that stand for effects, as options and files have them: "specular", "internal:4",
/// "no-scatter", "no-fresnel_angle=0.8". All components that are on are named; none else that is.
std::vector<std::string> effect_words(const Effects& effects);

/// Those of the words that stand for more than which components are on: "internal:4", "no-scatter".
std::vector<std::string> shortcut_words(const Effects& effects);

/// Effects from words. Components (specular, internal[:N], diffuse): naming any turns the unnamed
/// ones off. All else is on unless written no-NAME. On failure none, and `problem` says what is
/// wrong and what is allowed.
std::optional<Effects> effects_from_words(const std::vector<std::string>& words,
                                          std::string& problem);

/// The same cloth without the effects that a material can do without: what is left costs no more
/// than a cloth that never had them. Internal light of weight 0 has no layers.
template <class T>
BasicMaterial<T> apply_effects(BasicMaterial<T> material, const Effects& effects) {
  if (!effects.specular) material.weights.specular = T(0);
  if (!effects.diffuse) material.weights.diffuse = T(0);
  const bool internal =
      effects.internal && (kCarriesDerivative<T> || material.weights.internal != T(0));
  for (BasicYarn<T>* yarn : {&material.warp, &material.weft}) {
    yarn->layers = internal ? std::min(yarn->layers, effects.layers.value_or(kMaxLayers)) : 0;
    if (!effects.scatter) yarn->scatter = T(0);
    const auto& colours = yarn->absorption;
    const bool grey =
        !kCarriesDerivative<T> && std::equal(colours.begin() + 1, colours.end(), colours.begin());
    if (!effects.colour && !grey) {
      T sum = T(0);
      for (const T& absorption : yarn->absorption) sum += absorption;
      const T mean = sum / T(static_cast<double>(yarn->absorption.size()));
      std::fill(yarn->absorption.begin(), yarn->absorption.end(), mean);
    }
  }
  return material;
}

/// The walks that count for a yarn of so many layers. Near sides of deeper layers need a second
/// one.
inline PathSet path_set(Paths paths, const Effects& effects, int layers) {
  if (paths == Paths::kSingle) return paths;
  int most = effects.interreflection ? effects.events.value_or(PathSet::kAnyEvents) : 0;
  if (most < kFewestInterreflectionEvents) most = 0;
  return {effects.near_side || layers <= 1, most};
}

}  // namespace clothbrdf
