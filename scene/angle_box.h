#pragma once

#include <array>
#include <utility>

#include "model/directions.h"
#include "table/interval.h"

namespace clothbrdf {

/// Pairs of directions in the frame of the weave, radians: theta_i, phi_i, theta_o, phi_o, each in
/// a range.
struct AngleBox {
  std::array<Interval, 4> angles;

  /// The two halves along a dimension.
  std::pair<AngleBox, AngleBox> halves(std::size_t dimension) const;
};

/// What f_r depends on, over a box of half/difference geometry that holds all pairs of an AngleBox.
struct GeometryBounds {
  Interval cos_theta_i;
  Interval cos_theta_o;
  Interval cos_theta_d;
  /// Slopes of the half vector, h_weft / h_n and h_warp / h_n, and the sum of their squares.
  Interval slope_weft;
  Interval slope_warp;
  Interval slope2;
  /// directional_factor cos(theta_i) / h_n: what a lobe's height per h_n is multiplied by to be
  /// f_r cos(theta_i); with V-cavity shadowing, without (G = 1), and the second less the first.
  Interval shadowed;
  Interval unshadowed;
  Interval shadow;
};

/// The bounds shrink to the point's values as the box shrinks to a point. Infinite where the box
/// touches pairs at grazing incidence for which f_r has no bound.
GeometryBounds geometry_bounds(const AngleBox& box);

/// The same for the paper's convention, in which nothing is shadowed.
GeometryBounds paper_geometry_bounds(const AngleBox& box);

}  // namespace clothbrdf
