// The reference is plain, not obviously right: its closed forms are held to sums and integrals that
// are.

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/special_functions/ellint_rd.hpp>

#include "tests/catch.h"
#include "tests/reference/reference_model.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

/// What is left of 50 digits after sums of a few thousand terms.
const Real kNearlyAll("1e-44");

Real relative(const Real& value, const Real& exact) { return abs(value / exact - 1); }

TEST_CASE("the reference's lobe integral is Boost's Carlson function to 44 digits") {
  RandomInputs draw(seed_from_environment());
  Real worst = 0;
  for (int n = 0; n < 300; ++n) {
    const double lowest = n < 150 ? 1e-6 : 0.03;
    const Real a = n == 0 ? Real(1) : Real(draw.log_uniform(lowest, 1));
    const Real b = n % 10 == 0 ? a : Real(draw.log_uniform(lowest, 1));
    const Real carlson = 2 * boost::math::constants::pi<Real>() / 3 * a * b *
                         boost::math::ellint_rd(Real(a * a), Real(b * b), Real(1));
    worst = std::max(worst, relative(reference_lobe_integral(a, b), carlson));
  }
  CHECK(worst < kNearlyAll);
}

TEST_CASE("the reference's lobe integral is the integral over the hemisphere") {
  boost::math::quadrature::tanh_sinh<Real> rule;
  for (const auto& [a, b] : {std::pair(0.3, 0.9), std::pair(0.1, 0.2), std::pair(1.0, 1.0)}) {
    // Over the azimuth by the periodic trapezoid rule, over cos(theta) by tanh-sinh.
    const int azimuths = 640;
    const Real pi = boost::math::constants::pi<Real>();
    std::vector<Real> width;  // 1 / (half-width of the lobe)^2 towards each azimuth
    for (int n = 0; n < azimuths / 4; ++n) {
      const Real c = cos(Real((n + Real(0.5)) * 2 * pi / azimuths));
      width.push_back(c * c / (Real(a) * a) + (1 - c * c) / (Real(b) * b));
    }
    const auto ring = [&](const Real& z) {
      Real sum = 0;
      for (const Real& w : width) sum += z * z / ((1 - z * z) * w + z * z);
      return Real(2 * pi * sum / static_cast<double>(width.size()));
    };
    const Real integral = rule.integrate(ring, Real(0), Real(1), Real("1e-25"));
    CHECK(relative(reference_lobe_integral(a, b), integral) < 1e-24);
  }
}

TEST_CASE("the reference's pile of plates is the sum of all its walks") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 20; ++n) {
    const int layers = draw.integer(1, 6);
    const Real r = draw.uniform(0, 0.3);
    const Real passage = exp(Real(-draw.uniform(0.3, 1)));
    const std::vector<Real> walk = reference_walk(layers, r, passage);
    REQUIRE(walk.size() < 1000);  // it ended by itself: nothing was filled up
    Real sum = 0;
    for (std::size_t e = 2; e < walk.size(); ++e) sum += walk[e];
    CHECK(relative(sum, reference_pile_inside(layers, r, passage)) < kNearlyAll);
  }
}

TEST_CASE("the reference walks eq. 4's path and the near side of the second layer by hand") {
  const Real r("0.1");
  const Real t("0.9");
  const Real a("0.7");
  const std::vector<Real> walk = reference_walk(2, r, a);
  CHECK(relative(walk[1], r) < kNearlyAll);
  CHECK(relative(walk[3], t * t * r * a * a) < kNearlyAll);  // far side of the first layer
  // Near side of the second layer; twice back and forth inside the first.
  CHECK(relative(walk[5], pow(t, 4) * r * a * a + t * t * pow(r, 3) * pow(a, 4)) < kNearlyAll);
}

TEST_CASE("the reference's azimuthal mean is the mean of its lobes over the azimuth") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 6; ++n) {
    MaterialRanges ranges;
    ranges.lowest_axis = 0.2;
    Material material = draw.material(ranges, 1);
    material.warp.layers = material.weft.layers = 0;  // specular says it all
    const double theta_h = draw.uniform(1, 60);
    const Wide half = Wide(theta_h) * boost::math::constants::pi<Wide>() / 180;
    const Wide turn = boost::math::constants::pi<Wide>() / 256;
    const ReferenceValues mean = reference_azimuthal_mean(material, theta_h, 20, 70);
    const ReferenceValues of_one_yarn = [&] {
      Material one = material;
      one.warp_fraction = 1;
      return reference_azimuthal_mean(one, theta_h, 20, 70);
    }();
    Wide sum = 0;
    for (int k = 0; k < 512; ++k) {
      sum += reference_lobe_height(sin(half) * cos(k * turn), sin(half) * sin(k * turn), cos(half),
                                   material.warp.lobe_axes[0], material.warp.lobe_axes[1]);
    }
    const ReferenceComponents& f = of_one_yarn.of(Reflectance::kPaper, Paths::kAll);
    const Wide theta_d = Wide(20) * boost::math::constants::pi<Wide>() / 180;
    const Wide phi_d = Wide(70) * boost::math::constants::pi<Wide>() / 180;
    const Wide cos_theta_i = cos(half) * cos(theta_d) - sin(half) * sin(theta_d) * cos(phi_d);
    const Real expected = Real(material.weights.specular) * of_one_yarn.fresnel_reflection[0] *
                          Real(sum / 512 / cos_theta_i);
    CHECK(relative(f.specular[0], expected) < kNearlyAll);
    // Both yarns: the specular part lies between theirs.
    CHECK(mean.of(Reflectance::kPaper, Paths::kAll).specular[0] > 0);
  }
}

TEST_CASE("the reference's half/difference pairs have the cosines of Rusinkiewicz's frame") {
  // At theta_h = 0 the mean is the value itself, for any azimuths 180 degrees apart.
  RandomInputs draw(seed_from_environment());
  const Material material = draw.material({});
  const ReferenceValues mean = reference_azimuthal_mean(material, 0, 35, 10);
  const ReferenceValues value = reference_values(material, {35, 10, 35, 190});
  for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
    const ReferenceComponents& a = mean.of(reflectance, Paths::kAll);
    const ReferenceComponents& b = value.of(reflectance, Paths::kAll);
    CHECK(relative(a.specular[0], b.specular[0]) < kNearlyAll);
    CHECK(relative(a.internal[1], b.internal[1]) < kNearlyAll);
    CHECK(relative(a.diffuse[2], b.diffuse[2]) < kNearlyAll);
  }
}

}  // namespace
}  // namespace clothbrdf::test
