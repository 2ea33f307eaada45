#pragma once

#include <cstddef>
#include <vector>

#include "scene/maximum.h"
#include "scene/scene.h"

namespace clothbrdf {

/// The directions of a scene in the frame of one cloth's weave: a box for each light, eye and
/// rotation.
class LitBoxes {
 public:
  LitBoxes(const Scene& scene, const Material& material);
  LitBoxes(const LitBoxes&) = delete;
  LitBoxes& operator=(const LitBoxes&) = delete;

  const std::vector<LitBox>& boxes() const { return boxes_; }

 private:
  std::vector<std::vector<double>> radiance_;  // [light][channel], which boxes_ look into
  std::vector<LitBox> boxes_;
};

/// A pair of a box in the frame of the weave, degrees, at shares (0 to 1) of its ranges.
DirectionPair pair_in(const AngleBox& box, const std::array<double, 4>& shares);

}  // namespace clothbrdf
