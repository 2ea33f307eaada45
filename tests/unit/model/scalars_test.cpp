// Every scalar that the model promises, through ClothModel<T>::evaluate: float, double, ceres::Jet
// and 50 digits.

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "tests/catch.h"
#include "tests/support/flat_cloth.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

/// The values are floats, so that every scalar gets the same input.
Parameters draw_parameters(RandomInputs& draw) {
  Parameters p{};
  for (const std::size_t y : {std::size_t{0}, kWeft}) {
    p[y + 0] = draw.log_uniform(0.05, 1);
    p[y + 1] = draw.log_uniform(0.05, 1);
    p[y + 2] = draw.uniform(0.01, 2);
    p[y + 3] = draw.uniform(1.2, 2);
    p[y + kScatter] = draw.uniform(0.15, 0.6);
  }
  const std::array<double, 10> shared = {draw.uniform(0.1, 2),   draw.uniform(0.1, 2),
                                         draw.uniform(0.1, 2),   draw.uniform(0.1, 3),
                                         draw.uniform(0.1, 0.9), draw.uniform(-180, 180),
                                         draw.uniform(1, 85),    draw.uniform(-180, 180),
                                         draw.uniform(1, 85),    draw.uniform(-180, 180)};
  std::copy(shared.begin(), shared.end(), p.begin() + kShared);
  for (double& value : p) value = static_cast<double>(static_cast<float>(value));
  return p;
}

Variant variant_of(RandomInputs& draw, int n) {
  return {n % 2 == 0 ? Reflectance::kMicrofacet : Reflectance::kPaper,
          n / 2 % 2 == 0 ? Paths::kAll : Paths::kSingle,
          {draw.integer(1, 5), draw.integer(1, 5)}};
}

TEST_CASE("float, double, Jet and 50 digits give the same values") {
  constexpr double kFloat = 1e-5;    // the promise times the ratio of the roundings is 5e-5
  constexpr double kDouble = 1e-13;  // the promise
  constexpr double kJet = 2e-14;     // Jet divides by multiplying with a reciprocal
  RandomInputs draw(seed_from_environment());
  double worst_float = 0;
  double worst_double = 0;
  double worst_jet = 0;
  for (int n = 0; n < 60; ++n) {
    const Parameters p = draw_parameters(draw);
    const Variant variant = variant_of(draw, n);
    const auto single = components_at(cast<float>(p), variant);
    const auto value = components_at(p, variant);
    const auto jet = components_at(jets(p), variant);
    const auto exact = components_at(cast<Real>(p), variant);
    for (std::size_t k = 0; k < 3; ++k) {
      worst_double =
          std::max(worst_double, std::fabs(static_cast<double>(Real(value[k]) / exact[k] - 1)));
      worst_float = std::max(worst_float, std::fabs(static_cast<double>(single[k]) / value[k] - 1));
      worst_jet = std::max(worst_jet, std::fabs(jet[k].a / value[k] - 1));
    }
  }
  std::cout << "relative errors: float " << worst_float << ", double " << worst_double << ", Jet "
            << worst_jet << '\n';
  CHECK(worst_float <= kFloat);
  CHECK(worst_double <= kDouble);
  CHECK(worst_jet <= kJet);
}

// Derivatives double the number of roundings and divide by axes once more than values do.
constexpr double kDerivative = 1e-13;

TEST_CASE("derivatives agree with differences in 50 digits at random interior points") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 4; ++n) {
    const Parameters p = draw_parameters(draw);
    worst = std::max(worst, worst_derivative(p, variant_of(draw, n)));
  }
  std::cout << "worst derivative " << worst << '\n';
  CHECK(worst <= kDerivative);
}

TEST_CASE("derivatives agree with one-sided differences where nothing is scattered") {
  RandomInputs draw(seed_from_environment() + 1);
  double worst = 0;
  for (int n = 0; n < 4; ++n) {
    Parameters p = draw_parameters(draw);
    p[kScatter] = p[kWeft + kScatter] = 0;
    worst = std::max(worst, worst_derivative(p, variant_of(draw, n)));
  }
  std::cout << "worst derivative " << worst << '\n';
  CHECK(worst <= kDerivative);
}

}  // namespace
}  // namespace clothbrdf::test
