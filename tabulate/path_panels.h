#pragma once

#include <functional>
#include <span>
#include <vector>

#include "model/reflectance.h"
#include "tabulate/path_matrix.h"
#include "tabulate/quadrature.h"

namespace clothbrdf {

/// A smooth map from [0, panels] to cos_theta_d; every unit of it is a panel.
using PanelCosine = std::function<double(double at)>;

/// Path weights in panels of cos_theta_d, each to be interpolated as a polynomial of its
/// kPolynomialNodes nodes: incidence cosine panel * kPolynomialNodes + node.
PathMatrix panel_paths(const ClothModel<double>& model, std::size_t panels,
                       const PanelCosine& cosine, Workers workers);

/// Whether sums over lobes interpolate in all those panels to a relative tolerance, tried between
/// the nodes and at half vectors near and far from the lobes' peaks.
bool panels_suffice(const ClothModel<double>& model, const PathMatrix& paths,
                    const PanelCosine& cosine, double tolerance, Workers workers);

/// Between the polynomial nodes, where interpolation errs most.
inline constexpr std::array<double, 3> kTestPoints = {0.005, 0.37, 0.86};

}  // namespace clothbrdf
