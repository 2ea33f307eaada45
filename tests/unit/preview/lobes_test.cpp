#include "preview/lobes.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "formats/material_json.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

// Where a disc of 64 pixels lies: its centres and its radius, pixels.
constexpr int kSize = 64;
constexpr double kCentreX = 0.5 * kSize;
constexpr double kBase[] = {0.49 * kSize, 0.99 * kSize};
constexpr double kRadius = 0.46 * kSize;

Material white() {
  Material material;
  material.weights = {0, 0, 1};
  material.warp = material.weft = {{0.5, 0.5}, {0, 0, 0}, 1, 1.5, 0, std::nullopt};
  return material;
}

// The largest f_r cos(theta_o) of both planes, at every 0.5 degrees.
double largest_length(const Material& material, double light_theta_deg) {
  const ClothModel<double> model(material);
  double largest = 0;
  for (const double azimuth : {0.0, 90.0}) {
    for (int k = -179; k < 180; ++k) {
      const double theta = 0.5 * std::abs(k);
      const DirectionPair pair = {light_theta_deg, azimuth + 180, theta,
                                  azimuth + (k < 0 ? 180 : 0)};
      const Components f = model.evaluate(pair_geometry(pair, material.rotation_deg));
      const double y = 0.2126 * f.total(0) + 0.7152 * f.total(1) + 0.0722 * f.total(2);
      largest = std::max(largest, y * std::cos(theta * std::numbers::pi / 180));
    }
  }
  return largest;
}

bool same(const Rgb& a, const Rgb& b) {
  constexpr double kRounding = 1e-12;
  return std::abs(a[0] - b[0]) <= kRounding && std::abs(a[1] - b[1]) <= kRounding &&
         std::abs(a[2] - b[2]) <= kRounding;
}

// Pixels of a disc, 0 above and 1 below, wholly of the white of specular light.
struct Highlight {
  int pixels = 0;
  double x = 0;  ///< the mean, from the centre to the right
};
Highlight highlight(const Image& image, int disc) {
  constexpr Rgb kSpecular = {0.85, 0.85, 0.85};
  Highlight found;
  for (int row = disc * kSize / 2; row < (disc + 1) * kSize / 2; ++row) {
    for (int column = 0; column < kSize; ++column) {
      if (!same(image.at(column, row), kSpecular)) continue;
      ++found.pixels;
      found.x += column + 0.5 - kCentreX;
    }
  }
  found.x /= std::max(1, found.pixels);
  return found;
}

// How many pixels of the two discs differ.
int differing(const Image& upper, const Image& lower) {
  int count = 0;
  for (int row = 0; row < kSize / 2; ++row) {
    for (int column = 0; column < kSize; ++column) {
      if (!same(upper.at(column, row), lower.at(column, row + kSize / 2))) ++count;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("the ring stands for the largest length, rounded up to 1, 2 or 5 times a power of ten") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  CAPTURE(seed);
  int steps[3] = {0, 0, 0};
  for (int n = 0; n < 40; ++n) {
    MaterialRanges ranges;
    ranges.lowest_axis = 0.1;
    Material material = random.material(ranges);
    const double brightness = random.log_uniform(1e-3, 20);
    material.weights = {brightness, brightness, brightness};
    const LobesView view{random.integer(0, 80) * 1.0, 0, kSize};
    const double scale = lobe_scale(*material_cloth(material, "m"), view);
    const double largest = largest_length(material, view.light_theta_deg);
    CAPTURE(scale, largest);
    // The directions are the same but for roundings.
    CHECK(scale >= largest * (1 - 1e-10));
    CHECK(scale <= largest * (2.5 + 1e-10));
    const double digits = scale / std::pow(10, std::floor(std::log10(scale * 1.001)));
    const int step = digits < 1.5 ? 0 : digits < 3 ? 1 : 2;
    CHECK_THAT(digits, Catch::Matchers::WithinRel(step == 0 ? 1.0 : step == 1 ? 2.0 : 5.0, 1e-12));
    ++steps[step];
  }
  for (const int count : steps) CHECK(count >= 3);
}

TEST_CASE("the lobe of a white diffuse cloth is a circle through the centre") {
  const auto cloth = material_cloth(white(), "white");
  const LobesView view{50, 0, kSize};
  CHECK(lobe_scale(*cloth, view) == 0.5);
  const Image image = render_lobes(*cloth, view);
  const double diameter = kRadius / std::numbers::pi / 0.5;
  constexpr Rgb kDiffuse = {0.35, 0.35, 0.35};
  // Half a pixel's diagonal: no pixel so far from the outline is cut by it.
  constexpr double kMargin = 0.71;
  int inside = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      CAPTURE(row, column);
      const double x = column + 0.5 - kCentreX;
      const double y = kBase[row >= kSize / 2 ? 1 : 0] - row - 0.5;
      const double beyond = std::hypot(x, y - diameter / 2) - diameter / 2;
      if (std::abs(beyond) < kMargin) continue;
      CHECK(same(image.at(column, row), kDiffuse) == (beyond < 0));
      if (beyond < 0) ++inside;
    }
  }
  CHECK(inside > 300);
}

