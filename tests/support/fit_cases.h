#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "fit/parameter_set.h"
#include "table/table.h"
#include "tabulate/model_producer.h"
#include "tests/support/plain_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {

/// Two yarns with nothing in common, of what cloth is made of: no limit of a range is near.
inline Material random_cloth(RandomInputs& random, std::size_t channels = 3, int most_layers = 6) {
  Material m;
  for (Yarn* yarn : {&m.warp, &m.weft}) {
    for (double& axis : yarn->lobe_axes) axis = random.log_uniform(0.05, 0.9);
    for (std::size_t c = 0; c < channels; ++c) {
      yarn->absorption.push_back(random.log_uniform(0.02, 0.8));
    }
    yarn->layers = random.integer(1, most_layers);
    yarn->refractive_index = random.uniform(1.3, 1.8);
    yarn->scatter = random.uniform(0.01, 0.3);
  }
  m.weights = {random.uniform(0.5, 1.5), random.uniform(0.5, 1.5), random.uniform(0.1, 0.5)};
  m.diffuse_path = random.uniform(0.7, 3);
  m.warp_fraction = random.uniform(0.3, 0.7);
  m.rotation_deg = -random.uniform(-45, 45);
  if (channels != 3) {
    for (std::size_t c = 0; c < channels; ++c) {
      m.wavelengths_nm.push_back(400 + 20 * static_cast<double>(c));
    }
  }
  return m;
}

inline Table table_of(const Material& material, const Grid& grid, const CellRule& cells = {}) {
  return collect(*make_producer(material_spec(material, {}, grid, cells), 1), 1);
}

/// Standard normal draws, the same on every platform.
inline double normal(RandomInputs& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
  return radius * std::cos(2 * std::acos(-1.0) * random.unit());
}

/// Independent Gaussian noise in proportion to each value.
inline Table noisy(const Table& table, double noise, std::uint64_t seed) {
  RandomInputs random(seed);
  std::vector<double> values(table.values().begin(), table.values().end());
  for (double& value : values) value *= 1 + noise * normal(random);
  return with_values(table, std::move(values));
}

/// Conventions given; everything else as it is by default.
inline FitOptions conventions_of(const Material& material) {
  FitOptions options;
  options.reflectances = {material.reflectance};
  options.paths = {material.paths};
  return options;
}

/// Few starts and layer counts: where only the way through is tested.
inline FitOptions quick_options(const Material& material) {
  FitOptions options = conventions_of(material);
  options.starts = 4;
  options.fewest_layers = 1;
  options.most_layers = 3;
  return options;
}

/// Only the solve: from a guess, with its layer counts.
inline FitOptions warm_options(const Material& start) {
  FitOptions options = conventions_of(start);
  options.start = start;
  options.wishes.push_back({ParameterWish::Kind::kFix, "layers", {}, {}, {}});
  return options;
}

/// The material with every free parameter of the set moved a little.
inline Material shaken(const Material& material, const ParameterSet& set, double size,
                       std::uint64_t seed) {
  RandomInputs random(seed);
  std::vector<double> coordinates = set.coordinates(material);
  for (double& x : coordinates) x += size * random.uniform(-1, 1);
  return set.material(coordinates, material);
}

inline double estimate_of(const FitReport& report, const std::string& name) {
  for (const ParameterEstimate& p : report.parameters) {
    if (p.name == name) return p.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace clothbrdf::test
