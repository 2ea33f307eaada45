#pragma once

#include <memory>
#include <vector>

#include "model/reflectance.h"
#include "tabulate/kernel.h"
#include "tabulate/path_matrix.h"

namespace clothbrdf {

/// Means of f_r over the cells of half/difference grids, over the part above the horizon, by the
/// measure dwi dwo
/// (= 4 cos theta_d dwh dwd), to the relative tolerance of the spec in each cell; 0 for a cell
/// below the horizon. Microfacet convention only.
///
/// phi_d and phi_h are integrated in closed form (FactorArc, lobe_azimuthal_mean). The sums over
/// lobes are smooth in theta_h and theta_d: they are interpolated from a few nodes, in panels
/// narrow enough for a tenth of the tolerance. What is left is a double integral whose limits
/// follow the horizon (cell_integral.h).
class HalfDifferenceAverage final : public Kernel {
 public:
  HalfDifferenceAverage(const TableSpec& spec, const ClothModel<double>& model, Workers workers);
  void fill_row(std::size_t row, std::span<const ColumnRange> columns,
                std::span<double> values) const override;

 private:
  // The directional part of all channels over a piece of a row's theta_h cell and all theta_d
  // panels, at polynomial nodes: values[panel of theta_d][channel][node of theta_d][node of
  // theta_h].
  struct Panel {
    double low;
    double high;
    std::vector<double> values;
  };

  double tolerance() const;
  std::vector<double> densities(double theta_h, std::size_t row) const;
  ChannelSums sums_at(double theta_h, std::size_t row) const;
  Panel make_panel(std::size_t row, double low, double high) const;
  bool interpolates(const Panel& panel, std::size_t row) const;
  std::vector<Panel> make_panels(std::size_t row) const;

  const TableSpec& spec_;
  const ClothModel<double>& model_;
  Workers workers_;
  const Axis& theta_h_axis_;
  const Axis& theta_d_axis_;
  const Axis& phi_d_axis_;
  std::size_t panels_per_cell_ = 1;          // of theta_d
  std::unique_ptr<const PathMatrix> paths_;  // at the polynomial nodes of all theta_d panels
};

}  // namespace clothbrdf
