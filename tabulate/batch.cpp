#include "tabulate/batch.h"

#include <utility>

#include "tabulate/batch_kernel.h"
#include "tabulate/kernel.h"

namespace clothbrdf {
namespace {

// Shares of the tolerance. Together with what rounding adds, below what is promised.
constexpr double kLobeShare = 0.2;
template <class T>
constexpr double kTableShare = sizeof(T) == sizeof(float) ? 0.5 : 0.7;

}  // namespace

template <class T>
BatchEvaluator<T>::BatchEvaluator(const ClothModel<double>& model, std::vector<Channel> channels,
                                  Workers workers, double tolerance)
    : lanes_(model, std::move(channels), kLobeShare * tolerance) {
  if (lanes_.error() <= kLobeShare * tolerance)
    table_ = weight_table<T>(lanes_, kTableShare<T> * tolerance, workers);
  weft_.assign(table_.lanes, T(1));
  warp_.assign(table_.lanes, T(1));
  for (std::size_t l = 0; l < lanes_.size() && tabulated(); ++l) {
    weft_[l] = static_cast<T>(lanes_.weft()[l]);
    warp_[l] = static_cast<T>(lanes_.warp()[l]);
  }
  for (std::size_t c = 0; c < lanes_.channels().size(); ++c) {
    constants_.push_back(static_cast<T>(lanes_.constant(c)));
  }
}

template <class T>
void BatchEvaluator<T>::evaluate(const DirectionArrays<T>& directions,
                                 std::span<T* const> values) const {
  if (!tabulated()) return evaluate_directly(directions, values);
  const SinCos<double> turn = sincosd(lanes_.model().material().rotation_deg);
  const BatchPlan<T> plan = {
      .weft = weft_.data(),
      .warp = warp_.data(),
      .coefficients = table_.coefficients.data(),
      .lanes = table_.lanes,
      .channels = table_.channels,
      .piece_bits = table_.piece_bits,
      .turn_sin = static_cast<T>(turn.sin),
      .turn_cos = static_cast<T>(turn.cos),
      .microfacet = lanes_.model().material().reflectance == Reflectance::kMicrofacet,
      .constants = constants_.data()};
  const BatchTarget& target = batch_targets()[target_];
  if constexpr (sizeof(T) == sizeof(float)) {
    target.run_float(plan, directions, values.data());
  } else {
    target.run_double(plan, directions, values.data());
  }
}

template <class T>
void BatchEvaluator<T>::evaluate_directly(const DirectionArrays<T>& directions,
                                          std::span<T* const> values) const {
  const ClothModel<double>& model = lanes_.model();
  for (std::size_t p = 0; p < directions.count; ++p) {
    const auto vector = [&](const std::array<const T*, 3>& w) {
      return Vector3<double>{double{w[0][p]}, double{w[1][p]}, double{w[2][p]}};
    };
    const Components f = model.evaluate(
        pair_geometry(vector(directions.wi), vector(directions.wo), model.material().rotation_deg));
    for (std::size_t c = 0; c < lanes_.channels().size(); ++c) {
      values[c][p] = static_cast<T>(channel_value(f, lanes_.channels()[c]));
    }
  }
}

template <class T>
std::size_t BatchEvaluator<T>::multiply_adds() const {
  // Two for a lane's density; for each channel the polynomial and the sum.
  return table_.lanes * (2 + table_.channels * (kWeightDegree<T> + 1));
}

template class BatchEvaluator<float>;
template class BatchEvaluator<double>;

}  // namespace clothbrdf
