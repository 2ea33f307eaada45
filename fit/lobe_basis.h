#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/material.h"
#include "model/scalar.h"

namespace clothbrdf {

/// A half vector, or an arc of them around the normal.
struct HalfVector {
  enum class Kind {
    kPoint,   ///< one direction
    kCircle,  ///< the mean over all azimuths
    kArc,     ///< the mean over azimuths from `from` to `to`, radians, at most pi apart
  };
  Kind kind = Kind::kPoint;
  double sin_theta = 0;
  double cos_theta = 1;
  double cos_phi = 1;  ///< of a point, in the frame of a weave that is not rotated
  double sin_phi = 0;
  double from = 0;
  double to = 0;
};

/// How a yarn's lobes are summed (model.md 8.3): sum_E W_E alpha_E / Z_E is close to
/// sum_j omega_j alpha_j / Z_j over a few nodes between the ellipse and the limiting circle. Where
/// the nodes lie is no function of the parameters: the sum changes with the scatter through
/// omega_j, with the axes through alpha_j and Z_j. Lane 0 is the surface reflection.
class LobeBasis {
 public:
  /// `tolerance`: about the largest relative error of the sum.
  LobeBasis(const Yarn& yarn, Paths paths, Reflectance reflectance, double tolerance);

  /// Lanes of densities, of weights.
  std::size_t lanes() const { return along_.size(); }

  /// Shares of the internal nodes for the lobe that has lost the given share of its directionality
  /// (s_E = 1 - q_E): values[lanes - 1], adding up to 1.
  void shares(double lost, std::span<double> values) const;

  /// shares' derivative by `lost`, at the nodes: d shares[j] / d lost at node i, times
  /// lost_slope(lost): derivative(lost)[j] = lost_slope(lost) * sum_i shares(lost)[i] *
  /// node_slopes()[i * (lanes - 1) + j].
  std::span<const double> node_slopes() const { return node_slopes_; }
  double lost_slope(double lost) const;

  enum Quantity { kValue, kByAlong, kByAcross, kByRotation, kQuantities };

  /// Densities alpha / Z at a half vector and their derivatives (rotation: per degree):
  /// values[quantity][lane], each quantity `stride` apart. Only values where `slopes` is false.
  void densities(const HalfVector& half, std::size_t yarn, double rotation_deg, bool slopes,
                 std::span<double> values, std::size_t stride) const;

 private:
  // A value with its derivatives by the two lobe axes.
  struct Dual {
    double value, by_along, by_across;
  };

  template <class Scalar>
  void fill(const HalfVector& half, std::size_t yarn, double rotation_deg, std::span<double> values,
            std::size_t stride) const;

  double growth_;                     // expm1(log of the limit over the narrow axis)
  double range_;                      // that logarithm
  std::vector<double> place_;         // of the internal nodes, shares of the logarithm
  std::vector<double> barycentric_;   // their weights
  std::vector<double> node_slopes_;   // [i][j]
  std::vector<Dual> along_, across_;  // axes of the lanes
  std::vector<Dual> inverse_norm_;    // 1 / Z
};

}  // namespace clothbrdf
