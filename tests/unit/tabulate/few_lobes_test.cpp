#include "tabulate/few_lobes.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

double density(const Lobe<double>& lobe, double along, double across, double normal) {
  return lobe_height(along, across, normal, lobe.axes) / (normal * lobe.norm);
}

// The internal light of weights, by all lobes of the yarn and by the few.
double lobe_error(const PreparedYarn<double>& yarn, const FewLobes& few,
                  const std::vector<double>& weights, RandomInputs& random) {
  const double tilt = std::atan(random.log_uniform(1e-4, 1e3));
  const double azimuth = random.uniform(0, 2 * pi<double>());
  const double along = std::sin(tilt) * std::cos(azimuth);
  const double across = std::sin(tilt) * std::sin(azimuth);
  double all = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    all += weights[j] * density(yarn.lobes[j + 1], along, across, std::cos(tilt));
  }
  std::vector<double> collapsed(few.lobes.size());
  few.collapse(weights, collapsed);
  double sum = 0;
  for (std::size_t k = 0; k < collapsed.size(); ++k) {
    sum += collapsed[k] * density(few.lobes[k], along, across, std::cos(tilt));
  }
  return std::abs(sum / all - 1);
}

}  // namespace

TEST_CASE("few lobes stand for all lobes of a yarn at any half vector, to the tolerance") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  MaterialRanges ranges;
  ranges.lowest_axis = 1e-3;
  ranges.most_layers = 64;
  for (const double tolerance : {1e-6, 3e-13}) {
    double worst = 0;
    std::size_t most = 0;
    int collapsed = 0;
    int beyond = 0;  // the tolerance, with the most lobes
    double largest = 0;
    for (int n = 0; n < 25; ++n) {
      Material material = random.material(ranges, 1);
      material.paths = Paths::kAll;
      const ClothModel<double> model(material);
      const PreparedYarn<double>& yarn = model.yarns()[0];
      const FewLobes few = few_lobes(yarn, material.reflectance, tolerance);
      if (few.error > tolerance) {
        CHECK(few.lobes.size() == kMostFewLobes);
        ++beyond;
      }
      largest = std::max(largest, few.error);
      most = std::max(most, few.lobes.size());
      collapsed += few.lobes.size() + 1 < yarn.lobes.size();
      for (int k = 0; k < 100; ++k) {
        std::vector<double> weights;
        for (std::size_t j = 1; j < yarn.lobes.size(); ++j) weights.push_back(random.unit());
        worst = std::max(worst, lobe_error(yarn, few, weights, random));
      }
    }
    std::cout << "few lobes at " << tolerance << ": worst " << worst << ", at most " << most
              << " lobes (seed " << seed << ")\n";
    // Between the half vectors that the choice was tested at, and roundings of sums of both signs.
    constexpr double kRounding = 5e-13;
    CHECK(worst <= 1.5 * largest + kRounding);
    CHECK(most <= kMostFewLobes);
    CHECK(collapsed > 10);
    CHECK(beyond <= (tolerance < 1e-10 ? 3 : 0));
  }
}

TEST_CASE("a yarn with few lobes keeps them, one whose lobes are all the same needs one") {
  RandomInputs random(seed_from_environment());
  Material material = random.material({}, 1);
  material.warp.layers = 0;
  const auto few = [&](const Material& m) {
    return few_lobes(ClothModel<double>(m).yarns()[0], m.reflectance, 1e-6);
  };
  CHECK(few(material).lobes.empty());
  material.warp.layers = 5;
  material.warp.scatter = 0;
  CHECK(few(material).lobes.size() == 1);
  CHECK(few(material).error == 0);
  material.warp.lobe_axes = {0.5, 0.5};
  material.warp.scatter = 0.3;
  material.warp.scatter_limit = 0.5;
  CHECK(few(material).lobes.size() == 1);
}

}  // namespace clothbrdf::test
