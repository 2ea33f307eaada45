#pragma once

#include <cstddef>
#include <vector>

namespace clothbrdf {

/// A range of angles, degrees: all from `low` to `high`, both included; one angle where they are
/// equal.
struct AngleRange {
  double low = 0;
  double high = 0;

  bool operator==(const AngleRange&) const = default;
};

/// Directions away from the cloth, in degrees of its frame: theta from the normal, 0 <= low <= high
/// <= 90; phi counter-clockwise from x, low <= high <= low + 360.
struct DirectionRange {
  AngleRange theta_deg;
  AngleRange phi_deg;

  bool operator==(const DirectionRange&) const = default;
};

/// Pairs of directions that a scene can produce: light from any of `lights` to any of `eyes`, with
/// the cloth turned counter-clockwise (seen from the normal) by any of `rotations_deg`: in its own
/// frame the directions' azimuths are less by that angle.
struct Reach {
  std::vector<DirectionRange> lights;
  std::vector<DirectionRange> eyes;
  std::vector<double> rotations_deg = {0};

  std::size_t combinations() const { return lights.size() * eyes.size() * rotations_deg.size(); }

  bool operator==(const Reach&) const = default;
};

/// Most combinations of a light, an eye and a rotation.
inline constexpr std::size_t kMostCombinations = 10000;

}  // namespace clothbrdf
