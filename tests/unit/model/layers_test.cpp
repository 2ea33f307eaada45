#include "model/layers.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <iostream>
#include <numeric>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

// Every term of the sums is positive (model.md, section 5: 4e-15).
constexpr double kPositiveTerms = 4e-15;
// A walk of 512 steps, each multiplying twice: their roundings mostly cancel.
constexpr double kWalked = 5e-14;

Interface<double> interface_of(double r) { return {r, 1 - r, 0.9}; }

Yarn yarn_of(int layers, double scatter) {
  Yarn yarn;
  yarn.lobe_axes = {0.1, 0.4};
  yarn.absorption = {0.2};
  yarn.layers = layers;
  yarn.refractive_index = 1.5;
  yarn.scatter = scatter;
  return yarn;
}

std::vector<double> weights_of(const Yarn& yarn, Paths paths, const Interface<double>& interface,
                               double absorption) {
  std::vector<double> weights(static_cast<std::size_t>(lobe_count(yarn, paths)));
  path_weights(yarn, paths, interface, absorption, std::span<double>(weights));
  return weights;
}

double sum_of(const std::vector<double>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

TEST_CASE("without absorption a yarn reflects what Stokes' pile of plates does") {
  for (const int layers : {1, 2, 5, 17, 64}) {
    for (const double r : {1e-9, 0.01, 0.05, 0.4, 0.9, 0.999}) {
      const double exact = 2 * layers * r / (1 + (2 * layers - 1) * r);
      for (const double scatter : {0.0, 0.001, 0.3, 1.0}) {
        const std::vector<double> weights =
            weights_of(yarn_of(layers, scatter), Paths::kAll, interface_of(r), 0);
        CHECK(std::fabs(sum_of(weights) / exact - 1) <= kPositiveTerms);
      }
    }
  }
}

/// Follows every walk to its end, one branch after the other. `surface` is met next, from above if
/// `down`.
void follow(int layers, int surface, bool down, int events, double weight, double r, double passage,
            std::vector<double>& by_events) {
  if (surface == 0) {
    by_events[static_cast<std::size_t>(events)] += weight;
    return;
  }
  if (surface > 2 * layers || events + 1 >= static_cast<int>(by_events.size())) return;
  for (const bool reflects : {true, false}) {
    const bool goes_down = reflects != down;
    // Yarn lies between an odd surface and the next.
    const bool in_yarn = goes_down == (surface % 2 == 1);
    follow(layers, goes_down ? surface + 1 : surface - 1, goes_down, events + 1,
           weight * (reflects ? r : 1 - r) * (in_yarn ? passage : 1), r, passage, by_events);
  }
}

TEST_CASE("weights of all paths are those of every walk followed by itself") {
  const double r = 0.15;
  const double absorption = 0.3;
  const Interface<double> interface = interface_of(r);
  for (const int layers : {1, 2, 3}) {
    std::vector<double> followed(20, 0.0);
    // Light that is out again, or is back in the air above the first surface, is at "surface" 0.
    follow(layers, 1, true, 0, 1, r, std::exp(-absorption / interface.cos_theta_t), followed);
    const std::vector<double> weights =
        weights_of(yarn_of(layers, 0.01), Paths::kAll, interface, absorption);
    CHECK(weights[0] == r);
    for (std::size_t j = 1; j < 9; ++j) {
      CHECK(std::fabs(weights[j] - followed[2 * j + 1]) <= kPositiveTerms * followed[2 * j + 1]);
      CHECK(followed[2 * j] == 0);
    }
  }
}

/// Thousands of walks, added one by one.
constexpr double kManyTerms = 1e-12;

/// The same, by the number of reflections and events.
struct Followed {
  std::vector<double> far_sides;
  std::vector<double> near_sides;
  std::vector<double> interreflections;
};

void follow(int layers, int surface, bool down, int events, int reflections, bool far_side,
            double weight, double r, double passage, Followed& sums) {
  if (surface == 0) {
    auto& sum =
        reflections > 1 ? sums.interreflections : (far_side ? sums.far_sides : sums.near_sides);
    sum[static_cast<std::size_t>(events)] += weight;
    return;
  }
  if (surface > 2 * layers || events + 1 >= static_cast<int>(sums.far_sides.size())) return;
  for (const bool reflects : {true, false}) {
    const bool goes_down = reflects != down;
    const bool in_yarn = goes_down == (surface % 2 == 1);
    follow(layers, goes_down ? surface + 1 : surface - 1, goes_down, events + 1,
           reflections + (reflects ? 1 : 0), far_side || (reflects && surface % 2 == 0),
           weight * (reflects ? r : 1 - r) * (in_yarn ? passage : 1), r, passage, sums);
  }
}

TEST_CASE("without near sides or interreflections just those walks are missing") {
  const double r = 0.15;
  const double absorption = 0.3;
  const Interface<double> interface = interface_of(r);
  double worst = 0;
  for (const int layers : {1, 2, 3, 4}) {
    const std::vector<double> none(24, 0.0);
    Followed walks{none, none, none};
    follow(layers, 1, true, 0, 0, false, 1, r, std::exp(-absorption / interface.cos_theta_t),
           walks);
    for (const bool near_sides : {true, false}) {
      for (const int most : {0, 5, 9, 16, PathSet::kAnyEvents}) {
        const PathSet paths(near_sides, most);
        const Yarn yarn = yarn_of(layers, 0.01);
        std::vector<double> weights(static_cast<std::size_t>(lobe_count(yarn, paths)));
        path_weights(yarn, paths, interface, absorption, std::span<double>(weights));
        for (std::size_t j = 1; j < std::min<std::size_t>(11, weights.size()); ++j) {
          const std::size_t events = 2 * j + 1;
          double exact = walks.far_sides[events];
          // The surface reflection, one event, is no near side.
          if (near_sides) exact += walks.near_sides[events];
          if (static_cast<int>(events) <= most) exact += walks.interreflections[events];
          INFO(layers << " layers, near sides " << near_sides << ", events up to " << most << ", "
                      << events << " events: " << weights[j] << " for " << exact);
          CHECK(std::fabs(weights[j] - exact) <= kManyTerms * exact);
          worst = std::max(worst, exact > 0 ? std::fabs(weights[j] / exact - 1) : 0);
        }
      }
    }
  }
  std::cout << "walks left out: worst relative error " << worst << "\n";
}

TEST_CASE("sets of paths sum to the same however many lobes there are") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 300; ++n) {
    const int layers = draw.integer(1, n % 10 == 0 ? 64 : 6);
    const Interface<double> interface = fresnel(draw.uniform(0.01, 1), draw.uniform(1.01, 3));
    const double absorption = draw.chance(0.3) ? 0 : draw.log_uniform(1e-4, 3);
    const int most = draw.chance(0.5) ? PathSet::kAnyEvents : draw.integer(0, 200);
    const PathSet paths(draw.chance(0.5), most);
    const auto sum = [&](double scatter) {
      const Yarn yarn = yarn_of(layers, scatter);
      std::vector<double> weights(static_cast<std::size_t>(lobe_count(yarn, paths)));
      path_weights(yarn, paths, interface, absorption, std::span<double>(weights));
      return sum_of(weights);
    };
    const double few = sum(0);
    for (const double scatter : {1e-4, 0.3, 1.0}) {
      worst = std::max(worst, std::fabs(sum(scatter) / few - 1));
    }
    // All of them are what no set leaves out.
    const Yarn yarn = yarn_of(layers, 0);
    if (!paths.near_sides && most == PathSet::kAnyEvents) {
      std::vector<double> near(2, 0.0);
      add_near_sides(layers, interface, absorption, std::span<double>(near));
      const double all = sum_of(weights_of(yarn, Paths::kAll, interface, absorption));
      CHECK(std::fabs((few + near[1]) / all - 1) <= 1e-12);
    }
  }
  INFO("worst " << worst);
  CHECK(worst <= 1e-12);
}

