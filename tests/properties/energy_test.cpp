#include <cmath>
#include <iostream>

#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

/// A directional albedo and how far it may be off.
struct Albedo {
  double value;
  double error;
};

/// Integral of f cos(theta_o) over the outgoing hemisphere for one yarn (warp_fraction 1), by the
/// midpoint rule over facets: slopes h_u / h_n = a tan(t) cos(phi), h_v / h_n = b tan(t) sin(phi),
/// in which the specular lobe is cos(t)^2 / h_n, however narrow; d wo = 4 cos(theta_d) d wh.
double albedo_on_grid(const ClothModel<double>& model, double theta_i_deg, double phi_i_deg,
                      int n) {
  const auto [a, b] = model.material().warp.lobe_axes;
  const SinCos<double> theta = sincosd(theta_i_deg);
  const SinCos<double> phi = sincosd(phi_i_deg);
  const Vector3<double> wi = {theta.sin * phi.cos, theta.sin * phi.sin, theta.cos};
  const double dt = pi<double>() / 2 / n;
  const double dphi = pi<double>() / n;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double tangent = std::tan((k + 0.5) * dt);
    for (int m = 0; m < 2 * n; ++m) {
      // At rotation 0 the warp lies along y.
      const double slope_y = a * tangent * std::cos((m + 0.5) * dphi);
      const double slope_x = b * tangent * std::sin((m + 0.5) * dphi);
      const double h_n = 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
      const double x = h_n * (wi[0] * slope_x + wi[1] * slope_y + wi[2]);
      const double cos_theta_o = 2 * x * h_n - wi[2];
      if (x <= 0 || cos_theta_o <= 0) continue;
      const PairGeometry<double> g = {slope_x * h_n, slope_y * h_n, h_n, x, wi[2], cos_theta_o};
      const double facets = h_n * h_n * h_n * a * b * tangent * (1 + tangent * tangent) * dt * dphi;
      sum += model.evaluate(g).total(0) * cos_theta_o * 4 * x * facets;
    }
  }
  return sum;
}

/// The midpoint rule is of second order here (the integrand has kinks, at G = 1 and at the horizon,
/// no jumps): what the last halving of the step changed is three times the error that is left, and
/// is taken as its bound.
Albedo albedo(const ClothModel<double>& model, double theta_i_deg, double phi_i_deg, int n = 96) {
  const double coarse = albedo_on_grid(model, theta_i_deg, phi_i_deg, n);
  const double fine = albedo_on_grid(model, theta_i_deg, phi_i_deg, 2 * n);
  return {fine, std::fabs(fine - coarse)};
}

Material clear_cloth(RandomInputs& draw, bool with_scatter) {
  MaterialRanges ranges;
  ranges.highest_index = 3;
  ranges.most_layers = 64;
  ranges.highest_scatter = 1;
  Material material = draw.material(ranges, 1);
  material.reflectance = Reflectance::kMicrofacet;
  material.weights = {1, 1, 0};
  material.warp_fraction =
      1;  // f is the mean of the yarns': what holds for each holds for the cloth
  material.rotation_deg = 0;
  material.weft = material.warp;
  if (draw.chance(0.7)) material.warp.absorption = {0};
  if (!with_scatter) material.warp.scatter = 0;
  return material;
}

// Absolute, of the last halving: a third of it, 1e-3, is left. Asserted of every albedo here.
constexpr double kQuadrature = 3e-3;

TEST_CASE("without scatter and diffuse light no cloth reflects more than it receives") {
  RandomInputs draw(seed_from_environment());
  double largest = 0;
  double largest_error = 0;
  int grazing = 0;
  for (int n = 0; n < 50; ++n) {
    const ClothModel<double> model(clear_cloth(draw, false));
    const double theta_i = n % 4 == 0 ? draw.uniform(80, 89) : draw.uniform(0, 80);
    grazing += theta_i >= 80;
    const Albedo seen = albedo(model, theta_i, draw.uniform(0, 360));
    CHECK(seen.value <= 1 + seen.error);
    largest = std::fmax(largest, seen.value);
    largest_error = std::fmax(largest_error, seen.error);
  }
  std::cout << "largest directional albedo without scatter " << largest << ", quadrature error "
            << largest_error << '\n';
  CHECK(largest_error <= kQuadrature);
  CHECK(largest > 0.85);  // some came close enough for a wrong factor to show
  CHECK(grazing >= 13);
}

