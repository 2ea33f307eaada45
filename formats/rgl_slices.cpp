#include "formats/rgl_slices.h"

#include <tbb/parallel_for.h>

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

constexpr double kPi = std::numbers::pi;

double dot(const Vector3<double>& a, const Vector3<double>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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

double luminance(std::span<const double> weights, std::span<const double> f) {
  double sum = 0;
  for (std::size_t c = 0; c < weights.size(); ++c) sum += weights[c] * f[c];
  return sum;
}

// Pairs of directions around a half vector, the same for all: equal parts of sin^2(theta_d) and of
// phi_d.
std::vector<Directions> pairs_around(double theta_h, double phi_h) {
  constexpr int kThetaParts = 6;
  constexpr int kPhiParts = 8;
  const Vector3<double> m = direction_at(theta_h, phi_h);
  const Vector3<double> t = {std::cos(theta_h) * std::cos(phi_h),
                             std::cos(theta_h) * std::sin(phi_h), -std::sin(theta_h)};
  const Vector3<double> b = {-std::sin(phi_h), std::cos(phi_h), 0};
  std::vector<Directions> pairs;
  for (int j = 0; j < kThetaParts; ++j) {
    const double sin_d = std::sqrt((j + 0.5) / kThetaParts);
    const double cos_d = std::sqrt(1 - sin_d * sin_d);
    for (int k = 0; k < kPhiParts; ++k) {
      const double phi_d = 2 * kPi * (k + 0.5) / kPhiParts;
      Directions pair{};
      for (std::size_t a = 0; a < 3; ++a) {
        const double across = sin_d * (std::cos(phi_d) * t[a] + std::sin(phi_d) * b[a]);
        pair.wi[a] = cos_d * m[a] + across;
        pair.wo[a] = cos_d * m[a] - across;
      }
      pairs.push_back(pair);
    }
  }
  return pairs;
}

// Pairs that leave through the horizon must fade out for D to be smooth, hence the weights.
double weighted_mean(std::span<const Directions> pairs, std::span<const double> values,
                     std::span<const double> luminance_weights) {
  const std::size_t channels = luminance_weights.size();
  double sum = 0;
  double weights = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (!pairs[p].above_horizon()) continue;
    const double cosines = pairs[p].wi[2] * pairs[p].wo[2];
    sum += cosines * 4 * cosines *
           luminance(luminance_weights, values.subspan(p * channels, channels));
    weights += cosines;
  }
  return weights > 0 ? sum / weights : 0;
}

// How often readers shall place nodes at half vectors: nearly everywhere alike. What follows lobes
// or foreshortening moves nodes between slices, and interpolation between slices is lost.
float density_at(const Vector3<double>& eye, double x, const Vector3<double>& m) {
  const double cosine = dot(eye, m);
  const double facing = (cosine + std::sqrt(cosine * cosine + 0.04)) / 2;
  return static_cast<float>((0.1 + std::pow(facing, 0.6)) * std::pow(x + 0.02, 0.2));
}

std::vector<float> sigma_table() {
  std::vector<float> sigma(kSigmaRows * kSigmaColumns);
  for (std::size_t k = 0; k < sigma.size(); ++k) {
    const double x = static_cast<double>(k % kSigmaColumns) / (kSigmaColumns - 1.0);
    sigma[k] = static_cast<float>(std::hypot(std::cos(square_theta(x)), 0.1));
  }
  return sigma;
}

std::vector<float> ndf_table(const Producer& producer, std::span<const double> weights,
                             Workers workers) {
  std::vector<float> ndf(kNdfSide * kNdfSide);
  const auto place = [](std::size_t k) { return static_cast<double>(k) / (kNdfSide - 1.0); };
  with_threads(workers.threads, [&] {
    tbb::parallel_for(std::size_t{0}, kNdfSide, [&](std::size_t row) {
      workers.check();
      std::vector<double> values;
      for (std::size_t column = 0; column < kNdfSide; ++column) {
        const std::vector<Directions> pairs =
            pairs_around(square_theta(place(column)), square_phi(place(row)));
        values.resize(pairs.size() * weights.size());
        producer.fill_pairs(pairs, values);
        ndf[row * kNdfSide + column] = static_cast<float>(weighted_mean(pairs, values, weights));
      }
    });
  });
  // Strictly positive: readers multiply by it, writers divide.
  double mean = 0;
  for (const float d : ndf) mean += double{d} / static_cast<double>(ndf.size());
  const auto least = static_cast<float>(mean > 0 ? 1e-6 * mean : 1.0);
  for (float& d : ndf) d = std::isfinite(d) ? std::max(d, least) : least;
  return ndf;
}

}  // namespace

