#include "tabulate/batch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tabulate/batch_kernel.h"
#include "tabulate/kernel.h"

namespace clothbrdf {
namespace {

// Shares of the tolerance. Together with what rounding adds, below what is promised.
constexpr double kLobeShare = 0.2;
template <class T>
constexpr double kTableShare = sizeof(T) == sizeof(float) ? 0.5 : 0.7;

bool has_direction(const ClothModel<double>& model, const Channel& channel) {
  const bool surface = model.material().weights.specular != 0;
  const bool internal = std::any_of(model.yarns().begin(), model.yarns().end(),
                                    [](const auto& yarn) { return yarn.lobes.size() > 1; });
  switch (channel.part) {
    case Part::kTotal: return surface || internal;
    case Part::kSpecular: return surface;
    case Part::kInternal: return internal;
    case Part::kDiffuse: break;
  }
  return false;
}

// Whether two channels' sums over lanes are the same: the surface has no colour.
bool same_sum(const ClothModel<double>& model, const Channel& a, const Channel& b) {
  if (a.part != b.part) return false;
  return a.part == Part::kSpecular ||
         std::all_of(model.yarns().begin(), model.yarns().end(), [&](const auto& yarn) {
           return yarn.lobes.size() <= 1 ||
                  yarn.yarn.absorption[a.colour] == yarn.yarn.absorption[b.colour];
         });
}

}  // namespace

template <class T>
BatchEvaluator<T>::BatchEvaluator(const ClothModel<double>& model, std::vector<Channel> channels,
                                  Workers workers, double tolerance)
    : model_(model), channels_(std::move(channels)) {
  choose_sums();
  prepare_lanes(workers, tolerance);
}

template <class T>
void BatchEvaluator<T>::choose_sums() {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const auto constant = static_cast<T>(constant_part(model_, channels_[c]));
    if (!has_direction(model_, channels_[c])) {
      outputs_.push_back({0, c, false, constant});
      continue;
    }
    const auto same = std::find_if(summed_.begin(), summed_.end(), [&](const Channel& other) {
      return same_sum(model_, channels_[c], other);
    });
    outputs_.push_back({static_cast<std::size_t>(same - summed_.begin()), c, true, constant});
    if (same == summed_.end()) summed_.push_back(channels_[c]);
  }
  std::stable_sort(outputs_.begin(), outputs_.end(), [](const auto& a, const auto& b) {
    return std::pair(a.directional, a.sum) < std::pair(b.directional, b.sum);
  });
}

template <class T>
void BatchEvaluator<T>::prepare_lanes(Workers workers, double tolerance) {
  if (summed_.empty()) {
    kind_ = BatchSum::kNone;
    return;
  }
  const LobeLanes lanes(model_, summed_, kLobeShare * tolerance);
  tabulated_ = lanes.error() <= kLobeShare * tolerance;
  if (!tabulated_) return;
  lane_count_ = (lanes.size() + kLanePadding<T> - 1) / kLanePadding<T> * kLanePadding<T>;
  if (model_.effects().cos_theta_d) {
    kind_ = BatchSum::kFixed;
    std::vector<double> weights(lanes.size() * summed_.size());
    lanes.weights(*model_.effects().cos_theta_d, weights);
    fixed_.assign(lane_count_ * summed_.size(), T(0));
    for (std::size_t k = 0; k < weights.size(); ++k) {
      fixed_[k / lanes.size() * lane_count_ + k % lanes.size()] = static_cast<T>(weights[k]);
    }
  } else if (!lanes.has_internal()) {
    kind_ = BatchSum::kSurface;
    lane_count_ = lanes.size();
    for (const PreparedYarn<double>& yarn : model_.yarns()) {
      const double n = yarn.yarn.refractive_index;
      steepness_.push_back(static_cast<T>((n - 1) * (n + 1)));
      fixed_.push_back(
          static_cast<T>(model_.material().weights.specular * yarn.share / yarn.lobes[0].norm));
    }
  } else {
    table_ = weight_table<T>(lanes, kTableShare<T> * tolerance, workers);
    tabulated_ = table_.lanes > 0;
    lane_count_ = table_.lanes;
  }
  weft_.assign(lane_count_, T(1));
  warp_.assign(lane_count_, T(1));
  for (std::size_t l = 0; l < lanes.size() && tabulated_; ++l) {
    weft_[l] = static_cast<T>(lanes.weft()[l]);
    warp_[l] = static_cast<T>(lanes.warp()[l]);
  }
}

template <class T>
void BatchEvaluator<T>::evaluate(const DirectionArrays<T>& directions,
                                 std::span<T* const> values) const {
  if (!tabulated_) {
    for (std::size_t p = 0; p < directions.count; ++p) evaluate_directly(directions, p, values);
    return;
  }
  const SinCos<double> turn = sincosd(model_.material().rotation_deg);
  const BatchPlan<T> plan = {
      .kind = kind_,
      .mean = !model_.effects().anisotropy,
      .weft = weft_.data(),
      .warp = warp_.data(),
      .coefficients = kind_ == BatchSum::kTable ? table_.coefficients.data() : fixed_.data(),
      .steepness = steepness_.data(),
      .lanes = lane_count_,
      .sums = summed_.size(),
      .row_size = table_.row_size(),
      .piece_bits = table_.piece_bits,
      .turn_sin = static_cast<T>(turn.sin),
      .turn_cos = static_cast<T>(turn.cos),
      .microfacet = model_.material().reflectance == Reflectance::kMicrofacet,
      .shadowing = model_.effects().shadowing,
      .outputs = outputs_};
  const BatchTarget& target = batch_targets()[target_];
  bool hard = false;
  if constexpr (sizeof(T) == sizeof(float)) {
    hard = target.run_float(plan, directions, values.data());
  } else {
    hard = target.run_double(plan, directions, values.data());
  }
  if (hard) evaluate_hard(directions, values);
}

// The kernel's condition, in operations that round the same everywhere: a value's bits must not
// depend on the other pairs of the batch.
template <class T>
void BatchEvaluator<T>::evaluate_hard(const DirectionArrays<T>& directions,
                                      std::span<T* const> values) const {
  const auto& [wi, wo, count] = directions;
  for (std::size_t p = 0; p < count; ++p) {
    const T low = std::min(wi[2][p], wo[2][p]);
    if (!(low > T(0))) continue;
    const T largest = std::max(
        {std::abs(wi[0][p] + wo[0][p]), std::abs(wi[1][p] + wo[1][p]), wi[2][p] + wo[2][p]});
    if (low < kLeastHeight<T> || largest < kLeastSum<T>) evaluate_directly(directions, p, values);
  }
}

template <class T>
void BatchEvaluator<T>::evaluate_directly(const DirectionArrays<T>& directions, std::size_t pair,
                                          std::span<T* const> values) const {
  const auto vector = [&](const std::array<const T*, 3>& w) {
    return Vector3<double>{double{w[0][pair]}, double{w[1][pair]}, double{w[2][pair]}};
  };
  const Components f = model_.evaluate(
      pair_geometry(vector(directions.wi), vector(directions.wo), model_.material().rotation_deg));
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    values[c][pair] = static_cast<T>(channel_value(f, channels_[c]));
  }
}

template <class T>
std::size_t BatchEvaluator<T>::multiply_adds() const {
  // Two for a lane's density; for each sum the polynomial and the sum.
  const std::size_t powers = kind_ == BatchSum::kTable ? kWeightDegree<T> + 1 : 1;
  return lane_count_ * (2 + summed_.size() * powers);
}

template class BatchEvaluator<float>;
template class BatchEvaluator<double>;

}  // namespace clothbrdf