TEST_CASE("seen from straight above, the albedo is Stokes' reflectance averaged over the facets") {
  // The same integral in one dimension: x = h_n there, and G = min(1, 2 cos(theta_o)).
  Material material;
  material.weights = {1, 1, 0};
  material.warp_fraction = 1;
  material.warp.absorption = {0};
  material.warp.layers = 10;
  material.warp.refractive_index = 1.5;
  for (const double axis : {0.02, 0.2, 1.0}) {
    material.warp.lobe_axes = {axis, axis};
    material.weft = material.warp;
    const int nodes = 20000;
    double expected = 0;
    double lobe = 0;  // Z over 2 pi
    for (int k = 0; k < nodes; ++k) {
      const double theta = (k + 0.5) * pi<double>() / 2 / nodes;
      const double c = std::cos(theta);
      const double s = std::sin(theta);
      const double height = c / (s * s / (axis * axis) + c * c);
      lobe += height * c * s;
      const double cos_t = std::sqrt(1 - s * s / 2.25);
      const double s_wave = (c - 1.5 * cos_t) / (c + 1.5 * cos_t);
      const double p_wave = (1.5 * c - cos_t) / (1.5 * c + cos_t);
      const double r = (s_wave * s_wave + p_wave * p_wave) / 2;
      const double shadowing = std::fmin(1, 2 * std::cos(2 * theta));
      if (shadowing > 0) expected += 20 * r / (1 + 19 * r) * height * c * s * shadowing;
    }
    const Albedo seen = albedo(ClothModel<double>(material), 0, 0, 192);
    CHECK(seen.error <= kQuadrature);
    CHECK(std::fabs(seen.value - expected / lobe) <= seen.error + 1e-6);
  }
}

TEST_CASE("the largest albedo with scatter is reported, and stays a modest number") {
  // Lobes of different width meet different x, so 1 can be passed near grazing (model.md, section
  // 7: 1.24 was seen).
  constexpr double kModest = 2;
  RandomInputs draw(seed_from_environment() + 1);
  Albedo largest{0, 0};
  double largest_theta = 0;
  Material largest_material;
  const auto offer = [&](const Material& material, double theta_i, double phi_i) {
    const Albedo seen = albedo(ClothModel<double>(material), theta_i, phi_i, 48);
    if (seen.value <= largest.value) return;
    largest = seen;
    largest_theta = theta_i;
    largest_material = material;
  };
  Material known = clear_cloth(draw, true);
  known.paths = Paths::kAll;
  known.warp = {{0.03, 1}, {0}, 64, 1.5, 1, std::nullopt};
  for (const double phi_i : {0.0, 45.0, 90.0}) offer(known, 88, phi_i);
  for (int n = 0; n < 60; ++n) {
    Material material = clear_cloth(draw, true);
    if (material.warp.scatter < 0.1) material.warp.scatter = 1;  // fewer lobes to sum, more scatter
    const double theta_i = n % 2 == 0 ? draw.uniform(80, 89) : draw.uniform(0, 80);
    offer(material, theta_i, draw.uniform(0, 360));
  }
  std::cout << "largest directional albedo with scatter " << largest.value << " (+- "
            << largest.error << ") at theta_i " << largest_theta << "\n    ";
  print(std::cout, largest_material.warp);
  std::cout << '\n';
  CHECK(largest.value > 0);
  CHECK(largest.value < kModest);
}

}  // namespace
}  // namespace clothbrdf::test
