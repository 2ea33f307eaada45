#include "preview/sheet.h"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

// z = 0.045 sin(p) + 0.024 sin(q) with
// p = 2 pi (1.7 x - y + 0.16 sin(2 pi (0.35 x + 0.75 y))), q = 2 pi (0.8 x + 1.3 y + 0.2):
// diagonal wrinkles that wander, and shallower ones across them. Slopes reach 0.735 (36 degrees).
Slope sheet_slope(double x, double y) {
  const double bend = kTurn * (0.35 * x + 0.75 * y);
  const double p = kTurn * (1.7 * x - y + 0.16 * std::sin(bend));
  const double q = kTurn * (0.8 * x + 1.3 * y + 0.2);
  const double bent = kTurn * 0.16 * std::cos(bend);
  const double along_p = 0.045 * kTurn * std::cos(p);
  const double along_q = 0.024 * kTurn * std::cos(q);
  return {along_p * (1.7 + bent * 0.35) + along_q * 0.8,
          along_p * (-1 + bent * 0.75) + along_q * 1.3};
}

Vector3<double> to_cloth(const Slope& slope, const Vector3<double>& w) {
  const double scale = 1 / std::sqrt(1 + slope.x * slope.x + slope.y * slope.y);
  const Vector3<double> n = {-slope.x * scale, -slope.y * scale, scale};
  // The rotation that takes z to n about their common normal takes x to t and y to b.
  const double k = 1 / (1 + n[2]);
  const Vector3<double> t = {1 - n[0] * n[0] * k, -n[0] * n[1] * k, -n[0]};
  const Vector3<double> b = {-n[0] * n[1] * k, 1 - n[1] * n[1] * k, -n[1]};
  const auto dot = [&](const Vector3<double>& v) {
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
  };
  return {dot(t), dot(b), dot(n)};
}

Image render_sheet(const Shading& shading, const SheetView& view, const Workers& workers) {
  const Vector3<double> light = direction(view.light.theta_deg, view.light.phi_deg);
  const Vector3<double> eye = direction(view.eye.theta_deg, view.eye.phi_deg);
  const double white = std::numbers::pi * std::exp2(view.exposure);
  Image image(view.size, view.size);
  with_threads(workers.threads, [&] {
    run_parallel(static_cast<std::size_t>(view.size), workers, [&](std::size_t k) {
      const int row = static_cast<int>(k);
      std::vector<Directions> directions;
      for (int column = 0; column < view.size; ++column) {
        const Slope slope =
            sheet_slope((column + 0.5) / view.size, (view.size - row - 0.5) / view.size);
        directions.push_back({to_cloth(slope, light), to_cloth(slope, eye)});
      }
      const std::span<Rgb> pixels(&image.at(0, row), directions.size());
      shading(directions, pixels);
      for (std::size_t p = 0; p < pixels.size(); ++p) {
        const Directions& d = directions[p];
        const double scale = d.above_horizon() ? white * d.wi[2] : 0;
        for (double& value : pixels[p]) value *= scale;
        if (std::isnan(pixels[p][0])) pixels[p] = kNotInTable;
      }
      workers.advance(static_cast<std::uint64_t>(view.size));
    });
  });
  return image;
}

}  // namespace clothbrdf
