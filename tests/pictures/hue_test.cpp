#include <iostream>
#include <numbers>

#include "tests/catch.h"
#include "tests/pictures/sheets.h"

namespace clothbrdf::test {
namespace {

// a* and b* of CIELAB for D65, the hue of a colour as an eye sees it.
struct Chroma {
  double a = 0;
  double b = 0;
  double saturation() const { return std::hypot(a, b); }
  double hue_deg() const { return std::atan2(b, a) * 180 / std::numbers::pi; }
};

Chroma chroma(const Rgb& c) {
  const auto f = [](double t) {
    constexpr double kLinear = 216.0 / 24389;
    return t > kLinear ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
  const double y = f(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  return {500 * (x - y), 200 * (y - z)};
}

// The mean colours of the brightest and the darkest pixels of a sheet, a twentieth each.
struct Ends {
  Chroma sheen;
  Chroma valley;
  /// [0, 180]
  double hue_change_deg() const {
    return std::abs(std::remainder(sheen.hue_deg() - valley.hue_deg(), 360));
  }
};
Ends ends(const std::string& name, const SheetView& view) {
  const Image image = sheet_of(*preset_cloth(name), view);
  const std::vector<double> y = luminances(image);
  const double bright = percentile(y, 0.95);
  const double dark = percentile(y, 0.05);
  Rgb sheen{};
  Rgb valley{};
  double scale = 0;
  for (std::size_t p = 0; p < y.size(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (y[p] >= bright) sheen[c] += image.pixels[p][c];
      if (y[p] <= dark) valley[c] += image.pixels[p][c];
    }
    scale += 0.05;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    sheen[c] /= scale;
    valley[c] /= scale;
  }
  const Ends found = {chroma(sheen), chroma(valley)};
  std::cout << name << "'s sheet, light " << view.light.theta_deg << ": hue of the sheen "
            << found.sheen.hue_deg() << ", of the valleys " << found.valley.hue_deg()
            << " degrees; saturation " << found.sheen.saturation() << " and "
            << found.valley.saturation() << "\n";
  return found;
}

}  // namespace

TEST_CASE(
    "shot silk shows another hue in its sheen than in its valleys, one yarn colour does not") {
  const SheetView view = {{}, {}, 128, 0};
  const Ends shot = ends("tamamushi", view);
  CHECK(shot.hue_change_deg() >= 50);
  CHECK(shot.sheen.saturation() >= 1.03 * shot.valley.saturation());
  CHECK(ends("silk", view).hue_change_deg() <= 8);
  CHECK(ends("cotton", view).hue_change_deg() <= 2);
}

}  // namespace clothbrdf::test
