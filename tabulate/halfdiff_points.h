#pragma once

#include "model/reflectance.h"
#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// f_r at the nodes of half/difference grids, by the separable structure: a small matrix product
/// for each half vector, no evaluation of the model for each cell.
class HalfDifferencePoints final : public Kernel {
 public:
  HalfDifferencePoints(const TableSpec& spec, const ClothModel<double>& model, Workers workers);
  void fill_rows(std::size_t first_row, std::span<double> values) const override;

 private:
  void fill_row(std::size_t row, std::span<double> values) const;

  const TableSpec& spec_;
  const ClothModel<double>& model_;
  std::vector<SinCos<double>> theta_d_;
  std::vector<double> cos_phi_d_;
  bool folded_;  // phi_d stops at 180 degrees: both orders of the directions share a cell
  PathMatrix paths_;
};

}  // namespace clothbrdf
