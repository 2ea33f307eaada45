#pragma once

#include "model/reflectance.h"
#include "scene/lit_boxes.h"

namespace clothbrdf {

/// The largest f_r cos(theta_i) radiance of a cloth over its lit boxes and channels.
struct Brightest {
  double reached = 0;  ///< at a pair of the scene
  double at_most = 0;  ///< proven
};

/// Branch and bound leads to the places where it can be; from there a search climbs to the value
/// that is reached. at_most is within 0.1 % of it where most_boxes of the search suffice.
Brightest brightest(const ClothModel<double>& model, const LitBoxes& scene, const Workers& workers);

}  // namespace clothbrdf
