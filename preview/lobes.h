#pragma once

#include "preview/cloth.h"
#include "support/image.h"

namespace clothbrdf {

/// A polar picture of f_r cos(theta_o), the light that leaves in each direction, in two planes that
/// hold the normal: above the one along the weft, below the one along the warp. The light comes
/// from the left, where a line shows it. Diffuse, internal and specular light lie one on the other
/// from the centre outward, in their colours (the last one white); the length is their luminance.
/// The outer ring stands for `lobe_scale`, the inner one for half of it.
struct LobesView {
  double light_theta_deg = 30;  ///< [0, 90)
  double turn_deg = 0;          ///< of the weave
  int size = 256;               ///< pixels along an edge
};
Image render_lobes(const Cloth& cloth, const LobesView& view);

/// What the outer ring stands for, 1/sr: the largest length in both planes, rounded up to 1, 2 or 5
/// times a power of ten.
double lobe_scale(const Cloth& cloth, const LobesView& view);

}  // namespace clothbrdf
