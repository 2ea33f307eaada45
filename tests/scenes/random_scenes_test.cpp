#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <span>
#include <vector>

#include "model/reflectance.h"
#include "scene/planner.h"
#include "support/threads.h"
#include "tests/catch.h"
#include "tests/support/random_scene.h"

namespace clothbrdf::test {
namespace {

struct Seen {
  double error = 0;  ///< largest |f_plan - f_full| cos(theta_i) radiance
  double value = 0;  ///< largest f_full cos(theta_i) radiance
};

Seen seen_at(std::span<const ScenePair> pairs, const MaterialPlan& plan) {
  const ClothModel<double> full(plan.material);
  const ClothModel<double> planned(plan.material, plan.effects);
  const bool all = plan.effects == Effects{};
  Seen seen;
  for (const ScenePair& pair : pairs) {
    const PairGeometry<double> g =
        pair_geometry(pair.pair, plan.material.rotation_deg + pair.rotation_deg);
    const Components f = full.evaluate(g);
    const Components less = all ? f : planned.evaluate(g);
    for (std::size_t c = 0; c < full.channel_count(); ++c) {
      const std::vector<double>& radiance = pair.light->radiance;
      const double scale = g.cos_theta_i * radiance[radiance.size() == 1 ? 0 : c];
      seen.error = std::max(seen.error, std::abs(f.total(c) - less.total(c)) * scale);
      seen.value = std::max(seen.value, f.total(c) * scale);
    }
  }
  return seen;
}

Seen seen_in(RandomInputs& draw, const Scene& scene, const MaterialPlan& plan, int directions) {
  std::vector<ScenePair> pairs;
  for (int n = 0; n < directions; ++n) pairs.push_back(random_pair(draw, scene));
  constexpr std::size_t kParts = 8;
  const std::size_t size = pairs.size() / kParts;
  std::array<Seen, kParts> parts;
  run_parallel(kParts, 2, [&](std::size_t k) {
    parts[k] = seen_at(std::span(pairs).subspan(k * size, size), plan);
  });
  Seen seen;
  for (const Seen& part : parts) {
    seen.error = std::max(seen.error, part.error);
    seen.value = std::max(seen.value, part.value);
  }
  return seen;
}

}  // namespace

// CLOTHBRDF_SOAK_CASES draws more scenes.
TEST_CASE(
    "no pair of 200 random scenes errs by more than its plan's bound, nor that by more than "
    "the tolerance") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs draw(seed);
  std::vector<double> ratios;
  double closest = 0;
  double brightest_missed = 0;
  for (int n = 0; n < soak_cases(200); ++n) {
    const Scene scene = random_scene(draw);
    const Plan plan = make_plan(scene, 2);
    const MaterialPlan& cloth = plan.materials[0];
    constexpr int kDirections = 100000;
    // Where nothing changes, the brightest value alone is looked at.
    const int directions = cloth.effects == Effects{} ? kDirections / 50 : kDirections;
    const Seen seen = seen_in(draw, scene, cloth, directions);
    INFO("scene " << n << ", seed " << seed << ", bound " << plan.bound << ", brightest "
                  << plan.brightest);
    CHECK(seen.error <= plan.bound * plan.brightest);
    CHECK(plan.bound <= scene.tolerance);
    CHECK(seen.value <= 1.001 * plan.brightest);
    CHECK(seen.value <= plan.brightest_at_most);
    CHECK(plan.brightest <= plan.brightest_at_most);
    closest = std::max(closest, seen.error > 0 ? seen.error / (plan.bound * plan.brightest) : 0);
    brightest_missed = std::max(brightest_missed, seen.value / plan.brightest);
    if (seen.error > 0) ratios.push_back(plan.bound * plan.brightest / seen.error);
  }
  std::sort(ratios.begin(), ratios.end());
  REQUIRE(ratios.size() > 20);
  const double median = ratios[ratios.size() / 2];
  std::cout << "plans: largest error seen / bound " << closest << ", median bound / error "
            << median << " of " << ratios.size() << ", brightest seen / stated " << brightest_missed
            << " (seed " << seed << ")\n";
  CHECK(median <= 10);
}

}  // namespace clothbrdf::test
