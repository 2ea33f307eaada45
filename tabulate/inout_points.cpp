#include "tabulate/inout_points.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace clothbrdf {

InOutPoints::InOutPoints(const TableSpec& spec, const ClothModel<double>& model)
    : spec_(spec),
      model_(model),
      turn_steps_(std::lcm(spec.grid().axes[1].size, spec.grid().axes[3].size)) {}

void InOutPoints::fill_rows(std::size_t first_row, std::span<double> values) const {
  for (std::size_t at = 0; at < values.size(); at += spec_.row_values()) {
    fill_row(first_row++, values.subspan(at, spec_.row_values()));
  }
}

std::shared_ptr<const PathMatrix> InOutPoints::paths_for(int theta_i) const {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : recent_) {
    if (entry.theta_i == theta_i) return entry.paths;
  }
  std::vector<double> cos_theta_d;
  const std::vector<Axis>& axes = spec_.grid().axes;
  for (int o = 0; o < axes[2].size; ++o) {
    for (std::size_t step = 0; step < delta_count(); ++step) {
      const DirectionPair pair{axes[0].node_deg(theta_i), 0, axes[2].node_deg(o),
                               360.0 * static_cast<double>(step) / turn_steps_};
      cos_theta_d.push_back(pair_geometry(pair, 0.0).cos_theta_d);
    }
  }
  recent_[0] = std::exchange(
      recent_[1], {theta_i, std::make_shared<PathMatrix>(model_, std::move(cos_theta_d), 1)});
  return recent_[1].paths;
}

void InOutPoints::fill_row(std::size_t row, std::span<double> values) const {
  const std::vector<Axis>& axes = spec_.grid().axes;
  const int theta_i = static_cast<int>(row) / axes[1].size;
  const int phi_i = static_cast<int>(row) % axes[1].size;
  const std::shared_ptr<const PathMatrix> paths = paths_for(theta_i);
  const std::size_t columns = spec_.column_count();
  std::vector<double> density(paths->lobe_count());
  ChannelSums sums(model_, 1);
  for (int theta_o = 0; theta_o < axes[2].size; ++theta_o) {
    for (int phi_o = 0; phi_o < axes[3].size; ++phi_o) {
      const DirectionPair pair{axes[0].node_deg(theta_i), axes[1].node_deg(phi_i),
                               axes[2].node_deg(theta_o), axes[3].node_deg(phi_o)};
      const PairGeometry<double> g = pair_geometry(pair, model_.material().rotation_deg);
      const double factor = directional_factor(model_.material().reflectance, g.h_n, g.cos_theta_d,
                                               g.cos_theta_i, g.cos_theta_o);
      int step =
          std::abs(phi_o * (turn_steps_ / axes[3].size) - phi_i * (turn_steps_ / axes[1].size));
      step = std::min(step, turn_steps_ - step);
      paths->densities(g.h_weft, g.h_warp, g.h_n, density);
      paths->sums(
          density,
          static_cast<std::size_t>(theta_o) * delta_count() + static_cast<std::size_t>(step),
          sums.specular(), sums.internal());
      const std::size_t column =
          static_cast<std::size_t>(theta_o) * static_cast<std::size_t>(axes[3].size) +
          static_cast<std::size_t>(phi_o);
      for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
        const Channel& channel = spec_.channels[c];
        values[c * columns + column] =
            factor * sums.directional(channel, 0) + sums.constant(channel);
      }
    }
  }
}

}  // namespace clothbrdf
