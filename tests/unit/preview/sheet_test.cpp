#include "preview/sheet.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <iostream>
#include <span>
#include <utility>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// Some roundings of numbers of size 1.
constexpr double kRounding = 4e-15;

// The height of the sheet as the comment above sheet_slope has it.
double height(double x, double y) {
  const double p = 2 * kPi * (1.7 * x - y + 0.16 * std::sin(2 * kPi * (0.35 * x + 0.75 * y)));
  const double q = 2 * kPi * (0.8 * x + 1.3 * y + 0.2);
  return 0.045 * std::sin(p) + 0.024 * std::sin(q);
}

double dot(const Vector3<double>& a, const Vector3<double>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3<double> normal(const Slope& s) {
  const double length = std::sqrt(1 + s.x * s.x + s.y * s.y);
  return {-s.x / length, -s.y / length, 1 / length};
}

double distance(const Vector3<double>& a, const Vector3<double>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Slope slope_at(const SheetView& view, int column, int row) {
  return sheet_slope((column + 0.5) / view.size, 1 - (row + 0.5) / view.size);
}

// The shading that asks a function pair by pair.
Shading each(const std::function<Rgb(const Directions&)>& function) {
  return Shading([function](std::span<const Directions> directions, std::span<Rgb> f) {
    std::transform(directions.begin(), directions.end(), f.begin(), function);
  });
}

Shading lambertian(double rho) {
  return each([rho](const Directions& /*any*/) { return Rgb{rho / kPi, rho / 2 / kPi, 0}; });
}

}  // namespace

TEST_CASE("sheet_slope is the derivative of the height, which reaches a slope of 0.735") {
  constexpr double kStep = 1e-5;
  // Third derivatives of some hundreds times step^2 / 6, and the rounding of heights over the step.
  constexpr double kTolerance = 1e-7;
  double worst = 0;
  double steepest = 0;
  constexpr int kPoints = 400;
  for (int i = 0; i <= kPoints; ++i) {
    for (int j = 0; j <= kPoints; ++j) {
      const double x = static_cast<double>(i) / kPoints;
      const double y = static_cast<double>(j) / kPoints;
      const Slope s = sheet_slope(x, y);
      const double dx = (height(x + kStep, y) - height(x - kStep, y)) / (2 * kStep);
      const double dy = (height(x, y + kStep) - height(x, y - kStep)) / (2 * kStep);
      worst = std::max({worst, std::abs(s.x - dx), std::abs(s.y - dy)});
      steepest = std::max(steepest, std::hypot(s.x, s.y));
    }
  }
  std::cout << "the sheet: slopes are off by " << worst << " at most, the largest is " << steepest
            << ", " << std::atan(steepest) * 180 / kPi << " degrees\n";
  CHECK(worst <= kTolerance);
  // To the digits that the comment gives.
  CHECK_THAT(steepest, Catch::Matchers::WithinAbs(0.735, 0.0005));
}

TEST_CASE("to_cloth is the rotation that takes the sheet's normal to z the short way") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  CAPTURE(seed);
  for (int n = 0; n < 1000; ++n) {
    const Slope s = {random.uniform(-3, 3), random.uniform(-3, 3)};
    const Vector3<double> a = direction(random.uniform(0, 180), random.uniform(0, 360));
    const Vector3<double> b = direction(random.uniform(0, 180), random.uniform(0, 360));
    const Vector3<double> c = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                               a[0] * b[1] - a[1] * b[0]};
    const Vector3<double> a2 = to_cloth(s, a);
    const Vector3<double> b2 = to_cloth(s, b);
    const Vector3<double> c2 = {a2[1] * b2[2] - a2[2] * b2[1], a2[2] * b2[0] - a2[0] * b2[2],
                                a2[0] * b2[1] - a2[1] * b2[0]};
    CHECK(std::abs(dot(a2, a2) - 1) <= kRounding);
    CHECK(std::abs(dot(a2, b2) - dot(a, b)) <= kRounding);
    CHECK(distance(to_cloth(s, c), c2) <= kRounding);  // no reflection
    CHECK(distance(to_cloth(s, normal(s)), {0, 0, 1}) <= kRounding);
    CHECK(std::abs(to_cloth(s, {1, 0, s.x})[2]) <= kRounding * (1 + std::abs(s.x)));
    CHECK(std::abs(to_cloth(s, {0, 1, s.y})[2]) <= kRounding * (1 + std::abs(s.y)));
    // The axis of the shortest turn from the normal to z.
    const double slope = std::hypot(s.x, s.y);
    const Vector3<double> axis = {-s.y / slope, s.x / slope, 0};
    CHECK(distance(to_cloth(s, axis), axis) <= kRounding);
    CHECK(distance(to_cloth({0, 0}, a), a) == 0);
  }
}

