#include "preview/slices.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace clothbrdf {
namespace {

using Place = std::array<int, 4>;  // a cell's index on each axis

std::string degrees_text(double angle_deg) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", angle_deg);
  return buffer;
}

int nearest(const Axis& axis, double angle_deg) {
  int best = 0;
  double least = INFINITY;
  for (int k = 0; k < axis.size; ++k) {
    const double away = axis.node_deg(k) - axis.folded_deg(angle_deg);
    const double distance =
        std::abs(axis.periodic ? std::remainder(away, axis.period_deg()) : away);
    // Rounding must not decide between two nodes at the same distance.
    constexpr double kSame = 1e-9;
    if (distance < least - kSame) {
      least = distance;
      best = k;
    }
  }
  return best;
}

Place nearest(const Grid& grid, const std::array<double, 4>& angles_deg) {
  Place place{};
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    place[a] = nearest(grid.axes[a], angles_deg[a]);
  }
  return place;
}

std::size_t cell_at(const Grid& grid, const Place& place) {
  std::size_t cell = 0;
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    cell = cell * static_cast<std::size_t>(grid.axes[a].size) + static_cast<std::size_t>(place[a]);
  }
  return cell;
}

// "theta_d 5, phi_d 90": where all axes stand but those that run.
std::string standing(const Grid& grid, const Place& place, std::size_t running,
                     std::size_t also_running) {
  std::string text;
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    if (a == running || a == also_running) continue;
    const Axis& axis = grid.axes[a];
    text += (text.empty() ? "" : ", ") + axis.name + " " + degrees_text(axis.node_deg(place[a]));
  }
  return text;
}

Slice along(const Grid& grid, std::size_t running, const std::array<double, 4>& angles_deg) {
  Place place = nearest(grid, angles_deg);
  const Axis& axis = grid.axes[running];
  Slice slice;
  slice.title = {"f_r along " + axis.name, standing(grid, place, running, running)};
  slice.axis = angle_axis(axis);
  for (int k = 0; k < axis.size; ++k) {
    place[running] = k;
    slice.cells.push_back(cell_at(grid, place));
    slice.x.push_back(k);
  }
  return slice;
}

// theta_o from the horizon on the light's side (negative) to the one that mirrors it.
Slice in_plane(const Grid& grid, double theta_i_deg, double phi_i_deg) {
  constexpr std::size_t kThetaOut = 2;
  constexpr std::size_t kPhiOut = 3;
  const Axis& theta_o = grid.axes[kThetaOut];
  const double phi_i_node = grid.axes[1].node_deg(nearest(grid.axes[1], phi_i_deg));
  Place back = nearest(grid, {theta_i_deg, phi_i_deg, 0, phi_i_node});
  Place mirror = nearest(grid, {theta_i_deg, phi_i_deg, 0, phi_i_node + 180});
  Slice slice;
  slice.title = {"f_r in the plane of incidence", standing(grid, back, kThetaOut, kPhiOut)};
  slice.axis = {"theta_o, mirror side +", -90, 90, false, {}};
  for (int angle = -90; angle <= 90; angle += 30) {
    slice.axis.ticks.push_back({1.0 * angle, std::to_string(angle)});
  }
  for (int k = theta_o.size - 1; k >= 0; --k) {
    if (theta_o.node_deg(k) == 0) continue;  // the mirror side has it
    back[kThetaOut] = k;
    slice.cells.push_back(cell_at(grid, back));
    slice.x.push_back(-theta_o.node_deg(k));
  }
  for (int k = 0; k < theta_o.size; ++k) {
    mirror[kThetaOut] = k;
    slice.cells.push_back(cell_at(grid, mirror));
    slice.x.push_back(theta_o.node_deg(k));
  }
  return slice;
}

}  // namespace

PlotAxis angle_axis(const Axis& axis) {
  PlotAxis result{axis.name + ", degrees", -0.5, axis.size - 0.5, false, {}};
  std::vector<double> angles;
  if (axis.spacing == Spacing::kSquared) {
    angles = {0, 1, 2, 5, 10, 20, 30, 45, 60, 75, 90};
  } else {
    const double range = axis.highest_deg - axis.lowest_deg;
    const double step = range <= 90 ? 15 : range <= 180 ? 30 : 60;
    for (int k = 0; k * step <= range; ++k) angles.push_back(axis.lowest_deg + k * step);
  }
  for (const double angle : angles) {
    result.ticks.push_back({axis.coordinate(angle), tick_text(angle)});
  }
  return result;
}

// phi_d is 90 where it stands: light and eye are then above the horizon alike, whatever the thetas.
std::vector<Slice> typical_slices(const Grid& grid) {
  switch (grid.kind) {
    case GridKind::kHalfDifference3d:
      return {along(grid, 0, {0, 5, 90}), along(grid, 0, {0, 40, 90}), along(grid, 0, {0, 70, 90}),
              along(grid, 1, {0, 0, 90}), along(grid, 2, {30, 30, 0})};
    case GridKind::kHalfDifference4d:
      return {along(grid, 0, {0, 0, 5, 90}), along(grid, 0, {0, 90, 5, 90}),
              along(grid, 0, {0, 0, 60, 90}), along(grid, 2, {0, 0, 0, 90}),
              along(grid, 3, {30, 0, 30, 0})};
    case GridKind::kInOut:
      return {in_plane(grid, 30, 0), in_plane(grid, 60, 0), in_plane(grid, 30, 90),
              along(grid, 3, {30, 0, 30, 0}), along(grid, 3, {60, 0, 60, 0})};
  }
  return {};
}

}  // namespace clothbrdf
