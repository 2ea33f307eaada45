#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {

/// f_r of a material at any pairs.
inline std::unique_ptr<Producer> pairs_of(const Material& material, bool isotropic = false) {
  return make_producer(material_spec(material, {}, AnyPairs{isotropic}), 2);
}

/// Uniform on the hemisphere down to an elevation.
inline std::vector<Directions> uniform_pairs(RandomInputs& random, int count,
                                             double most_theta_deg) {
  const double lowest = std::cos(most_theta_deg * kPi / 180);
  const auto one = [&]() -> Vector3<double> {
    const double z = random.uniform(lowest, 1);
    const double phi = random.uniform(0, 2 * kPi);
    const double s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
  };
  std::vector<Directions> pairs;
  for (int n = 0; n < count; ++n) {
    const Vector3<double> light = one();
    pairs.push_back({light, one()});
  }
  return pairs;
}

struct Errors {
  double median = 0;
  double p95 = 0;
  double p99 = 0;
};

/// |file - f| / (f + 0.001 mean f), per cent, the worst channel of each.
inline Errors errors_of(const Table& file, const Producer& exact, double most_theta_deg = 80) {
  RandomInputs random(seed_from_environment());
  const std::vector<Directions> pairs = uniform_pairs(random, 10000, most_theta_deg);
  const std::size_t channels = exact.spec().channels.size();
  std::vector<double> f(pairs.size() * channels);
  std::vector<double> of_file(f.size());
  exact.fill_pairs(pairs, f);
  file.fill_pairs(pairs, of_file);
  Errors worst;
  for (std::size_t c = 0; c < channels; ++c) {
    double mean = 0;
    for (std::size_t k = c; k < f.size(); k += channels) mean += f[k] / 10000;
    std::vector<double> errors;
    for (std::size_t k = c; k < f.size(); k += channels) {
      errors.push_back(100 * std::abs(of_file[k] - f[k]) / (f[k] + 1e-3 * mean));
    }
    std::sort(errors.begin(), errors.end());
    worst.median = std::max(worst.median, errors[5000]);
    worst.p95 = std::max(worst.p95, errors[9500]);
    worst.p99 = std::max(worst.p99, errors[9900]);
  }
  return worst;
}

}  // namespace clothbrdf::test
