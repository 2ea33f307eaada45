#include "model/degrees.h"

#include <ceres/jet.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

// "About one unit in the last place": half from the reduction to radians, half from the library's
// sine.
constexpr double kOneUnit = 2.3e-16;

double relative(double value, const Real& exact) {
  return static_cast<double>(abs(Real(Real(value) / exact - 1)));
}

Real radians(double degrees) { return Real(degrees) * boost::math::constants::pi<Real>() / 180; }

TEST_CASE("sincosd is exact at multiples of 90 degrees") {
  const double sines[] = {0, 1, 0, -1};
  for (int k = -4000; k <= 4000; ++k) {
    const SinCos<double> s = sincosd(90.0 * k);
    const int quarter = ((k % 4) + 4) % 4;
    CHECK(s.sin == sines[quarter]);
    CHECK(s.cos == sines[(quarter + 1) % 4]);
  }
}

TEST_CASE("sincosd keeps every digit beside multiples of 90 degrees and anywhere else") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  int close = 0;
  for (int n = 0; n < 4000; ++n) {
    const double offset = draw.log_uniform(1e-13, 45);
    const double degrees = n % 4 == 0 ? draw.uniform(-1e6, 1e6)
                                      : 90.0 * draw.integer(-9, 9) + (n % 2 ? offset : -offset);
    if (std::remainder(degrees, 90.0) == 0) continue;
    close += std::fabs(std::remainder(degrees, 90.0)) < 1e-6;
    const SinCos<double> s = sincosd(degrees);
    worst = std::max(
        {worst, relative(s.sin, sin(radians(degrees))), relative(s.cos, cos(radians(degrees)))});
  }
  INFO("worst relative error " << worst);
  CHECK(worst <= 2 * kOneUnit);
  CHECK(close > 500);
}

TEST_CASE("sums and differences lose nothing") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 1000; ++n) {
    const double a = draw.uniform(-1, 1) * draw.log_uniform(1e-10, 1e10);
    const double b = draw.uniform(-1, 1) * draw.log_uniform(1e-10, 1e10);
    const Rounded<double> sum = two_sum(a, b);
    const Rounded<double> difference = two_difference(a, b);
    CHECK(sum.value == a + b);
    CHECK(Real(sum.value) + Real(sum.error) == Real(a) + Real(b));
    CHECK(Real(difference.value) + Real(difference.error) == Real(a) - Real(b));
  }
}

TEST_CASE("the rounding error of an angle is put back into its sine and cosine") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 1000; ++n) {
    const Rounded<double> angle = two_sum(draw.uniform(-360, 360), draw.uniform(-1e-9, 1e-9));
    const SinCos<double> s = sincosd(angle);
    const Real exact = radians(angle.value) + radians(angle.error);
    worst = std::max({worst, static_cast<double>(abs(Real(s.sin - sin(exact)))),
                      static_cast<double>(abs(Real(s.cos - cos(exact))))});
  }
  CHECK(worst <= kOneUnit);
  // 90 degrees less what a double cannot hold: all of the cosine is in the error.
  const SinCos<double> right = sincosd(Rounded<double>{90.0, -1e-20});
  CHECK(relative(right.cos, radians(1e-20)) <= 2 * kOneUnit);
}

TEST_CASE("angles are reduced by whole turns exactly, derivatives stay") {
  CHECK(reduce_turns(360.0 * 12345 + 0.25) == 0.25);
  CHECK(reduce_turns(-190.0) == 170.0);
  using Jet = ceres::Jet<double, 1>;
  for (const double degrees : {30.0, 100.0, 250.0, -500.0, 725.0}) {
    CHECK(reduce_turns(Jet(degrees, 0)).v[0] == 1.0);
    const SinCos<Jet> s = sincosd(Jet(degrees, 0));
    const SinCos<double> value = sincosd(degrees);
    CHECK(s.sin.a == value.sin);
    CHECK(s.cos.a == value.cos);
    CHECK(std::fabs(s.sin.v[0] - value.cos * pi<double>() / 180) <= kOneUnit);
    CHECK(std::fabs(s.cos.v[0] + value.sin * pi<double>() / 180) <= kOneUnit);
  }
}

}  // namespace
}  // namespace clothbrdf::test
