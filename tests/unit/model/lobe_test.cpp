#include "model/lobe.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

constexpr double kEpsilon = 0x1p-52;
/// What sums over a few hundred nodes leave of 50 digits.
const Real kQuadrature("1e-25");

Real relative(const Real& value, const Real& exact) { return abs(Real(value / exact - 1)); }

TEST_CASE(
    "the lobe's height is the distance to the far side of an ellipsoid that touches the surface") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 500; ++n) {
    const LobeAxes<double> axes = {draw.log_uniform(0.03, 1), draw.log_uniform(0.03, 1)};
    const double theta = draw.uniform(0, 1.5);
    const double phi = draw.uniform(0, 6.3);
    const double u = std::sin(theta) * std::cos(phi);
    const double v = std::sin(theta) * std::sin(phi);
    const double w = std::cos(theta);
    // Height 1 is the whole solid, 2 semi-axes; its centre is one semi-axis above the surface.
    const double distance = 2 * lobe_height(u, v, w, axes);
    CHECK(distance > 0);
    const double x = distance * u / axes.along;
    const double y = distance * v / axes.across;
    const double z = distance * w - 1;
    CHECK(std::fabs(x * x + y * y + z * z - 1) <= 32 * kEpsilon);
  }
  CHECK(lobe_height(0.0, 0.0, 1.0, LobeAxes<double>{0.1, 0.4}) == 1);
  CHECK(lobe_height(0.6, 0.8, 0.0, LobeAxes<double>{0.1, 0.4}) == 0);
}

TEST_CASE("a sphere draws a cosine lobe") {
  for (const double c : {1.0, 0.8, 0.28}) {
    const double s = std::sqrt(1 - c * c);
    CHECK(std::fabs(lobe_height(s, 0.0, c, LobeAxes<double>{1, 1}) - c) <= kEpsilon);
  }
}

TEST_CASE("carlson_rd is within 8 eps of Boost's in 50 digits, tiny arguments included") {
  RandomInputs draw(seed_from_environment());
  Real worst = 0;
  for (int n = 0; n < 600; ++n) {
    const double lowest = n % 3 == 0 ? 1e-300 : 1e-12;
    const double x = n % 50 == 0 ? 0 : draw.log_uniform(lowest, 1);
    const double y = n % 7 == 0 && x > 0 ? x : draw.log_uniform(lowest, 1);
    const double z = n % 2 ? 1 : draw.log_uniform(1e-3, 1e3);
    const Real exact = boost::math::ellint_rd(Real(x), Real(y), Real(z));
    worst = std::max(worst, relative(Real(carlson_rd(x, y, z)), exact));
  }
  INFO("worst " << worst << " = " << worst / kEpsilon << " eps");
  CHECK(worst <= 8 * kEpsilon);
}

TEST_CASE("carlson_rd carries 50 digits and float") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 40; ++n) {
    const Real x = draw.log_uniform(1e-12, 1);
    const Real y = draw.log_uniform(1e-12, 1);
    const Real exact = boost::math::ellint_rd(x, y, Real(1));
    CHECK(relative(carlson_rd(x, y, Real(1)), exact) < 1e-47);
    const float single = carlson_rd(static_cast<float>(x), static_cast<float>(y), 1.0F);
    CHECK(relative(Real(single), exact) < 1e-6);  // 8 eps of float
  }
}

TEST_CASE("the lobe integral is the integral of the lobe over the hemisphere") {
  boost::math::quadrature::tanh_sinh<Real> rule;
  for (const auto& [a, b] : {std::pair(1.0, 1.0), std::pair(0.35, 0.6), std::pair(0.2, 1.0)}) {
    const LobeAxes<Real> axes = {Real(a), Real(b)};
    const int azimuths = 400;
    std::vector<std::array<Real, 2>> circle;
    for (int n = 0; n < azimuths / 4; ++n) {
      const Real phi = (n + Real(0.5)) * 2 * pi<Real>() / azimuths;
      circle.push_back({cos(phi), sin(phi)});
    }
    const auto ring = [&](const Real& z) {
      const Real s = sqrt(Real(1 - z * z));
      Real sum = 0;
      for (const auto& [c, d] : circle) sum += lobe_height(Real(s * c), Real(s * d), z, axes) * z;
      return Real(2 * pi<Real>() * sum / static_cast<double>(circle.size()));
    };
    const Real integral = rule.integrate(ring, Real(0), Real(1), kQuadrature);
    CHECK(relative(lobe_integral(axes), integral) < 1e-24);
    CHECK(relative(Real(lobe_integral(LobeAxes<double>{a, b})), integral) < 16 * kEpsilon);
  }
  CHECK(std::fabs(lobe_integral(LobeAxes<double>{1, 1}) - 2 * pi<double>() / 3) <= 8 * kEpsilon);
}

TEST_CASE("the closed azimuthal mean is the mean over the azimuth") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 30; ++n) {
    const LobeAxes<double> axes = {draw.log_uniform(0.03, 1), draw.log_uniform(0.03, 1)};
    const double theta = draw.uniform(0, 1.57);
    const double s = std::sin(theta);
    const double c = std::cos(theta);
    // The periodic trapezoid rule converges as exp(-n * narrowest axis).
    const int nodes = 4096;
    double sum = 0;
    for (int k = 0; k < nodes; ++k) {
      const double phi = 2 * pi<double>() * k / nodes;
      sum += lobe_height(s * std::cos(phi), s * std::sin(phi), c, axes);
    }
    CHECK(std::fabs(lobe_azimuthal_mean(s, c, axes) / (sum / nodes) - 1) <= 1e-12);
  }
  CHECK(lobe_azimuthal_mean(0.0, 1.0, LobeAxes<double>{0.1, 0.4}) == 1);
  CHECK(lobe_azimuthal_mean(1.0, 0.0, LobeAxes<double>{0.1, 0.4}) == 0);
}

}  // namespace
}  // namespace clothbrdf::test
