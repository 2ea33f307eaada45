#include <algorithm>
#include <cmath>
#include <iostream>

#include "support/errors.h"
#include "table/check.h"
#include "table/compare.h"
#include "table/resample.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// Answers every pair with the same reflectance in one channel.
class Even final : public Interpolant {
 public:
  explicit Even(double value) : value_(value) {}
  bool interpolate(const Directions& /*any*/, std::span<double> values) const override {
    values[0] = value_;
    return true;
  }
  std::string rule() const override { return "even"; }

 private:
  double value_;
};

PairList random_list(int count, bool isotropic = false) {
  RandomInputs random(seed_from_environment());
  PairList list{{}, isotropic};
  for (int k = 0; k < count; ++k) list.pairs.push_back(random.pair());
  return list;
}

Table scattered(const PairList& list, double value) {
  TableSpec spec{list, {{"R", Part::kTotal, 0}}, {}, {}};
  std::vector<double> values(list.pairs.size(), value);
  return {std::move(spec), std::move(values), std::vector<std::uint8_t>(list.pairs.size(), 1)};
}

Table even(double value) {
  return {{PairList{{{0, 0, 0, 0}}}, {{"R", Part::kTotal, 0}}, {}, {}},
          {value},
          {1},
          {},
          std::make_shared<Even>(value)};
}

}  // namespace

TEST_CASE("a table at listed pairs is what interpolation says there") {
  const Table silk = preset_table("silk", halfdiff4d(12, 10, 12, 12));
  const Table at_pairs = resample(silk, random_list(200), 1);
  REQUIRE(at_pairs.spec().has_pairs());
  std::vector<double> expected(3);
  for (std::size_t k = 0; k < 200; ++k) {
    const bool known = silk.interpolate(at_pairs.spec().directions(k), expected);
    CHECK(at_pairs.valid(k) == known);
    for (std::size_t c = 0; known && c < 3; ++c) CHECK(at_pairs.value(k, c) == expected[c]);
  }
}

TEST_CASE("isotropic pairs of an anisotropic table are the mean over rotations") {
  const Material material = read_material(preset("silk"));
  const Table silk =
      collect(*make_producer(material_spec(material, {}, halfdiff4d(60, 48, 60, 60)), 1), 1);
  const auto mean = make_producer(material_spec(material, {}, AnyPairs{true}), 1);
  const TablePairs turned(silk, true);
  CHECK(turned.spec().isotropic());
  RandomInputs random(seed_from_environment());
  double worst = 0;
  for (int k = 0; k < 200; ++k) {
    const Directions d = {direction(random.uniform(0, 60), random.azimuth()),
                          direction(random.uniform(0, 60), random.azimuth())};
    std::vector<double> found(3);
    std::vector<double> expected(3);
    turned.fill_pairs(std::span(&d, 1), found);
    mean->fill_pairs(std::span(&d, 1), expected);
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(found[c] / expected[c] - 1));
  }
  std::cout << "means over rotations of an interpolated table: worst error " << worst << '\n';
  CHECK(worst < 0.02);  // the V-cavity's kink, between nodes
}

TEST_CASE("tables without a grid are compared at random pairs, scattered samples at themselves") {
  const Comparison whole = compare(even(0.5), even(0.4), 1);
  CHECK(whole.cells == kComparedPairs);
  CHECK(whole.samples == "random pairs");
  CHECK(std::abs(whole.channels[0].rms - 0.2) < 1e-12);
  CHECK(std::abs(whole.channels[0].max - 0.2 / 1.001) < 1e-12);

  const Comparison few =
      compare(scattered({{{10, 0, 20, 0}, {30, 5, 20, 7}}, false}, 0.5), even(0.4), 1);
  CHECK(few.cells == 2);
  CHECK(few.channels[0].place == "theta_i 10 phi_i 0 theta_o 20 phi_o 0");
  // A grid is compared at its nodes, whatever the other one is.
  const Comparison grid = compare(lambertian(halfdiff3d(6, 6, 6), 1), even(0.4), 1);
  CHECK(grid.samples == "the nodes of halfdiff3d:6x6x6");
}

TEST_CASE("the albedo of a table without a grid is that of what it answers") {
  const TableCheck check = check_table(even(0.75 / std::acos(-1.0)), 1);
  REQUIRE(check.albedo.size() == 19);
  for (const Albedo& a : check.albedo) CHECK(std::abs(a.value - 0.75) < 2e-4);
  CHECK_FALSE(check.reciprocity.by_construction);
  CHECK(check.reciprocity.compared == 0);
  // Scattered samples leave most directions unsaid.
  CHECK(check_table(scattered(random_list(5), 0.5), 1).albedo.empty());
}

TEST_CASE("negative, non-finite and masked samples of a list are counted") {
  const PairList list{{{10, 0, 20, 0}, {30, 0, 20, 0}, {50, 0, 20, 0}, {95, 0, 20, 0}}, false};
  const TableSpec spec{list, {{"R", Part::kTotal, 0}}, {}, {}};
  const Table table(spec, {-0.5, std::nan(""), 1, 2}, {1, 1, 0, 0});
  const TableCheck check = check_table(table, 1);
  CHECK(check.negative.count == 1);
  CHECK(check.not_finite.count == 1);
  CHECK(check.masked == 1);
  CHECK(check.below_horizon == 1);
  CHECK(check.below_not_zero.count == 1);
}

}  // namespace clothbrdf::test