TEST_CASE("however many lobes there are, the weights sum to the same") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 200; ++n) {
    const int layers = draw.integer(1, 64);
    const Interface<double> interface = fresnel(draw.uniform(0.01, 1), draw.uniform(1.01, 3));
    const double absorption = draw.chance(0.3) ? 0 : draw.log_uniform(1e-4, 3);
    const double few = sum_of(weights_of(yarn_of(layers, 0), Paths::kAll, interface, absorption));
    const double many =
        sum_of(weights_of(yarn_of(layers, 1e-4), Paths::kAll, interface, absorption));
    CHECK(std::fabs(many / few - 1) <= kWalked);
    CHECK(few <= 1);
  }
}

TEST_CASE("single paths weigh r t^(4k-2) A^(2k), one for each layer, and no more than all paths") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 200; ++n) {
    const Yarn yarn = yarn_of(draw.integer(1, 64), 0.01);
    const Interface<double> interface = fresnel(draw.uniform(0.05, 1), draw.uniform(1.1, 3));
    const double absorption = draw.uniform(0, 0.5);
    const std::vector<double> single = weights_of(yarn, Paths::kSingle, interface, absorption);
    REQUIRE(single.size() == static_cast<std::size_t>(2 * yarn.layers));
    for (int k = 1; k <= yarn.layers; ++k) {
      const Real t = interface.transmitted;
      const Real passed = exp(Real(-2 * k * Real(absorption) / interface.cos_theta_t));
      const Real exact = interface.reflected * pow(t, 4 * k - 2) * passed;
      if (exact < 1e-290) continue;
      // t carries its own rounding 4 k - 2 times, the exponent its own.
      const double allowed = (4 * k + 4 + 2 * k * absorption / interface.cos_theta_t) * 0x1p-52;
      const std::size_t j = static_cast<std::size_t>(2 * k - 1);
      CHECK(static_cast<double>(abs(Real(single[j] / exact - 1))) <= allowed);
      if (k < yarn.layers) CHECK(single[j + 1] == 0);
    }
    const double all = sum_of(weights_of(yarn, Paths::kAll, interface, absorption));
    CHECK(sum_of(single) <= all * (1 + kPositiveTerms));
    CHECK(all <= 1);
  }
}

