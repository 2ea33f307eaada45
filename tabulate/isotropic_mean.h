#pragma once

#include <span>
#include <vector>

#include "tabulate/lobe_lanes.h"
#include "tabulate/weight_table.h"

namespace clothbrdf {

/// The mean of f_r over rotations of the cloth at arbitrary pairs of directions, in closed form:
/// the sums of LobeLanes with the mean of each lane's density over the azimuth of the half vector.
class IsotropicMean {
 public:
  /// Prepares tables. Keeps a reference to the model.
  IsotropicMean(const ClothModel<double>& model, std::vector<Channel> channels, Workers workers);

  /// values[pair][channel]; 0 on or below the horizon. Relative error 1e-12, but for what the
  /// rounding of the directions adds. May be called from several threads at once.
  void fill(std::span<const Directions> pairs, std::span<double> values) const;

 private:
  void weights(double cos_theta_d, std::span<double> weights) const;

  LobeLanes lanes_;
  WeightTable<double> table_;
};

}  // namespace clothbrdf
