#pragma once

#include <optional>
#include <string>
#include <vector>

namespace clothbrdf {

/// How the cells of an axis lie between its two ends.
enum class Spacing {
  kUniform,  ///< equal cells, value at the middle
  kSquared,  ///< cell k from (k/n)^2 to ((k+1)/n)^2 of the highest end, value at mid-index; as
             ///< MERL's theta_h
  kNodes,    ///< value at k/n of the range, cells reach half a step to both sides (not below the
             ///< lowest end)
  kListed,   ///< values at the nodes listed, cells meet halfway between them
};

/// One angle of a grid. All angles in degrees, taken as exact.
struct Axis {
  std::string name;  ///< theta_h, phi_h, theta_d, phi_d, theta_i, phi_i, theta_o or phi_o
  Spacing spacing = Spacing::kUniform;
  int size = 0;
  double lowest_deg = 0;
  double highest_deg = 0;
  bool periodic = false;  ///< the highest end is the lowest one again
  bool mirrored = false;  ///< what lies beyond an end is the mirror image of what lies before it
  std::vector<double> listed_deg = {};  ///< of kListed: ascending, within the ends; else empty

  /// Where the value of cell k = 0..size-1 is taken.
  double node_deg(int k) const;

  /// Lower end of cell k = 0..size; edge k + 1 is the upper one. Below the lowest end for the first
  /// of periodic nodes.
  double edge_deg(int k) const;

  /// After how many degrees an axis repeats itself; 0 for one that does not.
  double period_deg() const;

  /// The angle of the axis that stands for any angle: the same one unless the axis is periodic or
  /// mirrored.
  double folded_deg(double angle_deg) const;

  /// The cell that holds an angle; none outside the axis. A periodic or mirrored axis takes any
  /// finite angle.
  std::optional<int> cell_of(double angle_deg) const;

  /// The inverse of node_deg, continued between the nodes, linearly between listed ones: k at the
  /// node of cell k. Mirrored axes fold the angle first; else not wrapped, not limited.
  double coordinate(double angle_deg) const;

  bool operator==(const Axis&) const = default;
};

}  // namespace clothbrdf
