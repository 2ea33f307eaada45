#include "preview/cloth.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "model/reflectance.h"
#include "preview/sheet.h"
#include "support/errors.h"
#include "table/spectrum.h"
#include "tests/catch.h"
#include "tests/support/lobe_condition.h"
#include "tests/support/make_table.h"
#include "tests/support/part_of.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

constexpr Part kParts[] = {Part::kTotal, Part::kSpecular, Part::kInternal, Part::kDiffuse};

// What the batch evaluator promises, times the condition number of the lobe.
constexpr double kSameImage = 1e-12;

double condition(const Material& material, const Directions& d) {
  return lobe_condition(material, pair_geometry(d.wi, d.wo, 0.0).cos_theta_d);
}

double relative_difference(double value, double exact) {
  return exact == 0 ? std::abs(value) : std::abs(value / exact - 1);
}

Material random_material(RandomInputs& random) {
  MaterialRanges ranges;
  ranges.lowest_axis = 0.1;
  return random.material(ranges);
}

Directions directions(const DirectionPair& pair) {
  return {direction(pair.theta_i, pair.phi_i), direction(pair.theta_o, pair.phi_o)};
}

double channel_value(const ClothModel<double>& model, const Directions& d, Part part,
                     std::size_t c) {
  const Components f = model.evaluate(pair_geometry(d.wi, d.wo, model.material().rotation_deg));
  return part_of(f, {"", part, c});
}

Rgb expected(const ClothModel<double>& model, const Directions& d, Part part) {
  Rgb values{};
  for (std::size_t c = 0; c < 3; ++c) values[c] = channel_value(model, d, part, c);
  return values;
}

std::string cloth_refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

// A table of 1, 2, 3, ... in its channels.
Table counting_table(const std::vector<Channel>& channels) {
  TableSpec spec;
  spec.samples = inout(2, 4, 2, 4);
  spec.channels = channels;
  std::vector<double> values(spec.cell_count() * channels.size());
  const std::size_t columns = spec.column_count();
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = static_cast<double>(k / columns % channels.size() + 1);
  }
  std::vector<std::uint8_t> valid(spec.cell_count(), 1);
  return {std::move(spec), std::move(values), std::move(valid)};
}

}  // namespace

TEST_CASE("a material's shading is the model's, part by part") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  int lit = 0;
  for (int n = 0; n < 12; ++n) {
    const Material material = random_material(random);
    const ClothModel<double> model(material);
    const auto cloth = material_cloth(material, "m");
    std::vector<Directions> pairs;
    for (int k = 0; k < 40; ++k) pairs.push_back(directions(random.pair()));
    for (const Part part : kParts) {
      const Shading shading = cloth->shading(part);
      std::vector<Rgb> f(pairs.size());
      shading(pairs, f);
      CHECK(shading(pairs[7]) == f[7]);
      for (std::size_t p = 0; p < pairs.size(); ++p) {
        const Rgb exact = expected(model, pairs[p], part);
        for (std::size_t c = 0; c < 3; ++c) {
          worst = std::max(worst,
                           relative_difference(f[p][c], exact[c]) / condition(material, pairs[p]));
          if (exact[c] > 0) ++lit;
        }
      }
    }
  }
  std::cout << "shading against the model: worst relative error over condition number " << worst
            << " (seed " << seed << ")\n";
  CHECK(worst <= kSameImage);
  CHECK(lit > 3000);
}

TEST_CASE("the parts add up to the total, and nothing is seen at or below the horizon") {
  RandomInputs random(seed_from_environment());
  for (int n = 0; n < 6; ++n) {
    const auto cloth = material_cloth(random_material(random), "m");
    const Directions d = directions(random.pair());
    Rgb sum{};
    for (const Part part : {Part::kSpecular, Part::kInternal, Part::kDiffuse}) {
      const Rgb f = cloth->shading(part)(d);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += f[c];
    }
    const Rgb total = cloth->shading(Part::kTotal)(d);
    for (std::size_t c = 0; c < 3; ++c) CHECK(relative_difference(sum[c], total[c]) <= kSameImage);
    for (const double theta : {90.0, 100.0, 180.0}) {
      const Directions below = {direction(theta, 30.0), direction(20.0, 0.0)};
      CHECK(cloth->shading(Part::kTotal)(below) == Rgb{});
      CHECK(cloth->shading(Part::kTotal)({below.wo, below.wi}) == Rgb{});
    }
  }
}