TEST_CASE("a yarn has one lobe without layers, two without scatter or with all of it") {
  for (const Paths paths : {Paths::kAll, Paths::kSingle}) {
    CHECK(lobe_count(yarn_of(0, 0.5), paths) == 1);
    CHECK(lobe_count(yarn_of(5, 0), paths) == 2);
    CHECK(lobe_count(yarn_of(5, 1), paths) == 2);
  }
  CHECK(lobe_count(yarn_of(1, 0.01), Paths::kSingle) == 2);
  CHECK(lobe_count(yarn_of(6, 0.01), Paths::kSingle) == 12);
  CHECK(lobe_count(yarn_of(1, 1e-6), Paths::kAll) == kLastEvent / 2 + 1);
  // (1 - 0.5)^(2 j) falls below 1e-17 at j = 29.
  CHECK(lobe_count(yarn_of(1, 0.5), Paths::kAll) == 30);
}

TEST_CASE("axes go from the ellipse to the circle as (1 - scatter)^(E - 1), to the last digit") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 1000; ++n) {
    Yarn yarn = yarn_of(3, draw.log_uniform(1e-6, 0.999));
    yarn.lobe_axes = {draw.log_uniform(1e-6, 1), draw.log_uniform(1e-6, 1)};
    if (draw.chance(0.5)) yarn.scatter_limit = 1;
    const Real c = yarn.scatter_limit ? 1 : std::fmax(yarn.lobe_axes[0], yarn.lobe_axes[1]);
    const int j = draw.integer(1, 512);
    const Real q = pow(Real(1 - Real(yarn.scatter)), 2 * j);
    const LobeAxes<double> axes = lobe_axes(yarn, j);
    const Real along = c - (c - yarn.lobe_axes[0]) * q;
    const Real across = c - (c - yarn.lobe_axes[1]) * q;
    worst = std::max({worst, static_cast<double>(abs(Real(axes.along / along - 1))),
                      static_cast<double>(abs(Real(axes.across / across - 1)))});
  }
  CHECK(worst <= 1e-15);  // expm1, log1p and three roundings
}

TEST_CASE(
    "the surface reflection keeps the yarn's own axes, later light is round with all scatter") {
  const Yarn yarn = yarn_of(3, 1);
  CHECK(lobe_axes(yarn, 0).along == 0.1);
  CHECK(lobe_axes(yarn, 0).across == 0.4);
  CHECK(lobe_axes(yarn, 1).along == 0.4);
  CHECK(lobe_axes(yarn, 1).across == 0.4);
}

TEST_CASE("an endless path leaves nothing, or everything where nothing is absorbed") {
  CHECK(passage(0.0, 0.0).once == 1);
  CHECK(passage(0.0, 0.0).lost_twice == 0);
  CHECK(passage(0.1, 0.0).once == 0);
  CHECK(passage(0.1, 0.0).lost_twice == 1);
  CHECK(std::fabs(passage(1e-12, 0.5).lost_twice / 4e-12 - 1) <= 1e-11);
}

}  // namespace
}  // namespace clothbrdf::test
