#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "table/grid.h"

namespace clothbrdf {

// Internal to formats/.

/// One way in which ALTA files name a pair of directions (#PARAM_IN). V is the eye, L the light, H
/// the half vector, D the difference vector (of V around H), K the back vector; T theta, P phi.
/// Angles in radians.
///
/// Where ALTA's two conversions, to vectors and from them, disagree, the one from vectors counts,
/// together with what ALTA's documentation says of the coordinates; that concerns STARK_*,
/// NEUMANN_*, STEREOGRAPHIC, RETRO_* and the back vectors. Signs of an azimuth difference do not
/// matter to isotropic tables and are not told apart.
struct AltaParametrisation {
  std::string_view name;
  std::size_t dimension;     ///< coordinates of a pair
  bool isotropic;            ///< they do not tell how the cloth is turned
  std::string_view assumed;  ///< for people: what of the pair they leave open; empty: nothing
  /// None where the coordinates, all finite, stand for no pair.
  std::optional<DirectionPair> (*pair)(std::span<const double> coordinates);
};

/// Throws InputError that starts with `name`, the file's, for parametrisations that are unknown or
/// not defined well enough to be read.
const AltaParametrisation& alta_parametrisation(std::string_view wanted, const std::string& name);

}  // namespace clothbrdf
