#include "formats/rgl_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "formats/rgl_prefilter.h"
#include "formats/square.h"
#include "formats/warp.h"
#include "support/threads.h"
#include "table/spectrum.h"

namespace clothbrdf {
namespace {

RglPoint node_of(std::size_t index, std::size_t side) {
  const double last = static_cast<double>(side - 1);
  const std::size_t row = index / side;
  return {static_cast<double>(index % side) / last, static_cast<double>(row) / last};
}

// Y of the channels.
std::vector<double> luminance_weights(const RglLayout& layout) {
  const auto& y_of_rgb = kXyzOfRgb[1];
  if (layout.wavelengths_nm.empty()) return {y_of_rgb.begin(), y_of_rgb.end()};
  const std::vector<double> wavelengths(layout.wavelengths_nm.begin(), layout.wavelengths_nm.end());
  const ChannelMatrix rgb = rgb_weights(wavelengths);
  std::vector<double> weights(wavelengths.size(), 0.0);
  for (std::size_t c = 0; c < weights.size(); ++c) {
    for (std::size_t k = 0; k < y_of_rgb.size(); ++k) weights[c] += y_of_rgb[k] * rgb[k][c];
  }
  return weights;
}

// How densely nodes lie around a half vector: nearly alike everywhere. Densities that follow the
// lobes or the foreshortening move nodes from slice to slice, and interpolation between slices is
// lost.
double density_at(const Vector3<double>& eye, double x, const Vector3<double>& m) {
  const double cosine = dot(eye, m);
  const double facing = (cosine + std::sqrt(cosine * cosine + 0.04)) / 2;
  return (0.1 + std::pow(facing, 0.6)) * std::pow(x + 0.02, 0.2);
}

// The eyes of the slices that share an interval with this one and see less: farther down, and to
// both sides. At the pole all azimuths are one eye, and none has neighbours of its own.
std::array<Vector3<double>, 3> neighbours_of(const RglLayout& layout, std::size_t phi,
                                             std::size_t theta) {
  const RglSizes& s = layout.sizes;
  const double theta_eye = double{layout.theta_i[theta]};
  const double theta_next =
      double{layout.theta_i[theta == 0 ? 0 : std::min(theta + 1, s.theta - 1)]};
  const double phi_eye = double{layout.phi_i[phi]};
  const double step = s.phi == 1 ? 0 : 2 * std::numbers::pi / static_cast<double>(s.phi - 1);
  return {direction_at(theta_next, phi_eye), direction_at(theta_eye, phi_eye + step),
          direction_at(theta_eye, phi_eye - step)};
}

// The height above the horizon that a light is sampled as if it had. Between two slices readers mix
// their samples, and what one slice sees just above the horizon is below it for the other: lost
// samples. Where a neighbour sees the light below the horizon, less is asked for; the factors keep
// the lost samples near 1 % at theta = 80 degrees and weights below six times their mean (silk,
// 5 MB).
double sampled_cosine(double light_cosine, double lowest_cosine) {
  constexpr double kLeast = 0.15;
  constexpr double kMargin = 2;
  return std::max(kLeast * light_cosine, light_cosine + kMargin * std::min(0.0, lowest_cosine));
}

}  // namespace

// The nodes of a slice.
struct RglSlices::Nodes {
  std::vector<Directions> pairs;
  std::vector<double> scales;  // stored value over f_r; 0 where the light is below the horizon
  std::vector<double> solid_angles;  // projected, of the light for a part of the warped square
};

RglSlices::RglSlices(const Producer& producer, const RglLayout& layout, Workers workers)
    : producer_(producer),
      layout_(layout),
      workers_(workers),
      luminance_weights_(luminance_weights(layout)),
      distribution_(rgl_distribution(producer, luminance_weights_, workers)) {}

RglSlices::Nodes RglSlices::place_nodes(std::size_t phi, std::size_t theta,
                                        std::span<float> densities) const {
  const RglSizes& s = layout_.sizes;
  const double theta_eye = double{layout_.theta_i[theta]};
  const Vector3<double> eye = direction_at(theta_eye, double{layout_.phi_i[phi]});
  const auto neighbours = neighbours_of(layout_, phi, theta);
  for (std::size_t k = 0; k < densities.size(); ++k) {
    const RglPoint u_m = node_of(k, s.density);
    const Vector3<double> m = direction_at(square_theta(u_m.x), square_phi(u_m.y));
    densities[k] = static_cast<float>(density_at(eye, u_m.x, m));
  }
  const Warp warp(s.density, s.density, densities);
  const SliceBlend slice = only_slice(0);
  const double area =
      bilinear(distribution_.sigma, kSigmaRows, kSigmaColumns, {theta_to_square(theta_eye), 0});
  Nodes nodes{std::vector<Directions>(s.slice_cells()), std::vector<double>(s.slice_cells()),
              std::vector<double>(s.slice_cells())};
  for (std::size_t k = 0; k < s.slice_cells(); ++k) {
    const RglPoint u_m = warp.sample(node_of(k, s.square), slice);
    const Vector3<double> m = direction_at(square_theta(u_m.x), square_phi(u_m.y));
    const double cosine = dot(eye, m);
    Directions& pair = nodes.pairs[k];
    pair.wo = eye;
    for (std::size_t a = 0; a < 3; ++a) pair.wi[a] = 2 * cosine * m[a] - eye[a];
    // Beyond the horizon f_r could only be made up, and readers that do not clamp would see it.
    const double light_cosine = std::max(0.0, pair.wi[2]);
    nodes.scales[k] =
        light_cosine * 4 * area / bilinear(distribution_.ndf, kNdfSide, kNdfSide, u_m);
    // The square shrinks to nothing at the pole, but not next to it.
    constexpr double kLeastX = 0.01;
    const double x = std::max(u_m.x, kLeastX);
    double lowest = light_cosine;
    for (const Vector3<double>& other : neighbours) {
      lowest = std::min(lowest, 2 * dot(other, m) * m[2] - other[2]);
    }
    nodes.solid_angles[k] = sampled_cosine(light_cosine, lowest) * std::max(0.0, cosine) * 8 *
                            std::numbers::pi * std::numbers::pi * x * std::sin(square_theta(x)) /
                            warp.density(u_m, slice);
  }
  return nodes;
}

void RglSlices::fill_luminance(const Nodes& nodes, std::span<const double> f,
                               std::span<float> wanted) const {
  const std::size_t channels = luminance_weights_.size();
  double mean = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const double y = luminance(luminance_weights_, f.subspan(k * channels, channels));
    wanted[k] = static_cast<float>(std::max(0.0, y) * nodes.solid_angles[k]);
    if (!std::isfinite(wanted[k])) wanted[k] = 0;
    mean += double{wanted[k]} / static_cast<double>(wanted.size());
  }
  // Every direction can be sampled, also where linear interpolation sees more than its nodes.
  const auto least = static_cast<float>(mean > 0 ? 1e-4 * mean : 1.0);
  for (float& value : wanted) value = std::max(value, least);
}

