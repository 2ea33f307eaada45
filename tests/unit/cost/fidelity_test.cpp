#include "cost/fidelity.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "cost/convergence.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// Every term of the path sums is positive (model.md, section 5).
constexpr double kStokes = 1e-13;
// Errors of 1e-12 in values whose differences are 1e-4 of them and more.
constexpr double kOfError = 1e-7;

Material cloth(int layers, double absorption) {
  Material material;
  material.weights = {1, 1, 0};
  material.warp.lobe_axes = {0.2, 0.5};
  material.warp.absorption = {absorption};
  material.warp.layers = layers;
  material.warp.refractive_index = 1.5;
  material.weft = material.warp;
  material.wavelengths_nm = {550};
  return material;
}

PairGeometry<double> geometry(const Directions& pair, double rotation_deg = 0) {
  return pair_geometry(pair.wi, pair.wo, rotation_deg);
}

/// [pair], of a cloth with one channel
std::vector<double> values_of(const Material& material, const SampledPairs& sampled) {
  const ClothModel<double> model(material);
  std::vector<double> values;
  for (const Directions& pair : sampled.pairs)
    values.push_back(model.evaluate(geometry(pair, material.rotation_deg)).total(0));
  return values;
}

/// Of a cloth without layers, times what a function of r, the light that one surface reflects, says
/// of the layers.
template <class Sum>
std::vector<double> closed_form(const SampledPairs& sampled, const Sum& sum) {
  std::vector<double> values = values_of(cloth(0, 0), sampled);
  for (std::size_t p = 0; p < values.size(); ++p) {
    const double r = fresnel(geometry(sampled.pairs[p]).cos_theta_d, 1.5).reflected;
    values[p] *= sum(r) / r;
  }
  return values;
}

std::vector<double> stokes(const SampledPairs& sampled, int layers) {
  return closed_form(sampled, [&](double r) {
    return layers == 0 ? r : 2 * layers * r / (1 + (2 * layers - 1) * r);
  });
}

std::vector<CostSetting> of_dial(const std::vector<CostSetting>& settings, const char* dial) {
  std::vector<CostSetting> some;
  std::copy_if(settings.begin(), settings.end(), std::back_inserter(some),
               [&](const CostSetting& s) { return s.dial == dial; });
  return some;
}

std::vector<CostSetting> measured(const Material& material, const SampledPairs& sampled) {
  return measure_fidelity(material, sampled, values_of(material, sampled), 1, 1);
}

}  // namespace

TEST_CASE("the model that simplified ones are measured against meets Stokes' pile of plates") {
  const std::uint64_t seed = seed_from_environment();
  const SampledPairs sampled = sampled_pairs(5000, seed);
  double worst = 0;
  for (int layers = 0; layers <= 6; ++layers) {
    const std::vector<double> values = values_of(cloth(layers, 0), sampled);
    const std::vector<double> exact = stokes(sampled, layers);
    for (std::size_t p = 0; p < values.size(); ++p)
      worst = std::max(worst, std::abs(values[p] / exact[p] - 1));
  }
  std::cout << "clear cloth against the pile of plates: worst relative error " << worst << " (seed "
            << seed << ")\n";
  CHECK(worst <= kStokes);
}

TEST_CASE("errors of clear cloths with fewer layers and paths are those of the closed sums") {
  constexpr int kLayers = 6;
  const SampledPairs sampled = sampled_pairs(5000, seed_from_environment());
  const std::vector<CostSetting> settings = measured(cloth(kLayers, 0), sampled);
  const std::vector<double> exact = stokes(sampled, kLayers);
  double worst = 0;
  const auto check = [&](const CostSetting& setting, const std::vector<double>& simplified) {
    const double expected = table_error(sampled, exact, simplified).rms;
    INFO(setting.name << ": " << setting.error.rms << ", by the sums " << expected);
    CHECK(std::abs(setting.error.rms / expected - 1) <= kOfError);
    worst = std::max(worst, std::abs(setting.error.rms / expected - 1));
  };
  const std::vector<CostSetting> layers = of_dial(settings, "layers kept");
  REQUIRE(layers.size() == kLayers);
  for (int kept = 0; kept < kLayers; ++kept) {
    const CostSetting& setting = layers[static_cast<std::size_t>(kept)];
    CHECK(setting.size == kept);
    CHECK(setting.name == std::to_string(kept) + " of 6 layers kept");
    check(setting, stokes(sampled, kept));
    if (kept > 0) CHECK(setting.error.rms < layers[static_cast<std::size_t>(kept - 1)].error.rms);
  }
  const std::vector<CostSetting> paths = of_dial(settings, "paths");
  REQUIRE(paths.size() == 2);
  CHECK(paths[0].name == kAllPaths);
  CHECK(paths[0].error.rms < 1e-12);
  check(paths[1], closed_form(sampled, [](double r) {
          const double t4 = std::pow(1 - r, 4);
          return r + r * (1 - r) * (1 - r) * (1 - std::pow(t4, kLayers)) / (1 - t4);
        }));
  std::cout << "errors of simplified clear cloths: worst difference from the closed sums " << worst
            << " of the error\n";
  // 1 / layers is no geometric law.
  const std::vector<Convergence> laws = convergence(cloth(kLayers, 0), layers);
  REQUIRE(laws.size() == 1);
  CHECK(laws[0].differs);
  CHECK_THAT(laws[0].reason, ContainsSubstring("pile of plates"));
}