TEST_CASE("a diffuse sheet is rho cos(theta_i), and a stop more doubles it") {
  for (const SheetDirection light : {SheetDirection{0, 0}, SheetDirection{50, 70}}) {
    SheetView view{light, {20, 200}, 24, 0};
    const Image image = render_sheet(lambertian(0.6), view, 2);
    view.exposure = 1;
    const Image brighter = render_sheet(lambertian(0.6), view, 2);
    REQUIRE(image.width == 24);
    REQUIRE(image.height == 24);
    for (int row = 0; row < view.size; ++row) {
      for (int column = 0; column < view.size; ++column) {
        CAPTURE(row, column);
        const double cosine =
            dot(normal(slope_at(view, column, row)), direction(light.theta_deg, light.phi_deg));
        const Rgb& pixel = image.at(column, row);
        CHECK(std::abs(pixel[0] - 0.6 * std::max(cosine, 0.0)) <= kRounding);
        CHECK(std::abs(pixel[1] - 0.3 * std::max(cosine, 0.0)) <= kRounding);
        CHECK(pixel[2] == 0);
        for (std::size_t c = 0; c < 3; ++c) CHECK(brighter.at(column, row)[c] == 2 * pixel[c]);
      }
    }
  }
}

TEST_CASE("facets that turn away from light or eye are black, the others are not") {
  for (const bool lit : {true, false}) {
    const SheetDirection low = {75, 240};
    const SheetView view{lit ? low : SheetDirection{}, lit ? SheetDirection{} : low, 32, 0};
    const Image image = render_sheet(lambertian(1), view, 1);
    int black = 0;
    for (int row = 0; row < view.size; ++row) {
      for (int column = 0; column < view.size; ++column) {
        const double cosine =
            dot(normal(slope_at(view, column, row)), direction(low.theta_deg, low.phi_deg));
        CHECK((image.at(column, row)[0] > 0) == (cosine > 0));
        if (cosine <= 0) ++black;
      }
    }
    std::cout << "low " << (lit ? "light: " : "eye: ") << black << " of 1024 facets are black\n";
    CHECK(black > 50);
    CHECK(black < 974);
  }
}

TEST_CASE("oblique light and eye reach the shading of each pixel") {
  const SheetView view{{35, 20}, {15, 130}, 16, 0};
  const Shading light_of = each([](const Directions& d) { return Rgb(d.wi); });
  const Shading eye_of = each([](const Directions& d) { return Rgb(d.wo); });
  const Image lights = render_sheet(light_of, view, 1);
  const Image eyes = render_sheet(eye_of, view, 1);
  for (const auto& [column, row] : {std::pair{0, 0}, {3, 5}, {15, 0}, {9, 15}}) {
    CAPTURE(column, row);
    const Slope slope = slope_at(view, column, row);
    const Vector3<double> wi = to_cloth(slope, direction(35.0, 20.0));
    const Vector3<double> wo = to_cloth(slope, direction(15.0, 130.0));
    const double scale = kPi * wi[2];
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(lights.at(column, row)[k] / scale - wi[k]) <= kRounding);
      CHECK(std::abs(eyes.at(column, row)[k] / scale - wo[k]) <= kRounding);
    }
  }
}

TEST_CASE("any number of threads draws the same pixels and counts them") {
  const Shading shading = each([](const Directions& d) {
    return Rgb{d.wi[0], d.wo[1], d.wi[2] * d.wo[0]};
  });
  const SheetView view{{30, 10}, {40, 250}, 40, 0.5};
  const Image one = render_sheet(shading, view, 1);
  for (const int threads : {2, 5}) {
    Progress progress;
    CHECK(render_sheet(shading, view, {threads, &progress}).pixels == one.pixels);
    CHECK(progress.snapshot().done == 1600);
  }
}

TEST_CASE("cancelling a sheet throws Cancelled before much more is drawn") {
  Progress progress;
  std::atomic<int> drawn = 0;
  const Shading shading = each([&](const Directions& /*any*/) {
    if (++drawn == 100) progress.cancel();
    return Rgb{};
  });
  CHECK_THROWS_AS(render_sheet(shading, {{}, {}, 64, 0}, {2, &progress}), Cancelled);
  // The row at work in each of two threads is finished.
  CHECK(drawn <= 100 + 2 * 64);
}

}  // namespace clothbrdf::test