TEST_CASE("specular light leans away from the light, which comes from the left") {
  Material material = white();
  material.weights = {1, 0, 0};
  material.warp.lobe_axes = material.weft.lobe_axes = {0.2, 0.2};
  const auto cloth = material_cloth(material, "m");
  for (const int disc : {0, 1}) {
    double previous = 0;
    for (const double theta : {0.0, 20.0, 40.0}) {
      const Highlight found = highlight(render_lobes(*cloth, {theta, 0, kSize}), disc);
      CAPTURE(disc, theta, found.x, found.pixels);
      CHECK(found.pixels > 10);
      if (theta == 0) {
        CHECK(std::abs(found.x) < 0.01);  // the picture is its own mirror image
      } else {
        CHECK(found.x > previous + 2);
      }
      previous = found.x;
    }
  }
}

TEST_CASE("diffuse, internal and specular light lie one on the other from the centre outward") {
  Material material = white();
  material.weights = {3, 3, 0.3};
  material.warp.absorption = material.weft.absorption = {2, 0, 2};
  constexpr int kLarge = 3 * kSize;
  const Image image = render_lobes(*material_cloth(material, "green"), {0, 0, kLarge});
  // Straight up from the centre; a blend of two colours at each outline.
  std::vector<Rgb> colours;
  for (int row = kLarge * 49 / 100 - 2; row > 0; --row) {
    const Rgb& colour = image.at(kLarge / 2, row);
    const bool known = !colours.empty() && same(colours.back(), colour);
    if (!known && same(colour, image.at(kLarge / 2, row + 1))) colours.push_back(colour);
  }
  REQUIRE(colours.size() >= 3);
  CHECK(same(colours[0], {0.35 * std::exp(-2), 0.35, 0.35 * std::exp(-2)}));
  CHECK_THAT(colours[1][1], Catch::Matchers::WithinAbs(0.8, 1e-12));
  CHECK(colours[1][0] < 0.2);
  CHECK(same(colours[2], {0.85, 0.85, 0.85}));
}

TEST_CASE("a line shows where the light comes from") {
  constexpr Rgb kLight = {0.9, 0.75, 0.25};
  const auto cloth = material_cloth(white(), "white");
  const double theta = 60 * std::numbers::pi / 180;
  const Image image = render_lobes(*cloth, {60, 0, 256});
  for (const double base : {0.49 * 256, 0.99 * 256}) {
    const double r = 0.8 * 0.46 * 256;
    const int row = static_cast<int>(base - r * std::cos(theta));
    CHECK(same(image.at(static_cast<int>(128 - r * std::sin(theta)), row), kLight));
    CHECK_FALSE(same(image.at(static_cast<int>(128 + r * std::sin(theta)), row), kLight));
  }
}

TEST_CASE("one yarn alone has two planes of its own, a balanced weave has the same twice") {
  // A sample on an outline may fall on either side of it.
  constexpr int kOnOutline = 4;
  Material silk = read_material(preset("silk"));
  const Image balanced = render_lobes(*material_cloth(silk, "silk"), {30, 0, kSize});
  CHECK(differing(balanced, balanced) <= kOnOutline);
  silk.warp_fraction = 1;
  const auto warp = material_cloth(silk, "warp");
  const Image alone = render_lobes(*warp, {30, 0, kSize});
  const Image turned = render_lobes(*warp, {30, 90, kSize});
  std::cout << "lobes of silk, pixels of 2048 that differ between the planes: balanced "
            << differing(balanced, balanced) << ", the warp alone " << differing(alone, alone)
            << "\n";
  CHECK(differing(alone, alone) > 200);
  // Turned by 90 degrees, what was along the weft is along the warp.
  CHECK(differing(turned, alone) <= kOnOutline);
  // The warp's lobe is narrow along the warp.
  CHECK(highlight(alone, 1).pixels < highlight(alone, 0).pixels);
}

TEST_CASE("a table without components draws its totals in the colour of the cloth") {
  TableSpec spec;
  spec.samples = inout(3, 6, 3, 6);
  spec.channels = {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}, {"B", Part::kTotal, 2}};
  const std::size_t columns = spec.column_count();
  std::vector<double> values(spec.cell_count() * 3);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = k / columns % 3 == 1 ? 0.4 : 0.1;
  std::vector<std::uint8_t> valid(spec.cell_count(), 1);
  const auto cloth = table_cloth({spec, std::move(values), std::move(valid)}, "t");
  const Image image = render_lobes(*cloth, {30, 0, kSize});
  // Just above the centre of the upper disc; brightness 0.8 for the largest channel.
  CHECK(same(image.at(kSize / 2, 24), {0.2, 0.8, 0.2}));
}

}  // namespace clothbrdf::test
