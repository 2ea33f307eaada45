#include "model/reflectance.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

// Model.md, section 9.
constexpr double kModelPromise = 1e-13;
/// Reciprocity: both orders go through the same formulas, only their roundings differ.
constexpr double kReciprocity = 1e-14;

Components evaluate(const Material& material, const DirectionPair& pair) {
  return ClothModel<double>(material).evaluate(pair_geometry<double>(pair, material.rotation_deg));
}

double relative(double value, double other) {
  return value == other ? 0 : std::fabs(value / other - 1);
}

TEST_CASE("the microfacet convention is reciprocal to 1e-14, the paper's is not") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  int paper_differs = 0;
  int shadowed = 0;
  for (int n = 0; n < 1000; ++n) {
    Material material = draw.material({});
    const DirectionPair pair = draw.pair();
    const DirectionPair swapped = {pair.theta_o, pair.phi_o, pair.theta_i, pair.phi_i};
    material.reflectance = Reflectance::kMicrofacet;
    const PairGeometry<double> g = pair_geometry<double>(pair, 0.0);
    shadowed += 2 * g.h_n * std::fmin(g.cos_theta_i, g.cos_theta_o) < g.cos_theta_d;
    const Components f = evaluate(material, pair);
    const Components back = evaluate(material, swapped);
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max({worst, relative(f.specular[c], back.specular[c]),
                        relative(f.internal[c], back.internal[c]),
                        relative(f.diffuse[c], back.diffuse[c])});
    }
    material.reflectance = Reflectance::kPaper;
    paper_differs += relative(evaluate(material, pair).specular[0],
                              evaluate(material, swapped).specular[0]) > 0.01;
  }
  INFO("worst " << worst);
  CHECK(worst <= kReciprocity);
  CHECK(shadowed > 100);
  CHECK(shadowed < 900);
  CHECK(paper_differs > 500);
}

TEST_CASE("f does not change when both directions turn by half a turn, or with the cloth") {
  RandomInputs draw(seed_from_environment());
  double half_turn = 0;
  double with_cloth = 0;
  for (int n = 0; n < 500; ++n) {
    Material material = draw.material({});
    material.rotation_deg = draw.integer(-720, 720);  // exact sums with the turns below
    DirectionPair pair = draw.pair();
    pair.phi_i = draw.integer(-720, 720);
    pair.phi_o = draw.integer(-720, 720);
    const Components f = evaluate(material, pair);
    const Components half =
        evaluate(material, {pair.theta_i, pair.phi_i + 180, pair.theta_o, pair.phi_o + 180});
    const double turn = draw.integer(1, 359);
    material.rotation_deg += turn;
    const Components whole =
        evaluate(material, {pair.theta_i, pair.phi_i + turn, pair.theta_o, pair.phi_o + turn});
    for (std::size_t c = 0; c < 3; ++c) {
      half_turn = std::max(half_turn, relative(f.total(c), half.total(c)));
      with_cloth = std::max(with_cloth, relative(f.total(c), whole.total(c)));
    }
  }
  CHECK(half_turn <= kReciprocity);
  CHECK(with_cloth <= kModelPromise);
}

TEST_CASE("f is 0 on the horizon and below it, positive above") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 40; ++n) {
    const Material material = draw.material({});
    for (const double theta : {90.0, 90.001, 135.0, 180.0}) {
      const double other = draw.uniform(0, 180);
      for (const DirectionPair& pair :
           {DirectionPair{theta, 10, other, 40}, DirectionPair{other, 10, theta, 40}}) {
        const Components f = evaluate(material, pair);
        REQUIRE(f.specular.size() == 3);
        for (std::size_t c = 0; c < 3; ++c) CHECK(f.total(c) == 0);
      }
    }
    CHECK(evaluate(material, {89.999, 10, 89.999, 40}).total(0) > 0);
  }
}

