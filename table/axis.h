#pragma once

#include <optional>
#include <string>

namespace clothbrdf {

/// How the cells of an axis lie between its two ends.
enum class Spacing {
  kUniform,  ///< equal cells, value at the middle
  kSquared,  ///< cell k from (k/n)^2 to ((k+1)/n)^2 of the highest end, value at mid-index; as
             ///< MERL's theta_h
  kNodes,    ///< value at k/n of the range, cells reach half a step to both sides (not below the
             ///< lowest end)
};

/// One angle of a grid. All angles in degrees, taken as exact.
struct Axis {
  std::string name;  ///< theta_h, phi_h, theta_d, phi_d, theta_i, phi_i, theta_o or phi_o
  Spacing spacing = Spacing::kUniform;
  int size = 0;
  double lowest_deg = 0;
  double highest_deg = 0;
  bool periodic = false;  ///< the highest end is the lowest one again

  /// Where the value of cell k = 0..size-1 is taken.
  double node_deg(int k) const;

  /// Lower end of cell k = 0..size; edge k + 1 is the upper one. Below the lowest end for the first
  /// of periodic nodes.
  double edge_deg(int k) const;

  /// The cell that holds an angle; none outside the axis. A periodic axis takes any finite angle.
  std::optional<int> cell_of(double angle_deg) const;

  /// The inverse of node_deg, continued between the nodes: k at the node of cell k. Not wrapped,
  /// not limited.
  double coordinate(double angle_deg) const;

  bool operator==(const Axis&) const = default;
};

}  // namespace clothbrdf
