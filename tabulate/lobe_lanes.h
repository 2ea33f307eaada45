#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/reflectance.h"
#include "table/table_spec.h"
#include "tabulate/few_lobes.h"

namespace clothbrdf {

/// A cloth as sums over few lanes, the form that batches are evaluated in:
///
///     f = factor * h_n * sum_l weight(channel, l; cos_theta_d) / (weft_l h_weft^2 + warp_l
///     h_warp^2 + h_n^2)
///         + constant(channel)
///
/// Each yarn has one lane for its surface reflection (none where k_s is 0) and one for each of its
/// few_lobes (none without layers). Shares, norms, k_s and k_i are in the weights. Keeps a
/// reference to the model.
class LobeLanes {
 public:
  LobeLanes(const ClothModel<double>& model, std::vector<Channel> channels, double tolerance);

  std::size_t size() const { return weft_.size(); }
  const std::vector<Channel>& channels() const { return channels_; }
  const ClothModel<double>& model() const { return model_; }

  /// 1 / axis^2 of each lane, for the half vector's components along weft and warp.
  std::span<const double> weft() const { return weft_; }
  std::span<const double> warp() const { return warp_; }

  /// [channel][lane] at an incidence cosine in [0, 1], or slightly above.
  void weights(double cos_theta_d, std::span<double> weights) const;

  /// Whether lanes of surface reflections are there, and any others.
  bool has_surface() const { return model_.material().weights.specular != 0; }
  bool has_internal() const;

  /// Of a channel: the light without direction.
  double constant(std::size_t channel) const;

  /// Largest relative error of a density that stems from having few lobes.
  double error() const;

 private:
  void put(std::size_t yarn, Part part, std::span<const double> few, double* to) const;
  void scale_copy(std::span<double> weights, std::size_t count) const;

  const ClothModel<double>& model_;
  std::vector<Channel> channels_;
  std::vector<FewLobes> few_;  // of each yarn
  std::vector<double> weft_;
  std::vector<double> warp_;
};

/// The light without direction in a channel.
double constant_part(const ClothModel<double>& model, const Channel& channel);

}  // namespace clothbrdf
