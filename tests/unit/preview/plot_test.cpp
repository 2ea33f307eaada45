#include "preview/plot.h"

#include <cmath>
#include <limits>

#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
const Rgb kColour = screen_colour(200, 25, 30);
const PlotAxis kAcross = {"x", 0, 10, false, {{0, "0"}, {10, "10"}}};

std::vector<Curve> one_curve(std::vector<double> dots, std::vector<double> line) {
  std::vector<double> x;
  for (std::size_t k = 0; k < dots.size(); ++k) x.push_back(static_cast<double>(k));
  return {{x, std::move(dots), std::move(line), kColour}};
}

// How far a pixel is from a colour.
double off(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

const Rgb& pixel_at(const Image& image, const Point& point) {
  return image.at(static_cast<int>(point.x), static_cast<int>(point.y));
}

int coloured(const Image& image) {
  int count = 0;
  for (const Rgb& pixel : image.pixels) {
    if (off({pixel[0], pixel[0], pixel[0]}, pixel) > 0.01) ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("dots and lines stand where their values are, on linear and on logarithmic axes") {
  for (const std::vector<double>& values :
       {std::vector<double>{0.1, 0.4, 0.2, 0.9, 0.3}, std::vector<double>{0.01, 3, 40, 0.5, 2}}) {
    const std::vector<double> none(values.size(), kNone);
    const PlotAxis y = value_axis(one_curve(values, none));
    CHECK(y.logarithmic == (values[0] < 0.05));
    const Image dots = draw_plot({"", ""}, kAcross, one_curve(values, none));
    const Image line = draw_plot({"", ""}, kAcross, one_curve(none, values));
    const Image both = draw_plot({"", ""}, kAcross, one_curve(values, values));
    for (std::size_t k = 1; k < values.size(); ++k) {
      CAPTURE(k, values[k]);
      const Point at = plot_point(kPlotFrame, kAcross, y, static_cast<double>(k), values[k]);
      CHECK(off(pixel_at(dots, at), mix(kColour, kPlotPaper, 0.4)) < 1e-12);
      // A line of 1.3 pixels covers at least this much of the pixel that its middle passes.
      CHECK(off(pixel_at(line, at), kColour) < 0.5);
      CHECK(off(pixel_at(both, at), kColour) < 0.3);
    }
    // The dots alone: discs of radius 2.6, the first one half outside.
    CHECK(std::abs(coloured(dots) - 4.5 * 3.14 * 2.6 * 2.6) < 4.5 * 14);
  }
}

TEST_CASE("an axis is logarithmic where its values span more than 20 to 1, and reaches over them") {
  for (const double ratio : {1.0, 1.5, 19.0, 21.0, 1e3, 1e5}) {
    for (const double low : {1e-90, 1e-30, 0.003, 1.0, 1e30}) {
      const PlotAxis y = value_axis(one_curve({low, kNone, low * ratio}, {low, low, low}));
      CAPTURE(ratio, low);
      CHECK(y.logarithmic == (ratio > 20));
      CHECK(y.share(low) >= 0);
      CHECK(y.share(low * ratio) <= 1);
      CHECK(y.ticks.size() >= 2);
      int named = 0;
      for (const Tick& tick : y.ticks) {
        CHECK(tick.at >= y.lowest * (1 - 1e-12));
        CHECK(tick.at <= y.highest * (1 + 1e-12));
        if (!tick.text.empty()) {
          ++named;
          CHECK_THAT(std::stod(tick.text), Catch::Matchers::WithinRel(tick.at, 1e-3) ||
                                               Catch::Matchers::WithinAbs(0, tick.at == 0));
        }
      }
      CHECK(named >= 2);
      CHECK(named <= 11);
    }
  }
}

TEST_CASE("values that underflow do not stretch an axis beyond six decades") {
  const PlotAxis y = value_axis(one_curve({1, 1e-300, 0, 0.1}, {2, 1e-200, 1e-100, 0}));
  CHECK(y.logarithmic);
  CHECK(y.highest >= 2);
  CHECK(y.lowest > 1e-7);
  CHECK(y.lowest < 1e-6);
}

TEST_CASE("what is no measurement leaves no mark") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {kNone, -1.0, -1e-9, infinity, -infinity, 1e101}) {
    CAPTURE(value);
    const std::vector<double> values(6, value);
    CHECK(coloured(draw_plot({"", ""}, kAcross, one_curve(values, values))) == 0);
    const Image one =
        draw_plot({"", ""}, kAcross, one_curve({value, 0.5, value}, {value, kNone, kNone}));
    CHECK(coloured(one) > 10);
    CHECK(coloured(one) < 40);
  }
  CHECK(coloured(draw_plot({"", ""}, kAcross, {})) == 0);
}

TEST_CASE(
    "values run upward from the lower left corner, and the marks of numbers stand beside them") {
  const Box frame = {10, 20, 200, 100};
  const PlotAxis linear = {"", 2, 4, false, {}};
  const PlotAxis decades = {"", 0.01, 100, true, {}};
  const auto is_at = [&](const PlotAxis& y, double at_x, double at_y, double x, double down) {
    const Point point = plot_point(frame, linear, y, at_x, at_y);
    CHECK_THAT(point.x, Catch::Matchers::WithinAbs(x, 1e-9));
    CHECK_THAT(point.y, Catch::Matchers::WithinAbs(down, 1e-9));
  };
  is_at(linear, 2, 2, 10, 120);
  is_at(linear, 4, 4, 210, 20);
  is_at(linear, 3, 2.5, 110, 95);
  is_at(decades, 2, 0.01, 10, 120);
  is_at(decades, 2, 1, 10, 70);
  is_at(decades, 2, 10, 10, 45);
  for (const double low : {0.01, 0.6}) {
    const std::vector<Curve> curves = one_curve({low, 1}, {low, 1});
    const PlotAxis y = value_axis(curves);
    const Image image = draw_plot({"", ""}, kAcross, curves);
    for (const Tick& tick : y.ticks) {
      const double down = plot_point(kPlotFrame, kAcross, y, 0, tick.at).y;
      CHECK(image.at(kPlotFrame.x - 3, static_cast<int>(std::lround(down))) == kPlotInk);
    }
  }
}

TEST_CASE("a gap interrupts a line, and a point between gaps is a dash") {
  const std::vector<double> none(5, kNone);
  const int whole =
      coloured(draw_plot({"", ""}, kAcross, one_curve(none, {0.5, 0.5, 0.5, 0.5, 0.5})));
  const int broken =
      coloured(draw_plot({"", ""}, kAcross, one_curve(none, {0.5, 0.5, kNone, 0.5, 0.5})));
  const int alone =
      coloured(draw_plot({"", ""}, kAcross, one_curve(none, {kNone, kNone, 0.5, kNone, kNone})));
  CHECK(broken > 0.45 * whole);
  CHECK(broken < 0.6 * whole);
  CHECK(alone >= 6);
  CHECK(alone < 0.1 * whole);
}

TEST_CASE("numbers beside axes are short") {
  CHECK(tick_text(0.25) == "0.25");
  CHECK(tick_text(3 * 0.1) == "0.3");
  CHECK(tick_text(1e30) == "1E30");
  CHECK(tick_text(2e-9) == "2E-9");
  CHECK(tick_text(0) == "0");
  CHECK(tick_text(100) == "100");
}

}  // namespace clothbrdf::test
