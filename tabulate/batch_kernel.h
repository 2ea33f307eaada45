#pragma once

#include "tabulate/batch.h"

namespace clothbrdf {

// Internal to the batch evaluator.

/// All that its inner loops need.
template <class T>
struct BatchPlan {
  const T* weft;  ///< [lane]
  const T* warp;
  const T* coefficients;  ///< as WeightTable
  std::size_t lanes;
  std::size_t channels;
  int piece_bits;
  T turn_sin;  ///< of the weave's rotation
  T turn_cos;
  bool microfacet;
  const T* constants;  ///< [channel]
};

void run_batch(const BatchPlan<float>& plan, const DirectionArrays<float>& directions,
               float* const* values);
void run_batch(const BatchPlan<double>& plan, const DirectionArrays<double>& directions,
               double* const* values);

}  // namespace clothbrdf
