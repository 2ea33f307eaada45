#include "tabulate/inout_points.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "tabulate/pair_evaluator.h"

namespace clothbrdf {
namespace {

// Azimuth differences kept for each phi_o, at most: beyond, rows have few weights in common.
constexpr std::size_t kMostShared = 4;

}  // namespace

InOutPoints::InOutPoints(const TableSpec& spec, const ClothModel<double>& model, Workers workers)
    : spec_(spec),
      model_(model),
      workers_(1, workers.progress),
      turn_steps_(std::lcm<long long>(spec.grid().axes[1].size, spec.grid().axes[3].size)),
      delta_count_(static_cast<std::size_t>(turn_steps_ / 2 + 1)),
      shared_(delta_count_ <= kMostShared * static_cast<std::size_t>(spec.grid().axes[3].size)) {}

void InOutPoints::fill_rows(std::size_t first_row, std::span<double> values) const {
  for (std::size_t at = 0; at < values.size(); at += spec_.row_values()) {
    fill_row(first_row++, values.subspan(at, spec_.row_values()));
  }
}

std::size_t InOutPoints::delta_index(int phi_i, int phi_o) const {
  const std::vector<Axis>& axes = spec_.grid().axes;
  const long long step =
      std::abs(phi_o * (turn_steps_ / axes[3].size) - phi_i * (turn_steps_ / axes[1].size));
  return static_cast<std::size_t>(std::min(step, turn_steps_ - step));
}

std::shared_ptr<const PathMatrix> InOutPoints::shared_paths(int theta_i) const {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : recent_) {
    if (entry.theta_i == theta_i) return entry.paths;
  }
  std::vector<double> cos_theta_d;
  const std::vector<Axis>& axes = spec_.grid().axes;
  for (int o = 0; o < axes[2].size; ++o) {
    for (std::size_t step = 0; step < delta_count_; ++step) {
      const double delta_deg = 360.0 * static_cast<double>(step) / static_cast<double>(turn_steps_);
      const DirectionPair pair{axes[0].node_deg(theta_i), 0, axes[2].node_deg(o), delta_deg};
      cos_theta_d.push_back(pair_geometry(pair, 0.0).cos_theta_d);
    }
  }
  recent_[0] = std::exchange(recent_[1], {theta_i, std::make_shared<PathMatrix>(
                                                       model_, std::move(cos_theta_d), workers_)});
  return recent_[1].paths;
}

std::shared_ptr<const PathMatrix> InOutPoints::row_paths(int theta_i, int phi_i) const {
  std::vector<double> cos_theta_d;
  const std::vector<Axis>& axes = spec_.grid().axes;
  for (int o = 0; o < axes[2].size; ++o) {
    for (int p = 0; p < axes[3].size; ++p) {
      const DirectionPair pair{axes[0].node_deg(theta_i), axes[1].node_deg(phi_i),
                               axes[2].node_deg(o), axes[3].node_deg(p)};
      cos_theta_d.push_back(pair_geometry(pair, 0.0).cos_theta_d);
    }
  }
  return std::make_shared<PathMatrix>(model_, std::move(cos_theta_d), workers_);
}

void InOutPoints::fill_row(std::size_t row, std::span<double> values) const {
  const std::vector<Axis>& axes = spec_.grid().axes;
  const auto phi_i_count = static_cast<std::size_t>(axes[1].size);
  const auto theta_i = static_cast<int>(row / phi_i_count);
  const auto phi_i = static_cast<int>(row % phi_i_count);
  const std::shared_ptr<const PathMatrix> paths =
      shared_ ? shared_paths(theta_i) : row_paths(theta_i, phi_i);
  const std::size_t columns = spec_.column_count();
  PairEvaluator evaluator(model_, *paths);
  std::vector<double> sample(spec_.channels.size());
  std::size_t column = 0;
  for (int theta_o = 0; theta_o < axes[2].size; ++theta_o) {
    workers_.check();
    for (int phi_o = 0; phi_o < axes[3].size; ++phi_o, ++column) {
      const DirectionPair pair{axes[0].node_deg(theta_i), axes[1].node_deg(phi_i),
                               axes[2].node_deg(theta_o), axes[3].node_deg(phi_o)};
      const std::size_t index =
          shared_ ? static_cast<std::size_t>(theta_o) * delta_count_ + delta_index(phi_i, phi_o)
                  : column;
      evaluator.evaluate(pair_geometry(pair, model_.material().rotation_deg), index, spec_.channels,
                         sample);
      for (std::size_t c = 0; c < sample.size(); ++c) values[c * columns + column] = sample[c];
    }
  }
}

}  // namespace clothbrdf
