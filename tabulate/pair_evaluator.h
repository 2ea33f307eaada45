#pragma once

#include <span>
#include <vector>

#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// f_r at pairs of directions whose path weights are known: those of the incidence cosines of a
/// PathMatrix. Keeps references to model and paths; one object a thread.
class PairEvaluator {
 public:
  PairEvaluator(const ClothModel<double>& model, const PathMatrix& paths);

  /// One value for each channel, at a pair above the horizon whose cos_theta_d is the one of
  /// `index`.
  void evaluate(const PairGeometry<double>& pair, std::size_t index,
                std::span<const Channel> channels, std::span<double> values);

 private:
  const ClothModel<double>& model_;
  const PathMatrix& paths_;
  std::vector<double> density_;
  ChannelSums sums_;
};

}  // namespace clothbrdf