TEST_CASE("turned turns the weave counter-clockwise, as rotation_deg does") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  double other_way = 0;
  for (int n = 0; n < 12; ++n) {
    Material material = random_material(random);
    material.rotation_deg = random.uniform(-180, 180);
    const double turn = random.uniform(-180, 180);
    // Not grazing: the rounding of the half vector is magnified by 1 / (axis cos(theta_d)).
    const Directions d = directions({random.uniform(0, 75), random.uniform(0, 360),
                                     random.uniform(0, 75), random.uniform(0, 360)});
    const auto cloth = material_cloth(material, "m");
    const Rgb f = turned(cloth->shading(Part::kTotal), turn)(d);
    const Rgb back = turned(cloth->shading(Part::kTotal), -turn)(d);
    material.rotation_deg += turn;
    const Rgb exact = expected(ClothModel<double>(material), d, Part::kTotal);
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, relative_difference(f[c], exact[c]));
      other_way = std::max(other_way, relative_difference(back[c], exact[c]));
    }
  }
  std::cout << "turned against rotation_deg: worst relative error " << worst << " (seed " << seed
            << ")\n";
  CHECK(worst <= kSameImage);
  CHECK(other_way > 0.1);
}

TEST_CASE("a material of wavelengths is shaded by its channels' RGB, part by part") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  MaterialRanges ranges;
  ranges.lowest_axis = 0.1;
  double worst = 0;
  double lit = 0;
  for (int n = 0; n < 6; ++n) {
    const std::size_t channels = n == 0 ? 3 : static_cast<std::size_t>(random.integer(1, 20));
    Material material = random.material(ranges, channels);
    for (std::size_t k = 0; k < channels; ++k) {
      material.wavelengths_nm.push_back(400 + 17.5 * static_cast<double>(k));
    }
    const ChannelMatrix weights = rgb_weights(material.wavelengths_nm);
    const ClothModel<double> model(material);
    const auto cloth = material_cloth(material, "m");
    std::vector<Directions> pairs;
    for (int k = 0; k < 40; ++k) pairs.push_back(directions(random.pair()));
    for (const Part part : kParts) {
      const Shading shading = cloth->shading(part);
      std::vector<Rgb> f(pairs.size(), Rgb{7, 7, 7});
      shading(pairs, f);
      for (std::size_t p = 0; p < pairs.size(); ++p) {
        for (std::size_t c = 0; c < 3; ++c) {
          double exact = 0;
          double size = 0;  // weights have both signs
          for (std::size_t k = 0; k < channels; ++k) {
            const double value = channel_value(model, pairs[p], part, k);
            exact += weights[c][k] * value;
            size += std::abs(weights[c][k]) * value;
          }
          lit += size;
          const double error = size == 0 ? std::abs(f[p][c]) : std::abs(f[p][c] - exact) / size;
          worst = std::max(worst, error / condition(material, pairs[p]));
        }
      }
    }
  }
  std::cout << "shading of spectral materials: worst relative error over condition number " << worst
            << " (seed " << seed << ")\n";
  CHECK(worst <= kSameImage);
  CHECK(lit > 1);
}