TEST_CASE("swapping the yarns and turning the cloth by 90 degrees changes nothing") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 200; ++n) {
    Material material = draw.material({});
    material.rotation_deg = 17;
    Material swapped = material;
    std::swap(swapped.warp, swapped.weft);
    swapped.warp_fraction = 1 - material.warp_fraction;
    swapped.rotation_deg = 107;
    const DirectionPair pair = {draw.uniform(0, 80), draw.uniform(0, 360), draw.uniform(0, 80),
                                draw.uniform(0, 360)};
    CHECK(relative(evaluate(material, pair).total(1), evaluate(swapped, pair).total(1)) <=
          kModelPromise);
  }
}

TEST_CASE("a mirror pair of a one-yarn cloth has the values of section 7 written out") {
  Material material;
  material.weights = {2, 3, 0.5};
  material.diffuse_path = 2;
  material.warp_fraction = 0.25;
  material.warp = {{1, 1}, {0.1}, 1, 1.5, 0, std::nullopt};
  material.weft = material.warp;
  const double internal = 0.04 * 0.96 * 0.96 * std::exp(-0.2);  // far side of the one layer
  const double norm = 2 * pi<double>() / 3 * 4;                 // Z times 4 cos cos
  material.paths = Paths::kSingle;
  const Components f = evaluate(material, {0, 0, 0, 0});
  CHECK(relative(f.specular[0], 2 * 0.04 / norm) <= kReciprocity);
  CHECK(relative(f.internal[0], 3 * internal / norm) <= kReciprocity);
  CHECK(relative(f.diffuse[0], 0.5 * std::exp(-0.2) / pi<double>()) <= kReciprocity);
  material.reflectance = Reflectance::kPaper;
  const Components paper = evaluate(material, {0, 0, 0, 0});
  CHECK(relative(paper.specular[0], 2 * 0.04) <= kReciprocity);
  CHECK(relative(paper.internal[0], 3 * internal) <= kReciprocity);
  CHECK(relative(paper.diffuse[0], 0.5 * std::exp(-0.2)) <= kReciprocity);
}

TEST_CASE("an effect that is off leaves the other components as they are") {
  RandomInputs draw(seed_from_environment());
  const Material material = draw.material({});
  const PairGeometry<double> g =
      pair_geometry<double>(DirectionPair{30, 20, 50, 170}, material.rotation_deg);
  const Components all = ClothModel<double>(material).evaluate(g);
  const Components no_specular = ClothModel<double>(material, {false, true, true}).evaluate(g);
  const Components no_internal = ClothModel<double>(material, {true, false, true}).evaluate(g);
  const Components no_diffuse = ClothModel<double>(material, {true, true, false}).evaluate(g);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(no_specular.specular[c] == 0);
    CHECK(no_specular.internal[c] == all.internal[c]);
    CHECK(no_internal.internal[c] == 0);
    CHECK(no_internal.specular[c] == all.specular[c]);
    CHECK(no_internal.diffuse[c] == all.diffuse[c]);
    CHECK(no_diffuse.diffuse[c] == 0);
    CHECK(no_diffuse.internal[c] == all.internal[c]);
  }
}

TEST_CASE("the directional factor neither exceeds 1 / (2 x^2) nor overflows at grazing incidence") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 1000; ++n) {
    const DirectionPair pair = draw.pair();
    const PairGeometry<double> g = pair_geometry<double>(pair, 0.0);
    const double x = g.cos_theta_d;
    const double s =
        directional_factor(Reflectance::kMicrofacet, g.h_n, x, g.cos_theta_i, g.cos_theta_o);
    CHECK(s <= (1 + kReciprocity) / (2 * x * x));
    const double shadowing =
        std::min({1.0, 2 * g.h_n * g.cos_theta_i / x, 2 * g.h_n * g.cos_theta_o / x});
    CHECK(relative(s, shadowing / (4 * g.cos_theta_i * g.cos_theta_o)) <= kReciprocity);
  }
  CHECK(std::isfinite(directional_factor(Reflectance::kMicrofacet, 1e-3, 0.7, 1e-300, 1.0)));
}

}  // namespace
}  // namespace clothbrdf::test
