#include "preview/lobes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/degrees.h"

namespace clothbrdf {
namespace {

constexpr int kAngles = 361;  // of theta_o from -90 to 90 degrees
constexpr int kSamples = 4;   // along each edge of a pixel, against jagged outlines
constexpr Rgb kPaper = {0.012, 0.012, 0.014};
constexpr Rgb kRing = {0.06, 0.06, 0.07};
constexpr Rgb kLight = {0.9, 0.75, 0.25};
constexpr Rgb kSpecular = {0.85, 0.85, 0.85};

double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

// The colour alone, at a brightness that shows it.
Rgb shown(const Rgb& colour, double brightness) {
  const double largest = std::max({colour[0], colour[1], colour[2], 1e-30});
  Rgb scaled = colour;
  for (double& c : scaled) c = std::max(0.0, c) * brightness / largest;
  return scaled;
}

/// One filled outline: its length at each angle, from the centre.
struct Outline {
  std::array<double, kAngles> length{};
  Rgb colour{};
};

/// The outlines of a plane, the inner ones first.
using Plane = std::vector<Outline>;

double theta_at(int k) { return 180.0 * k / (kAngles - 1) - 90; }

Plane outlines(const Cloth& cloth, const LobesView& view, double azimuth_deg) {
  std::vector<Part> parts = {Part::kDiffuse, Part::kInternal, Part::kSpecular};
  if (!std::all_of(parts.begin(), parts.end(), [&](Part part) { return cloth.has(part); })) {
    parts = {Part::kTotal};
  }
  Plane plane;
  std::array<double, kAngles> sum{};
  for (const Part part : parts) {
    const Shading shading = turned(cloth.shading(part), view.turn_deg);
    Outline outline;
    Rgb colour{};
    // The ends lie on the horizon.
    for (int k = 1; k < kAngles - 1; ++k) {
      const double theta = theta_at(k);
      const Directions d = {direction(view.light_theta_deg, azimuth_deg + 180),
                            direction(std::abs(theta), azimuth_deg + (theta < 0 ? 180 : 0))};
      const Rgb f = shading(d);
      if (std::isnan(f[0])) continue;
      const auto at = static_cast<std::size_t>(k);
      sum[at] += std::max(0.0, luminance(f) * d.wo[2]);
      for (std::size_t c = 0; c < 3; ++c) colour[c] += f[c] * d.wo[2];
    }
    outline.length = sum;
    constexpr double kDim = 0.35;
    constexpr double kBright = 0.8;
    outline.colour = part == Part::kSpecular
                         ? kSpecular
                         : shown(colour, part == Part::kDiffuse ? kDim : kBright);
    plane.push_back(outline);
  }
  return plane;
}

std::array<Plane, 2> planes(const Cloth& cloth, const LobesView& view) {
  return {outlines(cloth, view, 0), outlines(cloth, view, 90)};
}

double scale_of(const std::array<Plane, 2>& both) {
  double largest = 1e-30;
  for (const Plane& plane : both) {
    const auto& outer = plane.back().length;
    largest = std::max(largest, *std::max_element(outer.begin(), outer.end()));
  }
  const double power = std::pow(10, std::floor(std::log10(largest)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (largest <= step * power) return step * power;
  }
  return 10 * power;
}

// The colour at a point of a half disc of radius 1: x to the right, y along the normal, up.
Rgb colour_at(const Plane& plane, double x, double y, double scale, double light_theta_deg,
              double line) {
  const double r = std::hypot(x, y);
  if (y < 0 || r > 1 + line) return kPaper;
  const double theta = std::atan2(x, y) / kRadian;
  const double at = std::clamp((theta + 90) * (kAngles - 1) / 180, 0.0, kAngles - 1.001);
  const auto k = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(k);
  for (const Outline& outline : plane) {
    const double length = (outline.length[k] * (1 - share) + outline.length[k + 1] * share) / scale;
    if (r < length) return outline.colour;
  }
  const double off_light = std::abs(r * std::sin((theta + light_theta_deg) * kRadian));
  if (off_light < line && theta < 90 - light_theta_deg) return kLight;
  if (std::abs(r - 1) < line || std::abs(r - 0.5) < line || y < line) return kRing;
  return kPaper;
}

}  // namespace

double lobe_scale(const Cloth& cloth, const LobesView& view) {
  return scale_of(planes(cloth, view));
}

Image render_lobes(const Cloth& cloth, const LobesView& view) {
  const std::array<Plane, 2> both = planes(cloth, view);
  const double scale = scale_of(both);
  Image image(view.size, view.size, kPaper);
  constexpr double kRadius = 0.46;  // of the picture's edge
  constexpr double kLine = 0.006;   // half a line's width, of the radius
  for (int row = 0; row < view.size; ++row) {
    const bool lower = row >= view.size / 2;
    const double base = lower ? view.size * 0.99 : view.size * 0.49;
    for (int column = 0; column < view.size; ++column) {
      Rgb sum{};
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const int down = s / kSamples;
        const double x = column + (s % kSamples + 0.5) / kSamples - view.size * 0.5;
        const double y = base - row - (down + 0.5) / kSamples;
        const double radius = kRadius * view.size;
        const Rgb c = colour_at(both[lower ? 1 : 0], x / radius, y / radius, scale,
                                view.light_theta_deg, std::max(kLine, 0.5 / radius));
        for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k] / (kSamples * kSamples);
      }
      image.at(column, row) = sum;
    }
  }
  return image;
}

}  // namespace clothbrdf
