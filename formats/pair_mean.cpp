#include "formats/pair_mean.h"

namespace clothbrdf {

Rgb PairSum::operator()(const DirectionRule& light, const DirectionRule& eye) {
  pairs_.clear();
  for (const Vector3<double>& wi : light.directions) {
    for (const Vector3<double>& wo : eye.directions) pairs_.push_back({wi, wo});
  }
  values_.resize(pairs_.size() * std::tuple_size_v<Rgb>);
  producer_.fill_pairs(pairs_, values_);
  Rgb mean{};
  const double* value = values_.data();
  for (const double weight_i : light.weights) {
    for (const double weight_o : eye.weights) {
      for (double& channel : mean) channel += weight_i * weight_o * *value++;
    }
  }
  return mean;
}

}  // namespace clothbrdf