TEST_CASE("where layers absorb each one left out errs by a lower share than the last") {
  constexpr double kAbsorption = 0.3;
  const Material material = cloth(8, kAbsorption);
  const SampledPairs sampled = sampled_pairs(5000, seed_from_environment());
  const std::vector<CostSetting> layers = of_dial(measured(material, sampled), "layers kept");
  REQUIRE(layers.size() == 8);
  for (std::size_t k = 1; k < layers.size(); ++k) {
    const double ratio = layers[k].error.rms / layers[k - 1].error.rms;
    INFO("layers kept " << k << ", ratio " << ratio);
    CHECK(ratio < 1);
    if (k == 1) continue;  // the first layer has one inner surface, all others two
    CHECK(ratio < std::exp(-2 * kAbsorption));  // down and up again through one layer more
    if (k < 6) CHECK(ratio > 0.7 * std::exp(-2 * kAbsorption));
  }
  const std::vector<Convergence> laws = convergence(material, layers);
  REQUIRE(laws.size() == 1);
  INFO("fitted ratio " << laws[0].fitted << ", expected " << laws[0].expected);
  std::cout << "absorbing cloth: fitted ratio " << laws[0].fitted << ", expected "
            << laws[0].expected << "\n";
  CHECK_FALSE(laws[0].differs);
  CHECK(laws[0].expected < std::exp(-2 * kAbsorption));
}

TEST_CASE("at most 8 numbers of layers are tried, spread from none to all but one") {
  const SampledPairs sampled = sampled_pairs(50, 1);
  for (const auto& [layers, settings] : {std::pair{0, 0U}, {1, 1U}, {2, 2U}, {64, 8U}}) {
    Material material = cloth(layers, 0.1);
    material.weft.layers = std::min(layers, 1);
    const std::vector<CostSetting> all = measured(material, sampled);
    CHECK(all.size() == fidelity_settings(material));
    const std::vector<CostSetting> kept = of_dial(all, "layers kept");
    REQUIRE(kept.size() == settings);
    if (kept.empty()) continue;
    CHECK(kept.front().size == 0);
    CHECK(kept.back().size == layers - 1);
  }
}

TEST_CASE("single paths are measured against all of them even where the material has single ones") {
  const SampledPairs sampled = sampled_pairs(2000, seed_from_environment());
  Material material = cloth(4, 0.1);
  const double error = of_dial(measured(material, sampled), "paths")[1].error.rms;
  material.paths = Paths::kSingle;
  const std::vector<CostSetting> settings = measured(material, sampled);
  CHECK(of_dial(settings, "paths")[0].error.rms == 0);
  CHECK(std::abs(of_dial(settings, "paths")[1].error.rms / error - 1) <= kOfError);
  CHECK(error > 1e-3);
}

TEST_CASE("path sums keep to their tolerances, and timings are in order") {
  const SampledPairs sampled = sampled_pairs(20000, seed_from_environment());
  Material material = cloth(4, 0.1);
  material.warp.scatter = material.weft.scatter = 0.1;
  const std::vector<CostSetting> settings =
      measure_fidelity(material, sampled, values_of(material, sampled), 3, 2);
  const std::vector<CostSetting> sums = of_dial(settings, "path sum");
  REQUIRE(sums.size() == 6);
  const std::vector<double> tolerances = {1e-1, 1e-2, 1e-3, 1e-4, 5e-6, 1e-12};
  for (std::size_t k = 0; k < sums.size(); ++k) {
    INFO(sums[k].name << ": rms " << sums[k].error.rms);
    CHECK(sums[k].error.rms <= tolerances[k]);
    CHECK(sums[k].error.rms > 0);
  }
  for (const CostSetting& setting : settings) {
    CHECK(setting.front == "evaluation");
    CHECK(setting.seconds.lowest > 0);
    CHECK(setting.seconds.lowest <= setting.seconds.median);
    CHECK(setting.seconds.median <= setting.seconds.highest);
  }
}

TEST_CASE("means over few rotations err against the mean over many") {
  const SampledPairs sampled = sampled_pairs(500, seed_from_environment());
  Material material = cloth(3, 0.2);
  material.rotation_deg = 20;
  const auto mean_of = [&](int steps) {
    std::vector<double> mean(sampled.pairs.size());
    for (int k = 0; k < steps; ++k) {
      Material turned = material;
      turned.rotation_deg += 180.0 * k / steps;
      const std::vector<double> values = values_of(turned, sampled);
      for (std::size_t p = 0; p < mean.size(); ++p) mean[p] += values[p] / steps;
    }
    return mean;
  };
  const std::vector<double> exact = mean_of(256);
  const std::vector<CostSetting> rotations = of_dial(measured(material, sampled), "rotations");
  REQUIRE(rotations.size() == 5);
  for (std::size_t k = 0; k < 3; ++k) {
    const double expected =
        table_error(sampled, exact, mean_of(static_cast<int>(rotations[k].size))).rms;
    INFO(rotations[k].name << ": " << rotations[k].error.rms << ", expected " << expected);
    CHECK(std::abs(rotations[k].error.rms / expected - 1) <= kOfError);
    CHECK(rotations[k + 1].error.rms < rotations[k].error.rms);
  }
  CHECK(rotations.back().size == 32);
  CHECK(rotations.back().error.rms < 1e-10);
}

}  // namespace clothbrdf::test
