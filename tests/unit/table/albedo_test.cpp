#include "table/albedo.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <vector>

#include "table/check.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

const Albedo& at_theta(const std::vector<Albedo>& albedo, double theta_deg) {
  return *std::find_if(albedo.begin(), albedo.end(),
                       [&](const Albedo& a) { return a.theta_i_deg == theta_deg; });
}

constexpr std::size_t kAzimuths = 4;  // of the light, every 45 degrees: silk repeats at 180

// Of silk's red, which it absorbs least, at theta_i = 15 k degrees and each azimuth of the light:
// the model itself by the rectangle rule over nodes of wo, good for four digits.
std::vector<double> model_albedo(std::size_t theta) {
  constexpr int kThetas = 120;
  constexpr int kPhis = 120;
  static const auto kProducer = make_producer(
      material_spec(read_material(preset("silk")), {}, inout(6, 2 * kAzimuths, kThetas, kPhis)), 2);
  std::vector<double> row(kProducer->spec().row_values());
  std::vector<double> albedo;
  for (std::size_t azimuth = 0; azimuth < kAzimuths; ++azimuth) {
    kProducer->fill_rows(theta * 2 * kAzimuths + azimuth, row);
    double sum = 0;
    for (std::size_t k = 0; k < std::size_t{kThetas} * kPhis; ++k) {
      const std::size_t theta_index = k / kPhis;
      const SinCos<double> theta_o = sincosd(90.0 / kThetas * static_cast<double>(theta_index));
      sum += row[k] * theta_o.cos * theta_o.sin;
    }
    albedo.push_back(sum * degrees_to_radians(90.0 / kThetas) * degrees_to_radians(360.0 / kPhis));
  }
  return albedo;
}

}  // namespace

TEST_CASE("a table that reflects evenly has the same albedo at every angle, on every grid") {
  struct Row {
    Grid grid;
    // Relative, of the rule of midpoints on so many cells. Eight phi_d once around are too few:
    // near the horizon there are pairs of directions with no node above it around them.
    double tolerance;
  };
  const Row rows[] = {
      {halfdiff3d(45, 45, 90), 3e-3},    {halfdiff3d(12, 30, 60, 360), 3e-3},
      {halfdiff4d(20, 4, 20, 20), 3e-3}, {halfdiff4d(8, 12, 8, 8, 360), 0.04},
      {halfdiff4d(6, 4, 5, 10), 3e-3},   {inout(), 3e-4},
      {inout(18, 6, 7, 6), 3e-4},
  };
  for (const Row& row : rows) {
    constexpr double kAlbedo = 0.6;
    const std::vector<Albedo> albedo = albedo_by_theta(lambertian(row.grid, kAlbedo), 2);
    double worst = 0;
    for (const Albedo& a : albedo) {
      if (a.theta_i_deg <= kHighestTheta) worst = std::max(worst, std::abs(a.value / kAlbedo - 1));
    }
    std::cout << "even table on " << row.grid.description() << ": albedo off by " << worst
              << " up to 85 degrees, " << albedo.back().value / kAlbedo - 1 << " at "
              << albedo.back().theta_i_deg << '\n';
    CHECK(worst <= row.tolerance);
  }
}

TEST_CASE("an albedo is given every 5 degrees and at 89, as far as the table goes") {
  const std::vector<Albedo> all = albedo_by_theta(lambertian(halfdiff3d(4, 90, 4), 0.5), 1);
  REQUIRE(all.size() == 19);
  for (std::size_t k = 0; k < 18; ++k) CHECK(all[k].theta_i_deg == 5.0 * static_cast<double>(k));
  CHECK(all.back().theta_i_deg == 89);
  CHECK(albedo_by_theta(lambertian(halfdiff3d(4, 4, 4), 0.5), 1).back().theta_i_deg == 85);
  const std::vector<Albedo> utia = albedo_by_theta(lambertian(inout(6, 1, 6, 1), 0.5), 1);
  CHECK(utia.back().theta_i_deg == 75);
}

