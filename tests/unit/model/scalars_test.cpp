// Every scalar that the model promises, through ClothModel<T>::evaluate: float, double, ceres::Jet
// and 50 digits.

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <iostream>

#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                           boost::multiprecision::et_off>;

/// Everything continuous of a cloth and a pair, flat: the yarns' five each, then what they share.
constexpr std::size_t kWeft = 5;
constexpr std::size_t kScatter = 4;
constexpr std::size_t kShared = 10;
constexpr std::size_t kCount = kShared + 10;
using Parameters = std::array<double, kCount>;
using Jet = ceres::Jet<double, static_cast<int>(kCount)>;

struct Variant {
  Reflectance reflectance;
  Paths paths;
  std::array<int, 2> layers;
};

/// Specular, internal, diffuse.
template <class T>
std::array<T, 3> components_at(const std::array<T, kCount>& p, const Variant& variant) {
  BasicMaterial<T> material;
  material.reflectance = variant.reflectance;
  material.paths = variant.paths;
  for (std::size_t y = 0; y < 2; ++y) {
    BasicYarn<T>& yarn = y == 0 ? material.warp : material.weft;
    const T* own = p.data() + y * kWeft;
    yarn.lobe_axes = {own[0], own[1]};
    yarn.absorption = {own[2]};
    yarn.layers = variant.layers[y];
    yarn.refractive_index = own[3];
    yarn.scatter = own[kScatter];
  }
  const T* shared = p.data() + kShared;
  material.weights = {shared[0], shared[1], shared[2]};
  material.diffuse_path = shared[3];
  material.warp_fraction = shared[4];
  material.rotation_deg = shared[5];
  const BasicDirectionPair<T> pair = {shared[6], shared[7], shared[8], shared[9]};
  const BasicComponents<T> f =
      ClothModel<T>(material).evaluate(pair_geometry<T>(pair, material.rotation_deg));
  return {f.specular[0], f.internal[0], f.diffuse[0]};
}

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

template <class T>
std::array<T, kCount> cast(const Parameters& p) {
  std::array<T, kCount> result;
  for (std::size_t k = 0; k < kCount; ++k) result[k] = T(p[k]);
  return result;
}

std::array<Jet, kCount> jets(const Parameters& p) {
  std::array<Jet, kCount> result;
  for (std::size_t k = 0; k < kCount; ++k) result[k] = Jet(p[k], static_cast<int>(k));
  return result;
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

/// Largest error of the Jet's derivatives, relative to the derivative plus the value. One-sided in
/// the scatter rates where they are 0.
double worst_derivative(const Parameters& p, const Variant& variant) {
  const auto jet = components_at(jets(p), variant);
  const auto here = components_at(cast<Real>(p), variant);
  double worst = 0;
  for (std::size_t k = 0; k < kCount; ++k) {
    const auto at = [&](const Real& offset) {
      auto moved = cast<Real>(p);
      moved[k] += offset;
      return components_at(moved, variant);
    };
    const bool one_sided = p[k] == 0;
    // Of second order: 1e-30 and 1e-24 times a third derivative.
    const Real step = one_sided ? Real("1e-12") : Real("1e-15");
    const auto ahead = at(step);
    const auto other = at(one_sided ? Real(2 * step) : Real(-step));
    for (std::size_t c = 0; c < 3; ++c) {
      const Real derivative =
          (one_sided ? Real(4 * ahead[c] - other[c] - 3 * here[c]) : Real(ahead[c] - other[c])) /
          (2 * step);
      const Real error = abs(Real(jet[c].v[static_cast<int>(k)] - derivative));
      worst = std::max(worst, static_cast<double>(error / (abs(derivative) + abs(here[c]))));
    }
  }
  return worst;
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
