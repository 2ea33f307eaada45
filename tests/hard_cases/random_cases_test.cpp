#include <cmath>
#include <iostream>

#include "tests/catch.h"
#include "tests/hard_cases/hard_promise.h"
#include "tests/reference/reference_model.h"
#include "tests/reference/worst_case.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

double hard_index(RandomInputs& draw) {
  if (draw.chance(0.1)) return 1 + 1e-12;
  return draw.chance(0.3) ? 1 + draw.log_uniform(1e-12, 0.1) : draw.uniform(1, 2.9);
}

MaterialRanges hard_ranges() {
  MaterialRanges ranges;
  ranges.lowest_axis = 1e-3;
  ranges.highest_absorption = 40;
  ranges.highest_scatter = 1;
  ranges.most_layers = 64;
  return ranges;
}

TEST_CASE(
    "hard materials keep the promise: axes from 1e-3, index from 1 + 1e-12, absorption to 40") {
  const std::uint64_t seed = seed_from_environment() + 3;
  RandomInputs draw(seed);
  WorstCases worst;
  int nearly_one = 0;
  int beyond = 0;
  for (int n = 0; n < 120; ++n) {
    Material material = draw.material(hard_ranges());
    for (Yarn* yarn : {&material.warp, &material.weft}) yarn->refractive_index = hard_index(draw);
    const DirectionPair pair = draw.pair();
    const ReferenceValues exact = reference_values(material, pair);
    nearly_one += material.warp.refractive_index < 1 + 1e-6;
    for (std::size_t c = 0; c < 3; ++c) beyond += hard_promise(1, material, c, exact) > kPromise;
    compare_with_reference(material, pair, exact, hard_promise, worst);
  }
  worst.print_to_cout("hard materials, seed " + std::to_string(seed));
  CHECK(worst.largest() <= 1);
  CHECK(nearly_one >= 10);
  CHECK(beyond >= 1);
}

TEST_CASE("an axis of 1e-6 costs 4e-16 over the half vector's lean along it, or over the axis") {
  // The half vector's coordinate along the yarn is known to about 1e-16 where it leans far across
  // it, and the axis magnifies that: beside the lobe's crest no double model can do better.
  // Measured: 3e-14 for random pairs, 5e-11 on the crest.
  constexpr double kAxis = 1e-6;
  const std::uint64_t seed = seed_from_environment() + 4;
  RandomInputs draw(seed);
  WorstCases anywhere;
  WorstCases crest;
  MaterialRanges ranges;
  ranges.most_layers = 4;
  DirectionPair pair;
  const auto promised = [&](std::size_t, const Material& material, std::size_t,
                            const ReferenceValues&) {
    const PairGeometry<double> g = pair_geometry<double>(pair, material.rotation_deg);
    const double lean = std::fmin(std::fabs(g.h_weft), std::fabs(g.h_warp));
    return kPromise + 4e-16 / std::fmax(lean, kAxis);
  };
  for (int n = 0; n < 60; ++n) {
    Material material = draw.material(ranges);
    material.warp.lobe_axes[0] = kAxis;
    material.weft.lobe_axes[0] = kAxis;
    pair = {draw.uniform(0, 89.9), draw.azimuth(), draw.uniform(0, 89.9), draw.azimuth()};
    compare_with_reference(material, pair, reference_values(material, pair), promised, anywhere);
    // The weave turned so that the half vector leans across the warp, a few axes off its crest.
    pair.phi_i = draw.uniform(-180, 180);
    pair.phi_o = pair.phi_i + draw.uniform(-80, 80);
    const PairGeometry<double> g = pair_geometry<double>(pair, 0.0);
    material.rotation_deg =
        std::atan2(g.h_warp, g.h_weft) * 180 / pi<double>() + draw.log_uniform(1e-5, 1e-3);
    compare_with_reference(material, pair, reference_values(material, pair), promised, crest);
  }
  anywhere.print_to_cout("axes of 1e-6, seed " + std::to_string(seed));
  crest.print_to_cout("axes of 1e-6, on the crest");
  CHECK(anywhere.largest() <= 1);
  CHECK(crest.largest() <= 1);
}

TEST_CASE("a cloth of index 1 reflects nothing but diffuse light") {
  RandomInputs draw(seed_from_environment() + 5);
  for (int n = 0; n < 40; ++n) {
    Material material = draw.material(hard_ranges());
    material.warp.refractive_index = material.weft.refractive_index = 1;
    const DirectionPair pair = draw.pair();
    const Components f =
        ClothModel<double>(material).evaluate(pair_geometry<double>(pair, material.rotation_deg));
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(f.specular[c] == 0);
      CHECK(f.internal[c] == 0);
    }
    CHECK(f.diffuse[0] > 0);
  }
}

}  // namespace
}  // namespace clothbrdf::test
