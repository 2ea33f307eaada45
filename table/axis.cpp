#include "table/axis.h"

#include <algorithm>
#include <cmath>

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
  return angle_at(*this, spacing == Spacing::kNodes ? k : k + 0.5);
}

double Axis::edge_deg(int k) const {
  if (spacing != Spacing::kNodes) return angle_at(*this, k);
  const double edge = angle_at(*this, k - 0.5);
  return periodic ? edge : std::max(lowest_deg, edge);
}

std::optional<int> Axis::cell_of(double angle_deg) const {
  const double range = highest_deg - lowest_deg;
  double share = (angle_deg - lowest_deg) / range;
  if (periodic) share -= std::floor(share);
  if (!(share >= 0 && share <= 1)) return std::nullopt;
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
  double share = (angle_deg - lowest_deg) / (highest_deg - lowest_deg);
  if (spacing == Spacing::kSquared) share = std::sqrt(std::max(share, 0.0));
  return share * size - (spacing == Spacing::kNodes ? 0.0 : 0.5);
}

}  // namespace clothbrdf
