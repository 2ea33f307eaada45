#include "tabulate/pair_evaluator.h"

namespace clothbrdf {

PairEvaluator::PairEvaluator(const ClothModel<double>& model, const PathMatrix& paths)
    : model_(model), paths_(paths), density_(paths.lobe_count()), sums_(model, 1) {}

void PairEvaluator::evaluate(const PairGeometry<double>& pair, std::size_t index,
                             std::span<const Channel> channels, std::span<double> values) {
  const double factor = directional_factor(model_.material().reflectance, pair.h_n,
                                           pair.cos_theta_d, pair.cos_theta_i, pair.cos_theta_o);
  paths_.densities(pair.h_weft, pair.h_warp, pair.h_n, density_);
  paths_.sums(density_, index, sums_.specular(), sums_.internal());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    values[c] = factor * sums_.directional(channels[c], 0) + sums_.constant(channels[c]);
  }
}

}  // namespace clothbrdf
