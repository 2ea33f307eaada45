#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tabulate/weight_table.h"

namespace clothbrdf {

/// Many pairs of unit vectors of the cloth frame, one array a coordinate, all of one length: wi to
/// the light, wo to the eye.
template <class T>
struct DirectionArrays {
  std::array<const T*, 3> wi;
  std::array<const T*, 3> wo;
  std::size_t count;
};

/// What a pair's sum over lanes is made of.
enum class BatchSum {
  kNone,     ///< no lanes: constants only
  kSurface,  ///< a few surface reflections, Fresnel's r of each pair
  kFixed,    ///< weights that are the same for all pairs
  kTable,    ///< weights from a table
};

/// One channel to write: a sum over lanes, and a constant.
template <class T>
struct BatchOutput {
  std::size_t sum;      ///< index of the sum
  std::size_t channel;  ///< index of values
  bool directional;     ///< false: the constant alone
  T constant;
};

/// What a BatchEvaluator promises unless it is asked for less.
template <class T>
inline constexpr double kBatchTolerance = sizeof(T) == sizeof(float) ? 5e-6 : 1e-12;

/// f_r (1/sr, without the cosine) at many arbitrary pairs of directions, near the machine's limit:
/// no exponential, power or path sum is left for a pair. In vector registers of any width, chosen
/// when the program runs. Effects that are off cost nothing: a cloth without light from inside
/// needs no table, one without lobes no half vector, and channels that are alike are summed once.
///
/// Error against the model, relative to the sum of a channel's directional and constant parts: the
/// tolerance (float 5e-6, double 1e-12), times max(1, condition number of the lobe): how much
/// h / axis magnifies the rounding of the directions themselves. 0 where a direction is on or below
/// the horizon. Pairs next to opposite (all of wi + wo below 2^-11) or next to the horizon (a z
/// below 2^-40 in float, 2^-300 in double) are evaluated by the model itself.
template <class T>
class BatchEvaluator {
 public:
  /// Prepares tables: some milliseconds for three channels. Keeps a reference to the model. A
  /// tolerance above the default, up to 0.1, needs fewer lanes (before they are padded) and pieces;
  /// one below it is not met.
  BatchEvaluator(const ClothModel<double>& model, std::vector<Channel> channels, Workers workers,
                 double tolerance = kBatchTolerance<T>);

  /// For tests and benchmarks: the kernel to use, an index of batch_targets().
  void choose_target(std::size_t target) { target_ = target; }

  /// values[channel][pair]. May be called from several threads at once; each pair's value has the
  /// same bits in any batch.
  void evaluate(const DirectionArrays<T>& directions, std::span<T* const> values) const;

  /// Multiply-adds of a pair, padding included: what a share of the machine's peak is counted in.
  std::size_t multiply_adds() const;

  /// False where the weights have no table (weight_table): pairs are then evaluated one by one.
  bool tabulated() const { return tabulated_; }

 private:
  void choose_sums();
  void prepare_lanes(Workers workers, double tolerance);
  void evaluate_hard(const DirectionArrays<T>& directions, std::span<T* const> values) const;
  void evaluate_directly(const DirectionArrays<T>& directions, std::size_t pair,
                         std::span<T* const> values) const;

  const ClothModel<double>& model_;
  std::vector<Channel> channels_;
  std::vector<Channel> summed_;  // of them, one of each different sum over lanes
  std::vector<BatchOutput<T>> outputs_;
  BatchSum kind_ = BatchSum::kTable;
  bool tabulated_ = true;
  std::size_t lane_count_ = 0;
  WeightTable<T> table_;
  AlignedVector<T> fixed_;      // weights that need no table
  AlignedVector<T> steepness_;  // of surfaces
  AlignedVector<T> weft_;       // padded
  AlignedVector<T> warp_;
  std::size_t target_ = 0;
};

}  // namespace clothbrdf
