#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fit/lobe_basis.h"
#include "model/material.h"
#include "support/progress.h"

namespace clothbrdf {

/// The weights omega_j of a LobeBasis for one yarn at many incidence cosines, with derivatives.
/// k_s and k_i are not in. Lane 0 is the surface reflection's.
class PathBasis {
 public:
  enum Quantity { kValue, kByAbsorption, kByIndex, kByScatter, kQuantities };

  /// Of more cosines than this, weights are interpolated between IncidenceNodes.
  static constexpr std::size_t kMostComputed = 250;

  /// Walks end early once what is left changes no sum by more than `tolerance`, relative.
  PathBasis(const Yarn& yarn, Paths paths, const LobeBasis& lobes,
            std::span<const double> cos_theta_d, double tolerance, bool slopes, Workers workers);

  /// [quantity][lane] of incidence cosine x and a channel, quantities stride() apart; only values
  /// where no slopes were asked for.
  const double* at(std::size_t x, std::size_t channel) const {
    return weights_.data() + (x * channels_ + channel) * quantities_ * stride_;
  }
  std::size_t stride() const { return stride_; }

 private:
  std::size_t channels_;
  std::size_t quantities_;
  std::size_t stride_;
  std::vector<double> weights_;
};

/// Room for so many lanes: those after the first in whole vector registers, the rest zero.
inline std::size_t padded(std::size_t lanes) { return 1 + (lanes + 6) / 8 * 8; }

}  // namespace clothbrdf
