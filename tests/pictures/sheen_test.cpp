#include <iostream>
#include <numbers>

#include "tests/catch.h"
#include "tests/pictures/sheets.h"

namespace clothbrdf::test {
namespace {

const SheetView kView = {{}, {}, 128, 0};  // light and eye straight above, as in the paper

// How much brighter the directional light is where the sheet slopes along a yarn than where it
// slopes between them.
double anisotropy(const std::string& name) {
  const auto cloth = preset_cloth(name);
  const Image specular = sheet_of(*cloth, kView, Part::kSpecular);
  const Image internal = sheet_of(*cloth, kView, Part::kInternal);
  std::vector<double> along;
  std::vector<double> between;
  for (int row = 0; row < kView.size; ++row) {
    for (int column = 0; column < kView.size; ++column) {
      const Slope slope = slope_at(kView.size, column, row);
      const double steep = std::hypot(slope.x, slope.y);
      if (steep < 0.2 || steep > 0.35) continue;
      // From the nearest yarn, 0 to 45 degrees.
      const double off = std::atan2(std::min(std::abs(slope.x), std::abs(slope.y)),
                                    std::max(std::abs(slope.x), std::abs(slope.y))) *
                         180 / std::numbers::pi;
      const double sheen =
          luminance(specular.at(column, row)) + luminance(internal.at(column, row));
      if (off <= 10) along.push_back(sheen);
      if (off >= 35) between.push_back(sheen);
    }
  }
  REQUIRE(along.size() >= 100);
  REQUIRE(between.size() >= 100);
  return mean(along) / mean(between);
}

// How bright the brightest hundredth of a sheet is, how much it varies, and how much of it lies in
// the upper half of its brightness.
struct Contrast {
  double peak;       ///< 99th percentile over the median
  double variation;  ///< standard deviation over the mean
  double bright;     ///< share of pixels above half-way from the median to the maximum
};
Contrast contrast(const std::string& name) {
  const std::vector<double> y = luminances(sheet_of(*preset_cloth(name), kView));
  const double median = percentile(y, 0.5);
  const double half_way = (median + percentile(y, 1)) / 2;
  double squares = 0;
  double bright = 0;
  for (const double v : y) {
    squares += (v - mean(y)) * (v - mean(y));
    if (v > half_way) ++bright;
  }
  const auto count = static_cast<double>(y.size());
  const Contrast c = {percentile(y, 0.99) / median, std::sqrt(squares / count) / mean(y),
                      bright / count};
  std::cout << name << "'s sheet: 99th percentile over median " << c.peak
            << ", relative standard deviation " << c.variation << ", share of bright pixels "
            << c.bright << "\n";
  return c;
}

// How much the picture changes when the weave turns by 45 degrees.
double change_by_turning(const std::string& name) {
  const auto cloth = preset_cloth(name);
  return difference(sheet_of(*cloth, kView), sheet_of(*cloth, kView, Part::kTotal, 45)).rms;
}

}  // namespace

TEST_CASE("silk's sheen lies where the sheet slopes along a yarn, cotton's anywhere") {
  const double silk = anisotropy("silk");
  const double cotton = anisotropy("cotton");
  std::cout << "sheen along a yarn over sheen between yarns, slopes 0.2 to 0.35: silk " << silk
            << ", cotton " << cotton << "\n";
  CHECK(silk >= 1.25);
  CHECK(std::abs(cotton - 1) <= 0.03);
}

TEST_CASE("silk has a bright, narrow sheen on a darker ground, cotton is flat") {
  const Contrast silk = contrast("silk");
  const Contrast cotton = contrast("cotton");
  CHECK(silk.peak >= 1.6);
  CHECK(cotton.peak <= 1.15);
  CHECK(silk.variation >= 3 * cotton.variation);
  CHECK(cotton.variation <= 0.08);
  CHECK(silk.bright <= 0.12);
  CHECK(cotton.bright >= 2 * silk.bright);
}

TEST_CASE("turning the weave by 45 degrees changes silk's pattern, hardly cotton's") {
  const double silk = change_by_turning("silk");
  const double cotton = change_by_turning("cotton");
  std::cout << "weave at 45 degrees against 0: relative rms difference, silk " << silk
            << ", cotton " << cotton << "\n";
  CHECK(silk >= 0.07);
  CHECK(cotton <= 0.001);
}

}  // namespace clothbrdf::test
