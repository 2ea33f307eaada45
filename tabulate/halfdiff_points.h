#pragma once

#include "model/reflectance.h"
#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// f_r at the nodes of half/difference grids, by the separable structure: a small matrix product
/// for each half vector, no evaluation of the model for each cell. `all` holds the columns that any
/// row is asked for.
class HalfDifferencePoints final : public Kernel {
 public:
  HalfDifferencePoints(const TableSpec& spec, const ClothModel<double>& model, ColumnRange all,
                       Workers workers);
  void fill_row(std::size_t row, std::span<const ColumnRange> columns,
                std::span<double> values) const override;

 private:
  const TableSpec& spec_;
  const ClothModel<double>& model_;
  std::vector<SinCos<double>> theta_d_;
  std::vector<double> cos_phi_d_;
  bool folded_;  // phi_d stops at 180 degrees: both orders of the directions share a cell
  std::size_t first_theta_d_;  // that paths_ is made of
  PathMatrix paths_;
};

}  // namespace clothbrdf
