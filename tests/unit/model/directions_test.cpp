#include "model/directions.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

// A few roundings of numbers of size 1.
constexpr double kFewRoundings = 1e-15;

template <class T>
Vector3<T> unit_vector(const T& theta_deg, const T& phi_deg) {
  using std::cos;
  using std::sin;
  const T theta = theta_deg * pi<T>() / T(180);
  const T phi = phi_deg * pi<T>() / T(180);
  return {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}

/// i + o in 50 digits, where its cancellation does not matter.
PairGeometry<Real> plain(const DirectionPair& pair, double rotation_deg) {
  const Vector3<Real> i = unit_vector<Real>(pair.theta_i, pair.phi_i);
  const Vector3<Real> o = unit_vector<Real>(pair.theta_o, pair.phi_o);
  const Vector3<Real> h = {i[0] + o[0], i[1] + o[1], i[2] + o[2]};
  const Real length = sqrt(Real(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]));
  const Real turn = Real(rotation_deg) * pi<Real>() / 180;
  return {(h[0] * cos(turn) + h[1] * sin(turn)) / length,
          (h[1] * cos(turn) - h[0] * sin(turn)) / length,
          h[2] / length,
          (i[0] * h[0] + i[1] * h[1] + i[2] * h[2]) / length,
          i[2],
          o[2]};
}

double error(double value, const Real& exact) {
  return static_cast<double>(abs(Real(value - exact)));
}

TEST_CASE(
    "the half vector of a pair in degrees has all its digits, near the mirror direction too") {
  RandomInputs draw(seed_from_environment());
  double worst_cosine = 0;
  double worst_tilt = 0;  // error of (h_weft, h_warp), relative to its length
  int near_mirror = 0;
  for (int n = 0; n < 3000; ++n) {
    const DirectionPair pair = draw.pair();
    const double rotation = draw.azimuth();
    const PairGeometry<double> g = pair_geometry<double>(pair, rotation);
    const PairGeometry<Real> exact = plain(pair, rotation);
    for (const auto& [value, truth] :
         {std::pair(g.h_n, exact.h_n), std::pair(g.cos_theta_d, exact.cos_theta_d),
          std::pair(g.cos_theta_i, exact.cos_theta_i),
          std::pair(g.cos_theta_o, exact.cos_theta_o)}) {
      worst_cosine = std::max(worst_cosine, error(value, truth) / static_cast<double>(truth));
    }
    const Real tilt = sqrt(Real(exact.h_weft * exact.h_weft + exact.h_warp * exact.h_warp));
    if (tilt < 1e-20) continue;
    near_mirror += tilt < 1e-6;
    worst_tilt = std::max({worst_tilt, error(g.h_weft, exact.h_weft) / static_cast<double>(tilt),
                           error(g.h_warp, exact.h_warp) / static_cast<double>(tilt)});
  }
  INFO("cosines " << worst_cosine << ", tilt " << worst_tilt);
  CHECK(worst_cosine <= kFewRoundings);
  CHECK(worst_tilt <= 2 * kFewRoundings);
  CHECK(near_mirror > 50);
}

TEST_CASE("azimuths and rotations may be any finite number of degrees") {
  RandomInputs draw(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 300; ++n) {
    const double size = draw.log_uniform(1e3, 1e15);
    const DirectionPair pair = {draw.uniform(0, 85), size * draw.uniform(-1, 1),
                                draw.uniform(0, 85), draw.uniform(-180, 180)};
    const double rotation = size * draw.uniform(-1, 1);
    const PairGeometry<double> g = pair_geometry<double>(pair, rotation);
    const PairGeometry<Real> exact = plain(pair, rotation);
    worst = std::max({worst, error(g.h_weft, exact.h_weft), error(g.h_warp, exact.h_warp),
                      error(g.cos_theta_d, exact.cos_theta_d)});
  }
  CHECK(worst <= kFewRoundings);
}

