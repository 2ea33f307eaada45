#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace clothbrdf {

/// Incidence cosines at which path weights are computed, to be interpolated at many others: the
/// weights are smooth, but change fastest at grazing incidence, so nodes are Chebyshev's in each
/// octave of cos_theta_d + 2^-8 (model.md section 8.2).
class IncidenceNodes {
 public:
  static constexpr std::size_t kOrder = 20;  ///< nodes of an octave

  /// Of the octaves that hold the cosines, which lie in [0, 1].
  explicit IncidenceNodes(std::span<const double> cos_theta_d);

  /// Where the weights are needed; no more than 180.
  std::span<const double> nodes() const { return nodes_; }

  /// Interpolation in an octave: sum over k of weights[k] times the value at nodes()[first + k].
  struct Place {
    std::size_t first;
    std::array<double, kOrder> weights;
  };
  Place place(double cos_theta_d) const;

 private:
  int first_octave_ = 0;
  std::vector<double> nodes_;
};

}  // namespace clothbrdf
