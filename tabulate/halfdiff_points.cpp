#include "tabulate/halfdiff_points.h"

#include <algorithm>

#include "tabulate/vectorise.h"

namespace clothbrdf {
namespace {

std::vector<SinCos<double>> node_sincos(const Axis& axis) {
  std::vector<SinCos<double>> nodes;
  nodes.reserve(static_cast<std::size_t>(axis.size));
  for (int k = 0; k < axis.size; ++k) nodes.push_back(sincosd(axis.node_deg(k)));
  return nodes;
}

// Of rows of `size` columns those that hold a range of columns.
std::vector<SinCos<double>> rows_of(const std::vector<SinCos<double>>& rows,
                                    const ColumnRange& columns, std::size_t size) {
  const auto row = [&](std::size_t column) {
    return rows.begin() + static_cast<std::ptrdiff_t>(column / size);
  };
  return {row(columns.begin),
          columns.end > columns.begin ? row(columns.end - 1) + 1 : row(columns.begin)};
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
    IncidenceCosines<double> c = incidence_cosines(theta_h, theta_d, cos_phi_d[k]);
    const bool visible = c.i > 0 && c.o > 0;
    // What is not seen is computed, too, but divides nothing by 0.
    c.i = visible ? c.i : 1;
    c.o = visible ? c.o : 1;
    double f = directional_factor(reflectance, theta_h.cos, theta_d.cos, c.i, c.o, shadowing);
    if (reflectance == Reflectance::kPaper && folded) {
      f = (f + directional_factor(reflectance, theta_h.cos, theta_d.cos, c.o, c.i)) / 2;
    }
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
                                           ColumnRange all, Workers workers)
    : spec_(spec),
      model_(model),
      theta_d_(node_sincos(spec.grid().axes[spec.grid().axes.size() - 2])),
      cos_phi_d_(cosines(node_sincos(spec.grid().axes.back()))),
      folded_(spec.grid().folds_orders()),
      first_theta_d_(all.begin / cos_phi_d_.size()),
      paths_(model, cosines(rows_of(theta_d_, all, cos_phi_d_.size())), workers) {}

void HalfDifferencePoints::fill_row(std::size_t row, std::span<const ColumnRange> columns,
                                    std::span<double> values) const {
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
  const std::size_t count = cos_phi_d_.size();
  const std::size_t first = columns.front().begin / count;
  ChannelSums sums(model_, (columns.back().end - 1) / count + 1 - first);
  paths_.sums(density, first - first_theta_d_, sums.specular(), sums.internal());

  std::vector<double> factor(count);
  std::vector<double> above(count);
  for (const ColumnRange& range : columns) {
    for (std::size_t at = range.begin; at < range.end;) {
      const std::size_t d = at / count;
      const std::size_t begin = at - d * count;
      const std::size_t some = std::min(range.end - at, count - begin);
      fill_factors(model_.material().reflectance, model_.effects().shadowing, folded_, theta_h,
                   theta_d_[d], cos_phi_d_.data() + begin, some, factor.data(), above.data());
      for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
        const Channel& channel = spec_.channels[c];
        fill_values(factor.data(), above.data(), some, sums.directional(channel, d - first),
                    sums.constant(channel), values.data() + c * spec_.column_count() + at);
      }
      at += some;
    }
  }
}

}  // namespace clothbrdf