RglSlices::RglSlices(const Producer& producer, const RglLayout& layout, Workers workers)
    : producer_(producer),
      layout_(layout),
      workers_(workers),
      luminance_weights_(luminance_weights(layout)),
      ndf_(ndf_table(producer, luminance_weights_, workers)),
      sigma_(sigma_table()) {}

void RglSlices::fill_slice(std::size_t phi, std::size_t theta, RglColumn& column) const {
  const RglSizes& s = layout_.sizes;
  const Vector3<double> eye =
      direction_at(double{layout_.theta_i[theta]}, double{layout_.phi_i[phi]});

  const std::span<float> densities =
      std::span(column.densities).subspan(theta * s.density * s.density, s.density * s.density);
  for (std::size_t k = 0; k < densities.size(); ++k) {
    const double x = static_cast<double>(k % s.density) / static_cast<double>(s.density - 1);
    const double y = static_cast<double>(k / s.density) / static_cast<double>(s.density - 1);
    densities[k] = density_at(eye, x, direction_at(square_theta(x), square_phi(y)));
  }
  const Warp warp(s.density, s.density, densities);
  const SliceBlend blend = only_slice(0);

  const double area = bilinear(
      sigma_, kSigmaRows, kSigmaColumns,
      {theta_to_square(double{layout_.theta_i[theta]}), phi_to_square(double{layout_.phi_i[phi]})});
  std::vector<Directions> pairs(s.slice_cells());
  std::vector<double> scales(s.slice_cells());
  std::vector<double> solid_angles(s.slice_cells());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const SquarePoint u = {static_cast<double>(k % s.square) / static_cast<double>(s.square - 1),
                           static_cast<double>(k / s.square) / static_cast<double>(s.square - 1)};
    const SquarePoint u_m = warp.sample(u, blend);
    const double theta_m = square_theta(u_m.x);
    const Vector3<double> m = direction_at(theta_m, square_phi(u_m.y));
    const double cosine = dot(eye, m);
    const Vector3<double> light = {2 * cosine * m[0] - eye[0], 2 * cosine * m[1] - eye[1],
                                   2 * cosine * m[2] - eye[2]};
    pairs[k] = {light, eye};
    const double light_cosine = std::max(0.0, light[2]);
    scales[k] = light_cosine * 4 * area / bilinear(ndf_, kNdfSide, kNdfSide, u_m);
    // At the pole itself the measure vanishes, but not around it.
    constexpr double kLeastX = 0.01;
    const double x = std::max(u_m.x, kLeastX);
    solid_angles[k] = light_cosine * std::max(0.0, cosine) * 2 * kPi * kPi * x *
                      std::sin(square_theta(x)) / warp.density(u_m, blend);
  }
  const std::size_t channels = s.channels;
  std::vector<double> f(pairs.size() * channels);
  producer_.fill_pairs(pairs, f);

  const std::span<float> of_luminance =
      std::span(column.luminance).subspan(theta * s.slice_cells(), s.slice_cells());
  double mean = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double y = luminance(luminance_weights_, std::span(f).subspan(k * channels, channels));
    const double wanted = std::max(0.0, y) * solid_angles[k];
    of_luminance[k] = static_cast<float>(std::isfinite(wanted) ? wanted : 0);
    mean += double{of_luminance[k]} / static_cast<double>(pairs.size());
  }
  const auto least = static_cast<float>(mean > 0 ? 1e-4 * mean : 1.0);
  for (float& l : of_luminance) l = std::max(l, least);

  for (std::size_t c = 0; c < channels; ++c) {
    const std::span<float> values =
        std::span(column.values).subspan((theta * channels + c) * pairs.size(), pairs.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = static_cast<float>(f[k * channels + c] * scales[k]);
    }
    prefilter_slice(values, s.square);
  }
}

RglColumn RglSlices::column(std::size_t phi) const {
  const RglSizes& s = layout_.sizes;
  RglColumn column;
  column.densities.resize(s.theta * s.density * s.density);
  column.luminance.resize(s.theta * s.slice_cells());
  column.values.resize(s.theta * s.channels * s.slice_cells());
  with_threads(workers_.threads, [&] {
    tbb::parallel_for(std::size_t{0}, s.theta, [&](std::size_t theta) {
      workers_.check();
      fill_slice(phi, theta, column);
    });
  });
  prefilter_between(column.values, layout_.theta_i);
  return column;
}

}  // namespace clothbrdf
