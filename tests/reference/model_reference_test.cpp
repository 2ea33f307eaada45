#include <cmath>
#include <iostream>

#include "tests/catch.h"
#include "tests/reference/reference_model.h"
#include "tests/reference/worst_case.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

double flat_promise(std::size_t, const Material&, std::size_t, const ReferenceValues&) {
  return kPromise;
}

/// How often the draws met what needs care.
struct Coverage {
  int near_opposite = 0;  ///< azimuths more than 90 degrees apart
  int not_opposite = 0;
  int no_scatter = 0;        ///< scatter exactly 0
  int slow_scatter = 0;      ///< so slow that the last lobe is the 1025th event's
  int mostly_reflected = 0;  ///< Fresnel's r >= 1/2
  int special_azimuth = 0;   ///< a multiple of 30 degrees apart, exactly
  int exactly_opposite = 0;
  int limited = 0;  ///< scatter_limit given

  void count(const Material& material, const DirectionPair& pair, const ReferenceValues& exact) {
    const double apart = std::fabs(std::remainder(pair.phi_o - pair.phi_i, 360.0));
    ++(apart > 90 ? near_opposite : not_opposite);
    special_azimuth += std::fmod(apart, 30.0) == 0;
    exactly_opposite += apart == 180;
    for (const Yarn* yarn : {&material.warp, &material.weft}) {
      no_scatter += yarn->scatter == 0;
      slow_scatter += yarn->scatter > 0 && yarn->scatter < 0.03;
      limited += yarn->scatter_limit.has_value();
    }
    for (const Real& r : exact.fresnel_reflection) mostly_reflected += r >= 0.5;
  }
};

WorstCases worst_of(RandomInputs& draw, const MaterialRanges& ranges, int cases,
                    Coverage& coverage) {
  WorstCases worst;
  for (int n = 0; n < cases; ++n) {
    const Material material = draw.material(ranges);
    const DirectionPair pair = draw.pair();
    const ReferenceValues exact = reference_values(material, pair);
    coverage.count(material, pair, exact);
    compare_with_reference(material, pair, exact, flat_promise, worst);
  }
  return worst;
}

TEST_CASE("every component of the double model is within 1e-13 of 50 digits with up to 8 layers") {
  const std::uint64_t seed = seed_from_environment();
  const int cases = soak_cases(2000);
  RandomInputs draw(seed);
  Coverage coverage;
  const WorstCases worst = worst_of(draw, {}, cases, coverage);
  worst.print_to_cout("up to 8 layers, seed " + std::to_string(seed) + ", " +
                      std::to_string(cases) + " materials");
  std::cout << "  azimuths near opposite " << coverage.near_opposite << ", not "
            << coverage.not_opposite << ", multiples of 30 degrees " << coverage.special_azimuth
            << ", exactly opposite " << coverage.exactly_opposite << "; r >= 1/2 "
            << coverage.mostly_reflected << "; yarns without scatter " << coverage.no_scatter
            << ", with slow scatter " << coverage.slow_scatter << ", with a limit "
            << coverage.limited << '\n';
  CHECK(worst.largest() <= 1);
  // Nearly everything is compared: four variants of three channels, less what underflows.
  for (const WorstCase& component : worst.components) CHECK(component.compared >= 11L * cases);
  CHECK(coverage.near_opposite >= cases / 4);
  CHECK(coverage.not_opposite >= cases / 4);
  CHECK(coverage.special_azimuth >= cases / 50);
  CHECK(coverage.exactly_opposite >= cases / 400);
  CHECK(coverage.no_scatter >= cases / 4);
  CHECK(coverage.slow_scatter >= cases / 20);
  CHECK(coverage.mostly_reflected >= cases / 100);
  CHECK(coverage.limited >= cases / 4);
}

TEST_CASE("every component of the double model is within 1e-13 of 50 digits with up to 64 layers") {
  const std::uint64_t seed = seed_from_environment() + 1;
  // A soak has a fortieth of its materials this thick, as usual.
  const int cases = soak_cases(2000) / 40;
  RandomInputs draw(seed);
  Coverage coverage;
  MaterialRanges ranges;
  ranges.most_layers = 64;
  const WorstCases worst = worst_of(draw, ranges, cases, coverage);
  worst.print_to_cout("up to 64 layers, seed " + std::to_string(seed) + ", " +
                      std::to_string(cases) + " materials");
  CHECK(worst.largest() <= 1);
  for (const WorstCase& component : worst.components) CHECK(component.compared >= 11L * cases);
}

TEST_CASE("the promise holds for azimuths of any size") {
  RandomInputs draw(seed_from_environment() + 2);
  WorstCases worst;
  MaterialRanges ranges;
  ranges.most_layers = 2;
  for (int n = 0; n < 60; ++n) {
    Material material = draw.material(ranges);
    DirectionPair pair = draw.pair();
    const double size = std::pow(10.0, 3 + n % 13);
    pair.phi_i = size * draw.uniform(-1, 1);
    pair.phi_o = size * draw.uniform(-1, 1);
    material.rotation_deg = draw.chance(0.5) ? size * draw.uniform(-1, 1) : draw.uniform(-90, 90);
    compare_with_reference(material, pair, reference_values(material, pair), flat_promise, worst);
  }
  worst.print_to_cout("azimuths up to 1e15 degrees");
  CHECK(worst.largest() <= 1);
}

}  // namespace
}  // namespace clothbrdf::test