TEST_CASE("vectors give the geometry that degrees give") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 2000; ++n) {
    DirectionPair pair = draw.pair();
    pair.phi_i = draw.uniform(-360, 360);
    pair.phi_o = draw.uniform(-360, 360);
    const double rotation = draw.uniform(-360, 360);
    const PairGeometry<double> degrees = pair_geometry<double>(pair, rotation);
    const PairGeometry<double> vectors = pair_geometry<double>(
        unit_vector(pair.theta_i, pair.phi_i), unit_vector(pair.theta_o, pair.phi_o), rotation);
    // A sum of unit vectors of length 2 x carries the roundings of numbers of size 1.
    const double allowed = 2 * kFewRoundings / degrees.cos_theta_d;
    CHECK(std::fabs(degrees.h_weft - vectors.h_weft) <= allowed);
    CHECK(std::fabs(degrees.h_warp - vectors.h_warp) <= allowed);
    CHECK(std::fabs(degrees.h_n - vectors.h_n) <= allowed);
    CHECK(std::fabs(degrees.cos_theta_d - vectors.cos_theta_d) <= allowed);
    CHECK(std::fabs(degrees.cos_theta_i - vectors.cos_theta_i) <= 2 * kFewRoundings);
    CHECK(std::fabs(degrees.cos_theta_o - vectors.cos_theta_o) <= 2 * kFewRoundings);
  }
}

TEST_CASE("weft lies along x and warp along y, both turned counter-clockwise by the rotation") {
  const DirectionPair towards_x = {60, 0, 0, 0};
  const PairGeometry<double> g = pair_geometry<double>(towards_x, 0.0);
  CHECK(std::fabs(g.h_weft - 0.5) <= kFewRoundings);
  CHECK(g.h_warp == 0);
  CHECK(std::fabs(g.cos_theta_d - std::cos(pi<double>() / 6)) <= kFewRoundings);
  const PairGeometry<double> turned = pair_geometry<double>(towards_x, 90.0);
  CHECK(turned.h_weft == 0);
  CHECK(std::fabs(turned.h_warp + 0.5) <= kFewRoundings);
}

TEST_CASE("on the horizon and below it nothing is above the horizon") {
  for (const double theta : {90.0, 90.0000001, 120.0, 180.0}) {
    CHECK_FALSE(pair_geometry<double>(DirectionPair{theta, 10, 20, 30}, 0.0).above_horizon());
    CHECK_FALSE(pair_geometry<double>(DirectionPair{20, 30, theta, 10}, 0.0).above_horizon());
  }
  CHECK(pair_geometry<double>(DirectionPair{89.9999999, 0, 89.9999999, 180}, 0.0).above_horizon());
  // Exactly opposite directions have no half vector; every field stays a number.
  const PairGeometry<double> none = pair_geometry<double>(DirectionPair{90, 0, 90, 180}, 0.0);
  CHECK_FALSE(none.above_horizon());
  CHECK(none.cos_theta_d == 0);
  CHECK(none.h_n == 1);
}

TEST_CASE("incidence cosines of half and difference angles are those of the pair they mean") {
  RandomInputs draw(seed_from_environment());
  for (int n = 0; n < 500; ++n) {
    const double theta_h = draw.uniform(0, 90);
    const double theta_d = draw.uniform(0, 90);
    const double phi_d = draw.uniform(0, 360);
    const IncidenceCosines<double> c =
        incidence_cosines(sincosd(theta_h), sincosd(theta_d), sincosd(phi_d).cos);
    // The light in the half vector's frame, z towards it and x away from the normal; the normal is
    // at -theta_h in x-z.
    const Vector3<double> light = unit_vector(theta_d, phi_d);
    const Vector3<double> eye = {-light[0], -light[1], light[2]};
    const Vector3<double> normal = unit_vector(theta_h, 180.0);
    CHECK(std::fabs(c.i - (light[0] * normal[0] + light[2] * normal[2])) <= kFewRoundings);
    CHECK(std::fabs(c.o - (eye[0] * normal[0] + eye[2] * normal[2])) <= kFewRoundings);
  }
}

}  // namespace
}  // namespace clothbrdf::test
