#include "table/sampled_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace clothbrdf {
namespace {

constexpr double kPi = std::numbers::pi;

// The second half of the pairs: tan theta_h with the density of a round lobe of this width, about
// that of the presets' lobes, and cos theta_d with a density that grows as 1/sqrt towards 0.
constexpr double kLobeWidth = 0.3;

double density_of_half_vector(double cos_theta_h) {
  const double cos2 = cos_theta_h * cos_theta_h;
  const double width2 = kLobeWidth * kLobeWidth;
  const double sum = width2 * cos2 + (1 - cos2);
  return width2 * cos_theta_h / (kPi * sum * sum);  // by solid angle
}
double density_of_difference(double cos_theta_d) { return 0.25 / (kPi * std::sqrt(cos_theta_d)); }

struct Difference {
  double relative;
  double share;
};

double percentile(std::vector<Difference>& differences) {
  std::sort(differences.begin(), differences.end(),
            [](const Difference& a, const Difference& b) { return a.relative < b.relative; });
  double all = 0;
  for (const Difference& d : differences) all += d.share;
  double sum = 0;
  for (const Difference& d : differences) {
    sum += d.share;
    if (sum >= kPercentile * all) return d.relative;
  }
  return differences.empty() ? 0 : differences.back().relative;
}

}  // namespace

SampledPairs sampled_pairs(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto random = [&] { return (static_cast<double>(engine() >> 11U) + 0.5) * 0x1p-53; };
  const double lowest_cosine = sincosd(kSampledTheta).cos;
  const auto vector = [](double cosine, double turn) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return Vector3<double>{sine * std::cos(2 * kPi * turn), sine * std::sin(2 * kPi * turn),
                           cosine};
  };
  const double cap = 2 * kPi * (1 - lowest_cosine);
  const double uniform = 1 / (cap * cap);
  SampledPairs sampled;
  double all = 0;
  for (std::size_t k = 0; k < count; ++k) {
    // In the order that they are drawn, which the arguments of a call would not promise.
    const double a = random();
    const double b = random();
    const double c = random();
    const double d = random();
    Directions pair{};
    if (k % 2 == 0) {
      pair = {vector(1 - a * (1 - lowest_cosine), b), vector(1 - c * (1 - lowest_cosine), d)};
    } else {
      const double tangent = kLobeWidth * std::sqrt(a / (1 - a));
      const double cosine = 1 / std::sqrt(1 + tangent * tangent);
      pair = from_half_difference({tangent * cosine, cosine}, sincosd(360 * b), vector(c * c, d));
    }
    if (pair.wi[2] < lowest_cosine || pair.wo[2] < lowest_cosine) continue;
    const Vector3<double> sum = {pair.wi[0] + pair.wo[0], pair.wi[1] + pair.wo[1],
                                 pair.wi[2] + pair.wo[2]};
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    const double cos_theta_d = length / 2;
    // dwi dwo = 4 cos theta_d dwh dwd
    const double narrow = density_of_half_vector(sum[2] / length) *
                          density_of_difference(cos_theta_d) / (4 * cos_theta_d);
    sampled.pairs.push_back(pair);
    sampled.shares.push_back(uniform / (0.5 * uniform + 0.5 * narrow));
    all += sampled.shares.back();
  }
  for (double& share : sampled.shares) share /= all;
  return sampled;
}

TableError table_error(const SampledPairs& sampled, std::span<const double> exact,
                       std::span<const double> read) {
  const std::size_t channels = exact.size() / std::max<std::size_t>(1, sampled.pairs.size());
  double mean = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    mean += sampled.shares[k / channels] * exact[k] / static_cast<double>(channels);
  }
  double squares = 0;
  double all_squares = 0;
  TableError error;
  std::vector<Difference> differences;
  differences.reserve(exact.size());
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const std::size_t p = k / channels;
    const double share = sampled.shares[p];
    const double cosines = sampled.pairs[p].wi[2] * sampled.pairs[p].wo[2];
    const double weight = share * cosines * cosines;
    const double off = read[k] - exact[k];
    squares += weight * off * off;
    all_squares += weight * exact[k] * exact[k];
    differences.push_back(
        {off == 0 ? 0 : std::abs(off) / (exact[k] + kRelativeFloor * mean), share});
    error.max = std::max(error.max, differences.back().relative);
  }
  error.rms = squares == 0 ? 0 : std::sqrt(squares / all_squares);
  error.p99 = percentile(differences);
  return error;
}

}  // namespace clothbrdf
