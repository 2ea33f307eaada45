#include "formats/rgl_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "formats/square.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr int kThetaParts = 8;
constexpr int kPhiParts = 12;

// The same around every half vector: equal parts of sin^2(theta_d) and of phi_d.
void put_pairs_around(double theta_h, double phi_h, std::span<Directions> pairs) {
  const Vector3<double> m = direction_at(theta_h, phi_h);
  const Vector3<double> t = {std::cos(theta_h) * std::cos(phi_h),
                             std::cos(theta_h) * std::sin(phi_h), -std::sin(theta_h)};
  const Vector3<double> b = {-std::sin(phi_h), std::cos(phi_h), 0};
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const std::size_t theta_part = p / kPhiParts;
    const double sin_d = std::sqrt((static_cast<double>(theta_part) + 0.5) / kThetaParts);
    const double cos_d = std::sqrt(1 - sin_d * sin_d);
    const double phi_d =
        2 * std::numbers::pi * (static_cast<double>(p % kPhiParts) + 0.5) / kPhiParts;
    for (std::size_t a = 0; a < 3; ++a) {
      const double across = sin_d * (std::cos(phi_d) * t[a] + std::sin(phi_d) * b[a]);
      pairs[p].wi[a] = cos_d * m[a] + across;
      pairs[p].wo[a] = cos_d * m[a] - across;
    }
  }
}

// The weights let pairs fade out before they leave through the horizon: D has no steps there.
// Negative where all have left.
double weighted_mean(std::span<const Directions> pairs, std::span<const double> values,
                     std::span<const double> luminance_weights) {
  const std::size_t channels = luminance_weights.size();
  double sum = 0;
  double weights = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (!pairs[p].above_horizon()) continue;
    const double weight = pairs[p].wi[2] * pairs[p].wo[2];
    sum += weight * luminance(luminance_weights, values.subspan(p * channels, channels));
    weights += weight;
  }
  return weights > 0 ? sum / weights : -1;
}

std::vector<float> ndf_table(const Producer& producer, std::span<const double> weights,
                             Workers workers) {
  std::vector<float> ndf(kNdfSide * kNdfSide);
  const auto place = [](std::size_t k) { return static_cast<double>(k) / (kNdfSide - 1.0); };
  const auto fill_row = [&](std::size_t row) {
    workers.check();
    std::vector<Directions> pairs(std::size_t{kThetaParts} * kPhiParts);
    std::vector<double> values(pairs.size() * weights.size());
    for (std::size_t column = 0; column < kNdfSide; ++column) {
      put_pairs_around(square_theta(place(column)), square_phi(place(row)), pairs);
      producer.fill_pairs(pairs, values);
      const double mean = weighted_mean(pairs, values, weights);
      float& at = ndf[row * kNdfSide + column];
      if (mean >= 0) {
        at = static_cast<float>(mean);
      } else if (column > 0) {
        at = ndf[row * kNdfSide + column - 1];
      }
    }
  };
  // An isotropic table has the same rows.
  const std::size_t rows = producer.spec().isotropic() ? 1 : kNdfSide;
  with_threads(workers.threads, [&] { run_parallel(rows, workers, fill_row); });
  for (std::size_t row = rows; row < kNdfSide; ++row) {
    std::copy_n(ndf.begin(), kNdfSide, ndf.begin() + static_cast<std::ptrdiff_t>(row * kNdfSide));
  }
  // Strictly positive and finite, whatever the producer says: readers multiply by it, nodes are
  // divided by it.
  double mean = 0;
  for (float& d : ndf) {
    if (!std::isfinite(d)) d = 0;
    mean += double{d} / static_cast<double>(ndf.size());
  }
  const auto least = static_cast<float>(mean > 0 ? 1e-6 * mean : 1.0);
  for (float& d : ndf) d = std::max(d, least);
  return ndf;
}

// With the eye's cosine divided out, what is left hardly depends on the eye; kept from 0, where
// interpolation would fail.
std::vector<float> sigma_table() {
  constexpr double kLeast = 0.1;
  std::vector<float> sigma(kSigmaRows * kSigmaColumns);
  for (std::size_t k = 0; k < sigma.size(); ++k) {
    const double x = static_cast<double>(k % kSigmaColumns) / (kSigmaColumns - 1.0);
    sigma[k] = static_cast<float>(std::hypot(std::cos(square_theta(x)), kLeast));
  }
  return sigma;
}

}  // namespace

double luminance(std::span<const double> weights, std::span<const double> f) {
  double sum = 0;
  for (std::size_t c = 0; c < weights.size(); ++c) sum += weights[c] * f[c];
  return sum;
}

RglDistribution rgl_distribution(const Producer& producer,
                                 std::span<const double> luminance_weights, Workers workers) {
  return {ndf_table(producer, luminance_weights, workers), sigma_table()};
}

}  // namespace clothbrdf
