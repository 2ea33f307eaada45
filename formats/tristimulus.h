#pragma once

#include "formats/pair_mean.h"

namespace clothbrdf {

// Internal to formats/.

/// CIE tristimulus values of a reflectance under D65, each relative to that of the perfect white:
/// R = G = B = 1 has X = Y = Z = 1. So WINDOW defines its integrals (sum of f, illuminant and
/// observer's curve over the sum of illuminant and curve), and Radiance, whose white is the equal
/// energy point, shows a grey as grey.
struct Tristimulus {
  double x = 0;  ///< X
  double y = 0;  ///< Y, the luminance
  double z = 0;  ///< Z
};

/// From linear R, G, B with the primaries of Rec. 709.
Tristimulus to_tristimulus(const Rgb& rgb);
/// Its inverse, to about 1e-15 of the largest of R, G and B.
Rgb to_rgb(const Tristimulus& xyz);

}  // namespace clothbrdf
