#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "formats/square.h"

namespace clothbrdf {

/// A value among ascending nodes: the node below it, and the share of the next one. Clamped at both
/// ends; with one node that counts alone.
struct Bracket {
  std::size_t lower;
  double upper_share;
};
Bracket bracket(std::span<const float> nodes, double at);

/// A sum of slices of a table of phi_i and theta_i, each with its weight: linear in both, no wrap.
struct SliceBlend {
  struct Share {
    std::size_t slice;
    double weight;
  };
  std::array<Share, 4> shares;
  std::size_t count = 0;  ///< of the shares that are not 0

  std::span<const Share> span() const { return std::span(shares).first(count); }
};
SliceBlend blend_slices(std::span<const float> phi_i, std::span<const float> theta_i, double phi,
                        double theta);
/// One slice by itself.
SliceBlend only_slice(std::size_t slice);

/// Densities on the unit square, bilinear between nodes that lie on its edges, and the map from the
/// square with even density to the square with this one, as the readers of RGL's files do it
/// (Marginal2D, PiecewiseLinear2D): u.y inverts the marginal of the rows, which is linear between
/// them, then u.x the density along the row blended there. Between slices densities and their
/// cumulative sums are blended, after each slice was scaled to the integral 1.
class Warp {
 public:
  /// densities[slice][row][column], finite and >= 0; at least 2 rows and 2 columns. A slice of
  /// zeros stays so.
  Warp(std::size_t rows, std::size_t columns, std::span<const float> densities);

  /// From even density to this one.
  RglPoint sample(RglPoint u, const SliceBlend& blend) const;
  /// Back again.
  RglPoint invert(RglPoint u_m, const SliceBlend& blend) const;
  /// At a point, in the measure of the square.
  double density(RglPoint u_m, const SliceBlend& blend) const;

 private:
  struct Patch;
  Patch patch(RglPoint point, const SliceBlend& blend) const;
  double blended(std::span<const double> of_slices, std::size_t per_slice, std::size_t at,
                 const SliceBlend& blend) const;

  std::size_t rows_;
  std::size_t columns_;
  std::vector<double> density_;   // [slice][row][column], in units of a patch
  std::vector<double> row_sums_;  // the same shape: sum along the row up to the column
  std::vector<double> marginal_;  // [slice][row]: sum over the rows up to it
};

/// Bilinear between values[row][column], whose nodes lie on the edges of the unit square.
double bilinear(std::span<const float> values, std::size_t rows, std::size_t columns, RglPoint at);

}  // namespace clothbrdf
