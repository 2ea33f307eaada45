#include "model/effects.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// Sums of the same terms in another order.
constexpr double kSame = 1e-13;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

// Largest difference of two cloths' f_r at a pair, relative, over channels and components.
double difference(const ClothModel<double>& a, const ClothModel<double>& b,
                  const PairGeometry<double>& g) {
  const Components f = a.evaluate(g);
  const Components other = b.evaluate(g);
  double largest = 0;
  const auto compare = [&](const std::vector<double>& of_a, const std::vector<double>& of_b) {
    for (std::size_t c = 0; c < of_a.size(); ++c) {
      if (of_a[c] == of_b[c]) continue;
      largest = std::max(
          largest, std::abs(of_a[c] - of_b[c]) / std::max(std::abs(of_a[c]), std::abs(of_b[c])));
    }
  };
  compare(f.specular, other.specular);
  compare(f.internal, other.internal);
  compare(f.diffuse, other.diffuse);
  return largest;
}

using Change = void (*)(Material&, RandomInputs&);

// A cloth without an effect is another cloth, by its material alone.
void check_same_as(const std::vector<std::string>& words, Change change) {
  RandomInputs draw(seed_from_environment());
  std::string problem;
  const std::optional<Effects> effects = effects_from_words(words, problem);
  REQUIRE(effects);
  double worst = 0;
  double seen = 0;
  for (int n = 0; n < 200; ++n) {
    Material material = draw.material({});
    material.paths = Paths::kAll;
    const ClothModel<double> without(material, *effects);
    const ClothModel<double> whole(material);
    change(material, draw);
    const PairGeometry<double> g = pair_geometry(draw.pair(), material.rotation_deg);
    worst = std::max(worst, difference(without, ClothModel<double>(material), g));
    seen = std::max(seen, difference(without, whole, g));
  }
  INFO(joined(words) << ": worst " << worst << ", changes up to " << seen);
  CHECK(worst <= kSame);
  CHECK(seen > 0.01);
}

}  // namespace

TEST_CASE("effects that a material can do without are those of another material") {
  check_same_as({"internal", "diffuse"},
                [](Material& m, RandomInputs&) { m.weights.specular = 0; });
  check_same_as({"no-diffuse"}, [](Material& m, RandomInputs&) { m.weights.diffuse = 0; });
  check_same_as({"specular", "diffuse"},
                [](Material& m, RandomInputs&) { m.warp.layers = m.weft.layers = 0; });
  check_same_as({"specular", "internal:2", "diffuse"}, [](Material& m, RandomInputs&) {
    m.warp.layers = std::min(m.warp.layers, 2);
    m.weft.layers = std::min(m.weft.layers, 2);
  });
  check_same_as({"no-scatter"},
                [](Material& m, RandomInputs&) { m.warp.scatter = m.weft.scatter = 0; });
  check_same_as({"no-near_side", "no-interreflection"},
                [](Material& m, RandomInputs&) { m.paths = Paths::kSingle; });
  check_same_as({"no-colour"}, [](Material& m, RandomInputs&) {
    for (Yarn* yarn : {&m.warp, &m.weft}) {
      double sum = 0;
      for (const double a : yarn->absorption) sum += a;
      for (double& a : yarn->absorption) a = sum / 3;
    }
  });
}

TEST_CASE("without the second yarn the larger share is left, not rescaled") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 100; ++n) {
    Material material = draw.material({});
    if (n % 5 == 0) material.warp_fraction = 0.5;
    const double warp = material.warp_fraction;
    Effects effects;
    effects.second_yarn = false;
    const PairGeometry<double> g = pair_geometry(draw.pair(), material.rotation_deg);
    const Components f = ClothModel<double>(material, effects).evaluate(g);
    const double share = std::max(warp, 1 - warp);
    material.warp_fraction = warp >= 0.5 ? 1 : 0;
    const Components alone = ClothModel<double>(material).evaluate(g);
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(std::abs(f.total(c) - share * alone.total(c)) <= kSame * alone.total(c));
    }
  }
}

TEST_CASE("without anisotropy f is its mean over the azimuth of the half vector") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 20; ++n) {
    MaterialRanges ranges;
    ranges.lowest_axis = 0.2;  // so that few azimuths do
    const Material material = draw.material(ranges);
    Effects effects;
    effects.anisotropy = false;
    const ClothModel<double> model(material);
    const DirectionPair pair = draw.pair();
    const Components f =
        ClothModel<double>(material, effects).evaluate(pair_geometry(pair, material.rotation_deg));
    constexpr int kAzimuths = 720;
    std::vector<double> mean(3, 0.0);
    for (int k = 0; k < kAzimuths; ++k) {
      const Components one = model.evaluate(pair_geometry(pair, 360.0 * k / kAzimuths));
      for (std::size_t c = 0; c < 3; ++c) mean[c] += one.total(c) / kAzimuths;
    }
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(f.total(c) - mean[c]) / mean[c]);
  }
  INFO("worst " << worst);
  CHECK(worst <= 1e-10);
}

