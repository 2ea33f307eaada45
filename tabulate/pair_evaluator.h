#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tabulate/batch.h"
#include "tabulate/isotropic_mean.h"
#include "tabulate/kernel.h"

namespace clothbrdf {

/// f_r of a cloth at many pairs of unit vectors, or its means over rotations of the cloth.
class PairEvaluator {
 public:
  /// Prepares tables. Keeps a reference to the model.
  PairEvaluator(const TableSpec& spec, const ClothModel<double>& model, Precision precision,
                Workers workers);

  /// values[pair][channel]; 0 on or below the horizon. May be called from several threads at once.
  void fill(std::span<const Directions> pairs, std::span<double> values) const;

 private:
  std::size_t channels_;
  std::optional<BatchEvaluator<float>> single_;
  std::optional<BatchEvaluator<double>> double_;
  std::optional<IsotropicMean> mean_;
};

}  // namespace clothbrdf