TEST_CASE("the albedo of a material's table is that of the model") {
  // Linear interpolation on lobes as wide as silk's overshoots between nodes 6 degrees apart.
  constexpr double kTolerance = 0.008;
  std::map<std::size_t, std::vector<double>> models;
  for (const std::size_t k : {1U, 5U}) models[k] = model_albedo(k);
  for (const Grid& grid :
       {halfdiff3d(60, 60, 90), halfdiff4d(24, 18, 24, 24), inout(6, 8, 45, 60)}) {
    const std::vector<Albedo> albedo = albedo_by_theta(preset_table("silk", grid), 2);
    for (const auto& [k, of_model] : models) {
      const Albedo& found = at_theta(albedo, 15.0 * static_cast<double>(k));
      CHECK(found.channel == 0);
      double expected = *std::max_element(of_model.begin(), of_model.end());
      if (grid.kind == GridKind::kHalfDifference3d) {
        expected = std::accumulate(of_model.begin(), of_model.end(), 0.0) / kAzimuths;
      } else {
        const auto azimuth = static_cast<std::size_t>(found.phi_i_deg / 45) % kAzimuths;
        CHECK_THAT(of_model[azimuth], Catch::Matchers::WithinRel(expected, 1e-6));
      }
      std::cout << "silk on " << grid.description() << ": albedo " << found.value << " at theta_i "
                << found.theta_i_deg << ", of the model " << expected << '\n';
      CHECK_THAT(found.value, Catch::Matchers::WithinRel(expected, kTolerance));
    }
  }
}

TEST_CASE("an albedo above 1 is found where it is") {
  const Table bright = mapped(preset_table("silk", halfdiff4d(20, 12, 20, 20)),
                              [](double value) { return 3 * value; });
  const TableCheck check = check_table(bright, 1);
  const Albedo largest = check.largest_albedo().value();
  CHECK(largest.value > kHighestAlbedo);
  CHECK(largest.theta_i_deg == 85);
  CHECK(largest.channel == 0);  // silk absorbs red least
  CHECK(largest.value == at_theta(check.albedo, 85).value);
  // Just above 1, and just below.
  const Grid grid = halfdiff3d(20, 20, 20);
  CHECK(check_table(lambertian(grid, 1.02), 1).largest_albedo()->value > kHighestAlbedo);
  CHECK(check_table(lambertian(grid, 1), 1).largest_albedo()->value < kHighestAlbedo);
}

TEST_CASE("beyond 85 degrees no albedo is the largest") {
  TableCheck check;
  check.albedo = {{.theta_i_deg = 85, .value = 0.5}, {.theta_i_deg = 89, .value = 7}};
  CHECK(check.largest_albedo()->value == 0.5);
  check.albedo.clear();
  CHECK(!check.largest_albedo());
}

TEST_CASE("cells without a measurement take no part in an albedo, any number of threads the same") {
  const Table whole = lambertian(halfdiff4d(8, 4, 8, 8), 0.5);
  std::vector<double> values(whole.values().begin(), whole.values().end());
  for (std::size_t cell = 0; cell < values.size(); cell += 7) values[cell] = kNotMeasured;
  std::vector<std::uint8_t> valid = cells_with_values(whole.spec());
  mask_not_measured(whole.spec(), values, valid);
  const Table masked(whole.spec(), values, valid);
  const std::vector<Albedo> one = albedo_by_theta(masked, 1);
  const std::vector<Albedo> three = albedo_by_theta(masked, 3);
  for (std::size_t k = 0; k < one.size(); ++k) {
    CHECK(one[k].value == three[k].value);
    CHECK(one[k].phi_i_deg == three[k].phi_i_deg);
    // The few directions around which all cells are left out are missing.
    if (one[k].theta_i_deg <= 80) CHECK_THAT(one[k].value, Catch::Matchers::WithinRel(0.5, 0.01));
  }
}

}  // namespace clothbrdf::test