TEST_CASE("without shadowing G is 1, without Fresnel's angle its cosine is as given") {
  RandomInputs draw(seed_from_environment());
  int shadowed = 0;
  for (int n = 0; n < 200; ++n) {
    Material material = draw.material({});
    material.reflectance = Reflectance::kMicrofacet;
    const PairGeometry<double> g = pair_geometry(draw.pair(), material.rotation_deg);
    const Components f = ClothModel<double>(material).evaluate(g);
    Effects effects;
    effects.shadowing = false;
    const Components open = ClothModel<double>(material, effects).evaluate(g);
    const double lower = std::min(g.cos_theta_i, g.cos_theta_o);
    const double visible = std::min(1.0, 2 * g.h_n * lower / g.cos_theta_d);
    shadowed += visible < 1 ? 1 : 0;
    effects = {};
    effects.cos_theta_d = g.cos_theta_d;
    const Components same = ClothModel<double>(material, effects).evaluate(g);
    effects.cos_theta_d = 0.3;
    const Components other = ClothModel<double>(material, effects).evaluate(g);
    const double ratio = fresnel(0.3, material.warp.refractive_index).reflected /
                         fresnel(g.cos_theta_d, material.warp.refractive_index).reflected;
    const bool one_index = material.warp.refractive_index == material.weft.refractive_index;
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(std::abs(open.specular[c] * visible - f.specular[c]) <= 4 * kSame * f.specular[c]);
      CHECK(std::abs(open.internal[c] * visible - f.internal[c]) <= 4 * kSame * f.internal[c]);
      CHECK(same.total(c) == f.total(c));
      if (one_index) CHECK(std::abs(other.specular[c] / f.specular[c] / ratio - 1) <= 4 * kSame);
      CHECK(other.internal[c] != f.internal[c]);
    }
  }
  CHECK(shadowed > 20);
}

TEST_CASE("what a cloth never had can be switched off to the last bit") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 50; ++n) {
    Material material = draw.material({});
    material.paths = Paths::kSingle;
    material.warp_fraction = 1;
    for (Yarn* yarn : {&material.warp, &material.weft}) {
      yarn->scatter = 0;
      std::fill(yarn->absorption.begin(), yarn->absorption.end(), 0.1 * n);
    }
    Effects effects;
    effects.scatter = effects.colour = effects.second_yarn = false;
    effects.near_side = effects.interreflection = false;
    const PairGeometry<double> g = pair_geometry(draw.pair(), material.rotation_deg);
    CHECK(difference(ClothModel<double>(material), ClothModel<double>(material, effects), g) == 0);
  }
}

TEST_CASE("effects and their words say the same") {
  RandomInputs draw(seed_from_environment());
  std::string problem;
  for (int n = 0; n < 500; ++n) {
    Effects effects = draw.effects();
    if (!effects.internal) effects.layers.reset();         // nothing to limit
    if (!effects.interreflection) effects.events.reset();  // nor here
    INFO(joined(effect_words(effects)));
    const std::optional<Effects> read = effects_from_words(effect_words(effects), problem);
    REQUIRE(read);
    CHECK(*read == effects);
  }
  CHECK(joined(effect_words({})) == "specular,internal,diffuse");
  CHECK(effects_from_words({"internal:4", "no-scatter"}, problem) ==
        Effects{.specular = false, .diffuse = false, .scatter = false, .layers = 4});
  CHECK(effects_from_words({"no-fresnel_angle=0.8"}, problem) == Effects{.cos_theta_d = 0.8});
}

TEST_CASE("words that are no effects, and effects that contradict themselves, are named") {
  const auto problem_of = [](const std::vector<std::string>& words) {
    std::string problem;
    CHECK(!effects_from_words(words, problem));
    return problem;
  };
  for (const char* word : {"", "shine", "no-shine", "internal:65", "internal:-1", "internal:two",
                           "interreflection:0", "interreflection:1026", "specular:2",
                           "no-fresnel_angle", "no-fresnel_angle=1.5", "no-fresnel_angle=nan"}) {
    INFO(word);
    CHECK(problem_of({word}).find("'" + std::string(word) + "'") == 0);
  }
  CHECK(problem_of({"specular", "no-specular"}) == "'no-specular' contradicts another word");
  CHECK(problem_of({"no-scatter", "scatter"}) == "'scatter' contradicts another word");
}

}  // namespace clothbrdf::test
