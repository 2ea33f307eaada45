#pragma once

#include <optional>

#include "model/reflectance.h"
#include "tabulate/batch.h"
#include "tabulate/cubature.h"
#include "tabulate/kernel.h"

namespace clothbrdf {

/// Means of f_r over the cells of in/out grids by the measure dwi dwo, to the relative tolerance of
/// the spec in each cell: adaptive cubature in all four angles, through the batch evaluator.
/// Microfacet convention only.
class InOutAverage final : public Kernel {
 public:
  InOutAverage(const TableSpec& spec, const ClothModel<double>& model, Workers workers);
  void fill_row(std::size_t row, std::span<const ColumnRange> columns,
                std::span<double> values) const override;

 private:
  struct Workspace;
  std::vector<double> cell_means(std::size_t cell, Workspace& work) const;
  void weighted(std::span<const Point4> points, Workspace& work, std::span<double> values) const;
  std::optional<std::size_t> coarse_variable(const Box4& part) const;

  const TableSpec& spec_;
  Workers workers_;
  double narrowest_axis_;
  BatchEvaluator<double> evaluator_;
};

}  // namespace clothbrdf
