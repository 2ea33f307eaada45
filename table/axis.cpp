#include "table/axis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace clothbrdf {
namespace {

// The angle at `index` steps of an axis; middles of cells have half-integer indices.
double angle_at(const Axis& axis, double index) {
  const double range = axis.highest_deg - axis.lowest_deg;
  if (axis.spacing == Spacing::kSquared) {
    return axis.lowest_deg + range * (index * index) / (static_cast<double>(axis.size) * axis.size);
  }
  return axis.lowest_deg + range * index / axis.size;
}

}  // namespace

double Axis::node_deg(int k) const {
  if (spacing == Spacing::kListed) return listed_deg[static_cast<std::size_t>(k)];
  return angle_at(*this, spacing == Spacing::kNodes ? k : k + 0.5);
}

double Axis::edge_deg(int k) const {
  if (spacing == Spacing::kListed) {
    if (k == 0) return lowest_deg;
    return k == size ? highest_deg : std::midpoint(node_deg(k - 1), node_deg(k));
  }
  if (spacing != Spacing::kNodes) return angle_at(*this, k);
  const double edge = angle_at(*this, k - 0.5);
  return periodic ? edge : std::max(lowest_deg, edge);
}

double Axis::period_deg() const {
  const double range = highest_deg - lowest_deg;
  return mirrored ? 2 * range : periodic ? range : 0;
}

double Axis::folded_deg(double angle_deg) const {
  const double period = period_deg();
  if (period == 0) return angle_deg;
  double beyond = angle_deg - lowest_deg;
  beyond -= period * std::floor(beyond / period);
  if (mirrored) beyond = std::min(beyond, period - beyond);
  return lowest_deg + beyond;
}

std::optional<int> Axis::cell_of(double angle_deg) const {
  const double folded = folded_deg(angle_deg);
  const double range = highest_deg - lowest_deg;
  double share = (folded - lowest_deg) / range;
  if (!(share >= 0 && share <= 1)) return std::nullopt;
  if (spacing == Spacing::kListed) {
    int k = 0;
    while (k + 1 < size && folded >= edge_deg(k + 1)) ++k;
    return k;
  }
  if (spacing == Spacing::kSquared) share = std::sqrt(share);
  double index = std::floor(share * size + (spacing == Spacing::kNodes ? 0.5 : 0.0));
  if (index >= size) {
    if (spacing == Spacing::kNodes && !periodic) return std::nullopt;
    index =
        periodic ? 0 : size - 1;  // the highest end belongs to the last cell, or to the first again
  }
  return static_cast<int>(index);
}

double Axis::coordinate(double angle_deg) const {
  const double angle = mirrored ? folded_deg(angle_deg) : angle_deg;
  if (spacing == Spacing::kListed) {
    if (size == 1) return 0;
    const auto above = std::upper_bound(listed_deg.begin() + 1, listed_deg.end() - 1, angle);
    const double low = *(above - 1);
    return static_cast<double>(above - 1 - listed_deg.begin()) + (angle - low) / (*above - low);
  }
  double share = (angle - lowest_deg) / (highest_deg - lowest_deg);
  if (spacing == Spacing::kSquared) share = std::sqrt(std::max(share, 0.0));
  return share * size - (spacing == Spacing::kNodes ? 0.0 : 0.5);
}

}  // namespace clothbrdf
