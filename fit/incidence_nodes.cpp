#include "fit/incidence_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clothbrdf {
namespace {

constexpr double kShift = 0x1p-8;
constexpr int kLastOctave = -1;
constexpr double kEnd = 1 + 0x1p-3;  // of the last octave, which takes in perpendicular incidence

int octave_of(double cos_theta_d) {
  return std::min(std::ilogb(cos_theta_d + kShift), kLastOctave);
}

double start_of(int octave) { return std::ldexp(1.0, octave); }
double width_of(int octave) {
  return (octave == kLastOctave ? kEnd : 2 * start_of(octave)) - start_of(octave);
}

// Chebyshev points of the first kind in an octave, 0 to 1, and their barycentric weights.
struct Points {
  std::array<double, IncidenceNodes::kOrder> node{};
  std::array<double, IncidenceNodes::kOrder> weight{};

  Points() {
    for (std::size_t k = 0; k < node.size(); ++k) {
      const double angle =
          std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(node.size());
      node[k] = (1 - std::cos(angle)) / 2;
      weight[k] = (k % 2 == 0 ? 1 : -1) * std::sin(angle);
    }
  }
};

const Points& points() {
  static const Points kPoints;
  return kPoints;
}

}  // namespace

IncidenceNodes::IncidenceNodes(std::span<const double> cos_theta_d) {
  const auto [lowest, highest] = std::minmax_element(cos_theta_d.begin(), cos_theta_d.end());
  first_octave_ = octave_of(*lowest);
  for (int octave = first_octave_; octave <= octave_of(*highest); ++octave) {
    for (std::size_t k = 0; k < kOrder; ++k) {
      nodes_.push_back(start_of(octave) + width_of(octave) * points().node[k] - kShift);
    }
  }
}

IncidenceNodes::Place IncidenceNodes::place(double cos_theta_d) const {
  const int octave = octave_of(cos_theta_d);
  const double share = (cos_theta_d + kShift - start_of(octave)) / width_of(octave);
  Place place{static_cast<std::size_t>(octave - first_octave_) * kOrder, {}};
  double all = 0;
  for (std::size_t k = 0; k < kOrder; ++k) {
    const double off = share - points().node[k];
    if (off == 0) {
      place.weights = {};
      place.weights[k] = 1;
      return place;
    }
    place.weights[k] = points().weight[k] / off;
    all += place.weights[k];
  }
  for (double& weight : place.weights) weight /= all;
  return place;
}

}  // namespace clothbrdf
