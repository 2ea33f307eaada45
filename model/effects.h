#pragma once

#include <string_view>

#include "model/material.h"

namespace clothbrdf {

/// The parts of the model that can be left out.
struct Effects {
  bool specular = true;
  bool internal = true;
  bool diffuse = true;

  bool operator==(const Effects&) const = default;
};

/// An effect and its name in options and files.
struct EffectName {
  std::string_view name;
  bool Effects::*member;
};
inline constexpr EffectName kEffectNames[] = {{"specular", &Effects::specular},
                                              {"internal", &Effects::internal},
                                              {"diffuse", &Effects::diffuse}};

/// The same cloth without the effects that are off. What is left costs no more than a cloth that
/// never had them.
template <class T>
BasicMaterial<T> apply_effects(BasicMaterial<T> material, const Effects& effects) {
  if (!effects.specular) material.weights.specular = T(0);
  if (!effects.diffuse) material.weights.diffuse = T(0);
  if (!effects.internal) {
    material.warp.layers = 0;
    material.weft.layers = 0;
  }
  return material;
}

}  // namespace clothbrdf
