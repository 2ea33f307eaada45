#include "tabulate/halfdiff_points.h"

#include "tabulate/vectorise.h"

namespace clothbrdf {
namespace {

std::vector<SinCos<double>> node_sincos(const Axis& axis) {
  std::vector<SinCos<double>> nodes;
  nodes.reserve(static_cast<std::size_t>(axis.size));
  for (int k = 0; k < axis.size; ++k) nodes.push_back(sincosd(axis.node_deg(k)));
  return nodes;
}

std::vector<double> cosines(const std::vector<SinCos<double>>& angles) {
  std::vector<double> result;
  result.reserve(angles.size());
  for (const SinCos<double>& angle : angles) result.push_back(angle.cos);
  return result;
}

// The directional factor along phi_d and, in `above`, 1 above the horizon and 0 elsewhere.
CLOTHBRDF_VECTORISE void fill_factors(Reflectance reflectance, bool shadowing, bool folded,
                                      SinCos<double> theta_h, SinCos<double> theta_d,
                                      const double* cos_phi_d, std::size_t count, double* factor,
                                      double* above) {
  for (std::size_t k = 0; k < count; ++k) {
    const IncidenceCosines<double> c = incidence_cosines(theta_h, theta_d, cos_phi_d[k]);
    double f = directional_factor(reflectance, theta_h.cos, theta_d.cos, c.i, c.o, shadowing);
    if (reflectance == Reflectance::kPaper && folded) {
      f = (f + directional_factor(reflectance, theta_h.cos, theta_d.cos, c.o, c.i)) / 2;
    }
    const bool visible = c.i > 0 && c.o > 0;
    factor[k] = visible ? f : 0;
    above[k] = visible ? 1 : 0;
  }
}

CLOTHBRDF_VECTORISE void fill_values(const double* factor, const double* above, std::size_t count,
                                     double directional, double constant, double* values) {
  for (std::size_t k = 0; k < count; ++k) values[k] = factor[k] * directional + above[k] * constant;
}

}  // namespace

HalfDifferencePoints::HalfDifferencePoints(const TableSpec& spec, const ClothModel<double>& model,
                                           Workers workers)
    : spec_(spec),
      model_(model),
      theta_d_(node_sincos(spec.grid().axes[spec.grid().axes.size() - 2])),
      cos_phi_d_(cosines(node_sincos(spec.grid().axes.back()))),
      folded_(spec.grid().folds_orders()),
      paths_(model, cosines(theta_d_), workers) {}

void HalfDifferencePoints::fill_rows(std::size_t first_row, std::span<double> values) const {
  for (std::size_t at = 0; at < values.size(); at += spec_.row_values()) {
    fill_row(first_row++, values.subspan(at, spec_.row_values()));
  }
}

void HalfDifferencePoints::fill_row(std::size_t row, std::span<double> values) const {
  const std::vector<Axis>& axes = spec_.grid().axes;
  std::vector<double> density(paths_.lobe_count());
  SinCos<double> theta_h;
  if (spec_.grid().kind == GridKind::kHalfDifference3d) {
    theta_h = sincosd(axes[0].node_deg(static_cast<int>(row)));
    paths_.mean_densities(theta_h, density);
  } else {
    const auto phi_count = static_cast<std::size_t>(axes[1].size);
    theta_h = sincosd(axes[0].node_deg(static_cast<int>(row / phi_count)));
    const SinCos<double> phi_h = sincosd(two_difference(
        axes[1].node_deg(static_cast<int>(row % phi_count)), model_.material().rotation_deg));
    paths_.densities(theta_h.sin * phi_h.cos, theta_h.sin * phi_h.sin, theta_h.cos, density);
  }
  ChannelSums sums(model_, theta_d_.size());
  paths_.sums(density, 0, sums.specular(), sums.internal());

  const std::size_t count = cos_phi_d_.size();
  std::vector<double> factor(count);
  std::vector<double> above(count);
  for (std::size_t d = 0; d < theta_d_.size(); ++d) {
    fill_factors(model_.material().reflectance, model_.effects().shadowing, folded_, theta_h,
                 theta_d_[d], cos_phi_d_.data(), count, factor.data(), above.data());
    for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
      const Channel& channel = spec_.channels[c];
      fill_values(factor.data(), above.data(), count, sums.directional(channel, d),
                  sums.constant(channel), values.data() + (c * theta_d_.size() + d) * count);
    }
  }
}

}  // namespace clothbrdf