TEST_CASE("a grey material of wavelengths draws the sheet of the grey RGB material") {
  Material rgb = read_material(preset("cotton"));
  rgb.warp.absorption = {0.3, 0.3, 0.3};
  rgb.weft.absorption = {0.6, 0.6, 0.6};
  Material spectral = rgb;
  spectral.wavelengths_nm = {420, 500, 580, 660, 700};
  spectral.warp.absorption.assign(5, 0.3);
  spectral.weft.absorption.assign(5, 0.6);
  const SheetView view{{20, 30}, {10, 190}, 64, 0};
  const auto draw = [&](const Material& material) {
    return render_sheet(material_cloth(material, "m")->shading(Part::kTotal), view, 1);
  };
  const Image expected = draw(rgb);
  const Image image = draw(spectral);
  REQUIRE(image.pixels.size() == expected.pixels.size());
  double worst = 0;
  double brightest = 0;
  for (std::size_t k = 0; k < image.pixels.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(image.pixels[k][c] - expected.pixels[k][c]));
      brightest = std::max(brightest, expected.pixels[k][c]);
    }
  }
  std::cout << "grey spectral sheet: off by " << worst << " of " << brightest << '\n';
  CHECK(brightest > 0.1);
  CHECK(worst <= kSameImage * brightest);
}

TEST_CASE("materials without wavelengths that are not of R, G and B are refused in one line") {
  Material material = read_material(preset("silk"));
  material.warp.absorption = material.weft.absorption = {0.1, 0.2};
  CHECK(cloth_refusal([&] { material_cloth(material, "s.json"); }) ==
        "s.json: absorption has 2 values; a picture needs R, G and B, or wavelengths_nm");
}

TEST_CASE("tables without channels R, G and B or without a grid are refused in one line") {
  const std::string needs = "t: has no channels R, G and B; a picture needs them";
  const auto why = [](Table table) {
    return cloth_refusal([&] { table_cloth(std::move(table), "t"); });
  };
  CHECK(why(counting_table({{"450nm", Part::kTotal, 0}, {"550nm", Part::kTotal, 1}})) == needs);
  CHECK(why(counting_table({{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}})) == needs);
  CHECK(why(counting_table(
            {{"R", Part::kDiffuse, 0}, {"G", Part::kDiffuse, 1}, {"B", Part::kDiffuse, 2}})) ==
        needs);
  TableSpec pairs;
  pairs.samples = PairList{{{0, 0, 0, 0}}};
  pairs.channels = {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}, {"B", Part::kTotal, 2}};
  CHECK(why(Table(pairs, {1, 2, 3}, {1})) ==
        "t: is a list of scattered samples; a picture needs a table that answers all directions");
}

TEST_CASE("a table's channels are found by name and part, whatever their order") {
  const auto cloth = table_cloth(counting_table({{"B", Part::kTotal, 2},
                                                 {"G", Part::kInternal, 1},
                                                 {"R", Part::kTotal, 0},
                                                 {"G", Part::kTotal, 1},
                                                 {"R", Part::kInternal, 0},
                                                 {"B", Part::kInternal, 2}}),
                                 "t");
  const Directions d = {direction(10.0, 20.0), direction(30.0, 40.0)};
  const Rgb total = cloth->shading(Part::kTotal)(d);
  const Rgb internal = cloth->shading(Part::kInternal)(d);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(relative_difference(total[c], Rgb{3, 4, 1}[c]) <= 1e-14);  // shares of 16 nodes add up
    CHECK(relative_difference(internal[c], Rgb{5, 2, 6}[c]) <= 1e-14);
  }
  CHECK(cloth->has(Part::kInternal));
  CHECK_FALSE(cloth->has(Part::kSpecular));
}

TEST_CASE(
    "a cloth has the parts that its table has, and a material has all, and both give the same") {
  const Material material = read_material(preset("silk"));
  const auto whole = material_cloth(material, "m");
  const Grid grid = halfdiff4d(6, 6, 5, 5);
  const auto parts = table_cloth(preset_table("silk", grid, true), "t");
  const auto totals = table_cloth(preset_table("silk", grid, false), "t");
  for (const Part part : kParts) {
    CHECK(whole->has(part));
    CHECK(parts->has(part));
    CHECK(totals->has(part) == (part == Part::kTotal));
    const Directions node = grid.directions(((2 * 6 + 3) * 5 + 1) * 5 + 4);
    REQUIRE(node.above_horizon());
    const Rgb exact = whole->shading(part)(node);
    const Rgb f = parts->shading(part)(node);
    for (std::size_t c = 0; c < 3; ++c) CHECK(relative_difference(f[c], exact[c]) <= kSameImage);
  }
}

}  // namespace clothbrdf::test
