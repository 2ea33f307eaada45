#include "preview/cloth.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "model/reflectance.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

constexpr Part kParts[] = {Part::kTotal, Part::kSpecular, Part::kInternal, Part::kDiffuse};

// Sums over lobes in another order: a few roundings each.
constexpr double kSameToRounding = 1e-12;

double relative_error(double value, double exact) {
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

Rgb expected(const ClothModel<double>& model, const Directions& d, Part part) {
  const Components f = model.evaluate(pair_geometry(d.wi, d.wo, model.material().rotation_deg));
  Rgb values{};
  for (std::size_t c = 0; c < 3; ++c) {
    switch (part) {
      case Part::kTotal: values[c] = f.total(c); break;
      case Part::kSpecular: values[c] = f.specular[c]; break;
      case Part::kInternal: values[c] = f.internal[c]; break;
      case Part::kDiffuse: values[c] = f.diffuse[c]; break;
    }
  }
  return values;
}

std::string refusal(const std::function<void()>& call) {
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

TEST_CASE("a material's shading is the model's, part by part, with cos(theta_d) known or not") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  int lit = 0;
  for (int n = 0; n < 40; ++n) {
    const Material material = random_material(random);
    const ClothModel<double> model(material);
    const auto cloth = material_cloth(material, "m");
    for (int k = 0; k < 10; ++k) {
      const DirectionPair pair = random.pair();
      const Directions d = directions(pair);
      const double cosine = pair_geometry(d.wi, d.wo, 0.0).cos_theta_d;
      for (const Part part : kParts) {
        const Rgb exact = expected(model, d, part);
        const Rgb known = cloth->shading(part, cosine)(d);
        const Rgb unknown = cloth->shading(part, std::nullopt)(d);
        for (std::size_t c = 0; c < 3; ++c) {
          worst = std::max(
              {worst, relative_error(known[c], exact[c]), relative_error(unknown[c], exact[c])});
          if (exact[c] > 0) ++lit;
        }
      }
    }
  }
  std::cout << "shading against the model: worst relative error " << worst << " (seed " << seed
            << ")\n";
  CHECK(worst <= kSameToRounding);
  CHECK(lit > 3000);
}

TEST_CASE("one fixed cos(theta_d) serves all pairs that have it") {
  RandomInputs random(seed_from_environment());
  const Material material = random_material(random);
  const ClothModel<double> model(material);
  const Vector3<double> wi = direction(40.0, 10.0);
  const Vector3<double> wo = direction(25.0, 170.0);
  const double cosine = pair_geometry(wi, wo, 0.0).cos_theta_d;
  const Shading shading = material_cloth(material, "m")->shading(Part::kTotal, cosine);
  for (double turn = 0; turn < 360; turn += 7) {
    const Directions d = {turned(wi, sincosd(turn)), turned(wo, sincosd(turn))};
    const Rgb exact = expected(model, d, Part::kTotal);
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(relative_error(shading(d)[c], exact[c]) <= kSameToRounding);
    }
  }
}

TEST_CASE("the parts add up to the total, and nothing is seen at or below the horizon") {
  RandomInputs random(seed_from_environment());
  for (int n = 0; n < 20; ++n) {
    const auto cloth = material_cloth(random_material(random), "m");
    const Directions d = directions(random.pair());
    Rgb sum{};
    for (const Part part : {Part::kSpecular, Part::kInternal, Part::kDiffuse}) {
      const Rgb f = cloth->shading(part, std::nullopt)(d);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += f[c];
    }
    const Rgb total = cloth->shading(Part::kTotal, std::nullopt)(d);
    for (std::size_t c = 0; c < 3; ++c) CHECK(relative_error(sum[c], total[c]) <= 1e-15);
    for (const double theta : {90.0, 100.0, 180.0}) {
      const Directions below = {direction(theta, 30.0), direction(20.0, 0.0)};
      CHECK(cloth->shading(Part::kTotal, std::nullopt)(below) == Rgb{});
      CHECK(cloth->shading(Part::kTotal, 0.5)({below.wo, below.wi}) == Rgb{});
    }
  }
}

TEST_CASE("turned turns the weave counter-clockwise, as rotation_deg does") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  double other_way = 0;
  for (int n = 0; n < 100; ++n) {
    Material material = random_material(random);
    material.rotation_deg = random.uniform(-180, 180);
    const double turn = random.uniform(-180, 180);
    // Not grazing: the rounding of the half vector is magnified by 1 / (axis cos(theta_d)).
    const Directions d = directions({random.uniform(0, 75), random.uniform(0, 360),
                                     random.uniform(0, 75), random.uniform(0, 360)});
    const auto cloth = material_cloth(material, "m");
    const Rgb f = turned(cloth->shading(Part::kTotal, std::nullopt), turn)(d);
    const Rgb back = turned(cloth->shading(Part::kTotal, std::nullopt), -turn)(d);
    material.rotation_deg += turn;
    const Rgb exact = expected(ClothModel<double>(material), d, Part::kTotal);
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, relative_error(f[c], exact[c]));
      other_way = std::max(other_way, relative_error(back[c], exact[c]));
    }
  }
  std::cout << "turned against rotation_deg: worst relative error " << worst << " (seed " << seed
            << ")\n";
  CHECK(worst <= kSameToRounding);
  CHECK(other_way > 0.1);
}

TEST_CASE(
    "materials that are not of R, G and B are refused in one line that starts with the name") {
  Material material = read_material(preset("silk"));
  material.wavelengths_nm = {450, 550, 650};
  CHECK(refusal([&] { material_cloth(material, "s.json"); }) ==
        "s.json: wavelengths_nm has 3 values; a picture needs absorption of R, G and B, without "
        "wavelengths_nm");
  material.wavelengths_nm.clear();
  material.warp.absorption = material.weft.absorption = {0.1, 0.2};
  CHECK(refusal([&] { material_cloth(material, "s.json"); }) ==
        "s.json: absorption has 2 values; a picture needs R, G and B");
}

TEST_CASE("tables without channels R, G and B or without a grid are refused in one line") {
  const std::string needs = "t: has no channels R, G and B; a picture needs them";
  const auto why = [](Table table) { return refusal([&] { table_cloth(std::move(table), "t"); }); };
  CHECK(why(counting_table({{"450nm", Part::kTotal, 0}, {"550nm", Part::kTotal, 1}})) == needs);
  CHECK(why(counting_table({{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}})) == needs);
  CHECK(why(counting_table(
            {{"R", Part::kDiffuse, 0}, {"G", Part::kDiffuse, 1}, {"B", Part::kDiffuse, 2}})) ==
        needs);
  TableSpec pairs;
  pairs.samples = std::vector<DirectionPair>{{0, 0, 0, 0}};
  pairs.channels = {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}, {"B", Part::kTotal, 2}};
  CHECK(why(Table(pairs, {1, 2, 3}, {1})) == "t: is a list of pairs; a picture needs a grid");
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
  const Rgb total = cloth->shading(Part::kTotal, std::nullopt)(d);
  const Rgb internal = cloth->shading(Part::kInternal, 0.9)(d);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(relative_error(total[c], Rgb{3, 4, 1}[c]) <= 1e-14);  // shares of 16 nodes add up
    CHECK(relative_error(internal[c], Rgb{5, 2, 6}[c]) <= 1e-14);
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
    const Rgb exact = whole->shading(part, std::nullopt)(node);
    const Rgb f = parts->shading(part, std::nullopt)(node);
    for (std::size_t c = 0; c < 3; ++c) CHECK(relative_error(f[c], exact[c]) <= kSameToRounding);
  }
}

}  // namespace clothbrdf::test
