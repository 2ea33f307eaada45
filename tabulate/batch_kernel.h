#pragma once

#include <span>

#include "tabulate/batch.h"

namespace clothbrdf {

// Internal to the batch evaluator.

/// All that its inner loops need.
template <class T>
struct BatchPlan {
  BatchSum kind;
  bool mean;      ///< densities are means over the azimuth of the half vector
  const T* weft;  ///< [lane]
  const T* warp;
  const T* coefficients;  ///< as WeightTable; kFixed: [sum][lane]; kSurface: [lane]
  const T* steepness;     ///< kSurface: (n - 1) (n + 1) of the refractive index, [lane]
  std::size_t lanes;
  std::size_t sums;      ///< different sums over lanes
  std::size_t row_size;  ///< kTable: coefficients of a piece
  int piece_bits;
  T turn_sin;  ///< of the weave's rotation
  T turn_cos;
  bool microfacet;
  bool shadowing;
  std::span<const BatchOutput<T>> outputs;  ///< by sum
};

/// Hard pairs are those above the horizon of which every component of wi + wo is below kLeastSum,
/// or a z below kLeastHeight. Weights of a table are not good to their last digits there
/// (kLeastCosine), and products of three cosines are too small for T.
template <class T>
inline constexpr T kLeastSum = T(2 * kLeastCosine);
template <class T>
inline constexpr T kLeastHeight = sizeof(T) == sizeof(float) ? T(0x1p-40) : T(0x1p-300);

/// The kernels for one kind of vector registers. They return whether there was a hard pair, whose
/// values are for the plain formula to set right.
struct BatchTarget {
  const char* name;
  bool (*run_float)(const BatchPlan<float>&, const DirectionArrays<float>&, float* const* values);
  bool (*run_double)(const BatchPlan<double>&, const DirectionArrays<double>&,
                     double* const* values);
};

/// Those that this processor has, the fastest first: AVX2 before AVX-512, which was an eighth
/// slower where it was measured (Zen 5: docs/performance.md). (Highway's own dispatch would do, but
/// loading its library measures timers for 3 milliseconds, more than a table takes.)
std::span<const BatchTarget> batch_targets();

}  // namespace clothbrdf