void RglSlices::fill_slice(std::size_t phi, std::size_t theta, RglColumn& column) const {
  const RglSizes& s = layout_.sizes;
  const std::size_t density_cells = s.density * s.density;
  const std::size_t cells = s.slice_cells();
  const Nodes nodes = place_nodes(
      phi, theta, std::span(column.densities).subspan(theta * density_cells, density_cells));
  std::vector<double> f(cells * s.channels);
  producer_.fill_pairs(nodes.pairs, f);
  fill_luminance(nodes, f, std::span(column.luminance).subspan(theta * cells, cells));
  for (std::size_t c = 0; c < s.channels; ++c) {
    const std::span<float> values =
        std::span(column.values).subspan((theta * s.channels + c) * cells, cells);
    for (std::size_t k = 0; k < cells; ++k) {
      values[k] = static_cast<float>(f[k * s.channels + c] * nodes.scales[k]);
    }
    prefilter_slice(values, s.square);
  }
}

RglColumn RglSlices::column(std::size_t phi) const {
  const RglSizes& s = layout_.sizes;
  RglColumn column{std::vector<float>(s.theta * s.density * s.density),
                   std::vector<float>(s.theta * s.slice_cells()),
                   std::vector<float>(s.theta * s.channels * s.slice_cells())};
  with_threads(workers_.threads, [&] {
    run_parallel(s.theta, workers_, [&](std::size_t theta) {
      workers_.check();
      fill_slice(phi, theta, column);
    });
  });
  prefilter_between(column.values, layout_.theta_i);
  return column;
}

}  // namespace clothbrdf
