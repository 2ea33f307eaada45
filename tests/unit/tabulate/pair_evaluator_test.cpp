#include "tabulate/pair_evaluator.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {

TEST_CASE("a pair evaluator gives the model's f_r, channel by channel, at the cosine of an index") {
  // Sums over lobes in another order: a few roundings each.
  constexpr double kSameToRounding = 2e-13;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  int compared = 0;
  for (int n = 0; n < 40; ++n) {
    const Material material = random.material({}, 4);
    const ClothModel<double> model(material);
    std::vector<PairGeometry<double>> pairs;
    std::vector<double> cosines;
    for (int k = 0; k < 8; ++k) {
      pairs.push_back(pair_geometry(random.pair(), material.rotation_deg));
      cosines.push_back(pairs.back().cos_theta_d);
    }
    const PathMatrix paths(model, cosines, 1);
    PairEvaluator evaluator(model, paths);
    const std::vector<Channel> channels = {{"last", Part::kTotal, 3},
                                           {"first", Part::kSpecular, 0},
                                           {"third", Part::kInternal, 2},
                                           {"second", Part::kDiffuse, 1}};
    std::vector<double> values(channels.size());
    for (std::size_t k = pairs.size(); k-- > 0;) {
      if (!pairs[k].above_horizon()) continue;
      evaluator.evaluate(pairs[k], k, channels, values);
      const Components f = model.evaluate(pairs[k]);
      const std::vector<double> exact = {f.total(3), f.specular[0], f.internal[2], f.diffuse[1]};
      for (std::size_t c = 0; c < exact.size(); ++c) {
        worst = std::max(worst,
                         exact[c] == 0 ? std::abs(values[c]) : std::abs(values[c] / exact[c] - 1));
        ++compared;
      }
    }
  }
  std::cout << "pair evaluator against the model: worst relative error " << worst << " of "
            << compared << " (seed " << seed << ")\n";
  CHECK(worst <= kSameToRounding);
  CHECK(compared > 1000);
}

}  // namespace clothbrdf::test
