#include "scene/planner.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/random_scene.h"

namespace clothbrdf::test {
namespace {

Scene simple_scene() {
  RandomInputs draw(1);
  Scene scene;
  scene.materials = {draw.material({})};
  scene.materials[0].reflectance = Reflectance::kMicrofacet;
  scene.lights = {{{{0, 60}, {0, 360}}, {1}}};
  scene.eyes = {{{0, 60}, {0, 360}}};
  scene.tolerance = 0.01;
  return scene;
}

}  // namespace

TEST_CASE("a plan at tolerance 0 leaves out only what contributes nothing") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 20; ++n) {
    Scene scene = random_scene(draw);
    scene.tolerance = 0;
    scene.materials[0].paths = Paths::kSingle;
    if (n % 2 == 0) scene.materials[0].warp_fraction = 1;
    const Plan plan = make_plan(scene, 2);
    CHECK(plan.bound == 0);
    CHECK(plan.materials[0].effects == Effects{});
    for (const LeftOut& out : plan.materials[0].left_out) CHECK(out.bound == 0);
    const auto& out = plan.materials[0].left_out;
    const auto names = [&](const char* effect) {
      return std::any_of(out.begin(), out.end(),
                         [&](const LeftOut& o) { return o.effect == effect; });
    };
    CHECK(names("interreflection"));
    CHECK(names("second_yarn") == (n % 2 == 0));
  }
}

TEST_CASE("a plan of several cloths is one of each, against the brightest of all") {
  Scene scene = simple_scene();
  scene.materials.push_back(scene.materials[0]);
  Weights& dark = scene.materials[1].weights;
  dark = {1e-3 * dark.specular, 1e-3 * dark.internal, 1e-3 * dark.diffuse};
  const Plan plan = make_plan(scene, 2);
  REQUIRE(plan.materials.size() == 2);
  CHECK(plan.materials[1].brightest <= 1.01e-3 * plan.brightest);
  CHECK(plan.brightest == plan.materials[0].brightest);
  // All of the dark one is below the tolerance.
  CHECK(plan.materials[1].kept.size() < plan.materials[0].kept.size());
}

TEST_CASE("scenes that contradict themselves are refused by the name of the field") {
  const auto pointer = [](const auto& change) {
    Scene scene = simple_scene();
    CHECK(!find_problem(scene));
    change(scene);
    const std::optional<SceneProblem> problem = find_problem(scene);
    CHECK_THROWS_AS(make_plan(scene, 1), std::invalid_argument);
    return problem ? problem->pointer : "none";
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(pointer([](Scene& s) { s.tolerance = -0.1; }) == "/tolerance");
  CHECK(pointer([&](Scene& s) { s.tolerance = nan; }) == "/tolerance");
  CHECK(pointer([](Scene& s) { s.tolerance = 1.5; }) == "/tolerance");
  CHECK(pointer([](Scene& s) { s.eyes[0].theta_deg = {0, 100}; }) == "/eyes/0/theta_deg");
  CHECK(pointer([](Scene& s) { s.eyes[0].theta_deg = {30, 20}; }) == "/eyes/0/theta_deg");
  CHECK(pointer([](Scene& s) { s.lights[0].from.phi_deg = {30, 20}; }) == "/lights/0/phi_deg");
  CHECK(pointer([](Scene& s) { s.lights[0].from.phi_deg = {0, 361}; }) == "/lights/0/phi_deg");
  CHECK(pointer([&](Scene& s) { s.lights[0].from.theta_deg.low = nan; }) == "/lights/0/theta_deg");
  CHECK(pointer([](Scene& s) { s.lights[0].radiance = {0}; }) == "/lights");
  CHECK(pointer([](Scene& s) { s.lights[0].radiance = {1, 2}; }) == "/lights/0/radiance");
  CHECK(pointer([](Scene& s) { s.lights[0].radiance = {-1}; }) == "/lights/0/radiance");
  CHECK(pointer([](Scene& s) { s.materials.clear(); }) == "/materials");
  CHECK(pointer([](Scene& s) { s.lights.clear(); }) == "/lights");
  CHECK(pointer([](Scene& s) { s.eyes.clear(); }) == "/eyes");
  CHECK(pointer([](Scene& s) { s.rotations_deg.clear(); }) == "/rotations_deg");
  CHECK(pointer([&](Scene& s) { s.rotations_deg = {0, nan}; }) == "/rotations_deg/1");
  CHECK(pointer([](Scene& s) { s.materials[0].warp.scatter = 2; }) == "/materials/0/warp/scatter");
  CHECK(pointer([](Scene& s) {
          s.lights[0].from.theta_deg = {0, 90};
          s.eyes[0].theta_deg = {0, 90};
        }) == "/eyes/0/theta_deg");
}

}  // namespace clothbrdf::test
