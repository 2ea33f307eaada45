#pragma once

#include <vector>

#include "preview/plot.h"
#include "table/grid.h"

namespace clothbrdf {

/// A run of cells along one angle of a grid, for a plot.
struct Slice {
  PlotTitle title;  ///< which angle runs, and where the others stand
  PlotAxis axis;
  std::vector<std::size_t> cells;
  std::vector<double> x;  ///< of each cell, on the axis
};

/// The five slices that show what a grid's table looks like; each at the nodes nearest to round
/// angles. Half/difference grids: theta_h at small theta_d (along and across the weft where there
/// is phi_h; else at growing theta_d), theta_h at larger theta_d, theta_d at the normal, phi_d.
/// In/out grids: the plane of incidence at two theta_i along and one across the weft, phi_o at two
/// pairs of theta. Plots run in the axis's own spacing, so that nodes lie at equal steps; the plane
/// of incidence runs in degrees.
std::vector<Slice> typical_slices(const Grid& grid);

/// An axis of a grid in its own spacing: the node of cell k is at k, the cell reaches half a step
/// to both sides. Numbers are at round angles.
PlotAxis angle_axis(const Axis& axis);

}  // namespace clothbrdf
