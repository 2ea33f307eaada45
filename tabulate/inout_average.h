#pragma once

#include <memory>
#include <optional>

#include "model/reflectance.h"
#include "tabulate/cubature.h"
#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// Means of f_r over the cells of in/out grids by the measure dwi dwo, to the relative tolerance of
/// the spec in each cell. Microfacet convention only. Path weights are interpolated in cos_theta_d
/// to a tenth of the tolerance; the rest is adaptive cubature in all four angles, which takes
/// minutes for large grids of narrow lobes.
class InOutAverage final : public Kernel {
 public:
  InOutAverage(const TableSpec& spec, const ClothModel<double>& model, Workers workers);
  void fill_rows(std::size_t first_row, std::span<double> values) const override;

 private:
  struct Workspace;
  void directional(const std::array<double, 4>& at, Workspace& work,
                   std::span<double> values) const;

  std::optional<std::size_t> coarse_variable(const Box4& part) const;

  const TableSpec& spec_;
  const ClothModel<double>& model_;
  Workers workers_;
  double narrowest_axis_ = 1;
  std::size_t panels_ = 16;
  std::unique_ptr<const PathMatrix> paths_;
};

}  // namespace clothbrdf
