#include "model/fresnel.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_100;

/// A dozen roundings.
constexpr double kDozenRoundings = 1.5e-15;

/// Fresnel's formulas with sines and cosines, both polarisations, as they stand in textbooks.
Exact textbook_reflectance(const Exact& cos_i, const Exact& n) {
  const Exact cos_t = sqrt(Exact(1 - (1 - cos_i * cos_i) / (n * n)));
  const Exact s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
  const Exact p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
  return (s * s + p * p) / 2;
}

double relative(double value, const Exact& exact) {
  return static_cast<double>(abs(Exact(value / exact - 1)));
}

TEST_CASE("r, t and the cosine inside keep their digits near index 1 and at grazing incidence") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  int mostly_reflected = 0;
  int nearly_one = 0;
  for (int k = 0; k < 4000; ++k) {
    const double n = k % 3 == 0 ? 1 + draw.log_uniform(1e-12, 1) : draw.uniform(1.01, 3);
    const double x = k % 2 == 0 ? draw.log_uniform(1e-9, 1) : draw.uniform(0, 1);
    const Interface<double> i = fresnel(x, n);
    const Exact r = textbook_reflectance(x, n);
    // Where p is nearly 0 beside s (Brewster) and where index and cosine are both extreme, all must
    // hold.
    worst =
        std::max({worst, relative(i.reflected, r), relative(i.transmitted, Exact(1 - r)),
                  relative(i.cos_theta_t, sqrt(Exact(1 - (1 - Exact(x) * x) / (Exact(n) * n))))});
    CHECK(std::fabs(i.reflected + i.transmitted - 1) <= 0x1p-52);
    mostly_reflected += i.reflected >= 0.5;
    nearly_one += n < 1 + 1e-6;
  }
  INFO("worst relative error " << worst);
  CHECK(worst <= kDozenRoundings);
  CHECK(mostly_reflected > 300);
  CHECK(nearly_one > 300);
  CHECK(relative(fresnel(1e-9, 1 + 1e-12).transmitted,
                 Exact(1 - textbook_reflectance(1e-9, 1 + 1e-12))) <= kDozenRoundings);
}

TEST_CASE("normal incidence reflects ((n - 1) / (n + 1))^2") {
  CHECK(std::fabs(fresnel(1.0, 1.5).reflected - 0.04) <= 1e-17);
  CHECK(std::fabs(fresnel(1.0, 3.0).reflected - 0.25) <= 1e-16);
  CHECK(fresnel(1.0, 1.5).cos_theta_t == 1);
}

TEST_CASE("index 1 reflects exactly nothing, at any incidence") {
  for (const double x : {0.0, 1e-9, 0.1, 0.7, 1.0}) {
    const Interface<double> i = fresnel(x, 1.0);
    CHECK(i.reflected == 0);
    CHECK(i.transmitted == 1);
    CHECK(i.cos_theta_t == x);
  }
}

TEST_CASE("grazing incidence reflects everything") {
  for (const double n : {1.0001, 1.5, 3.0}) {
    const Interface<double> i = fresnel(0.0, n);
    CHECK(i.reflected == 1);
    CHECK(i.transmitted == 0);
    CHECK(i.cos_theta_t > 0);
  }
}

}  // namespace
}  // namespace clothbrdf::test
