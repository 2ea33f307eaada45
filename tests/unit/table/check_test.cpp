#include "table/check.h"

#include <cmath>
#include <limits>

#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr StoredPrecision kHalf{0x1p-11, 0x1p-24};

bool all_well(const TableCheck& check) {
  return check.not_finite.count == 0 && check.negative.count == 0 &&
         check.below_not_zero.count == 0 && !check.reciprocity_broken() &&
         check.largest_albedo().value().value <= kHighestAlbedo;
}

// Once around; the mirror of cell 1 is cell 5.
const Grid kAround = halfdiff4d(4, 3, 4, 8, 360);

std::size_t cell_of(const Grid& grid, double theta_i, double phi_i, double theta_o, double phi_o) {
  return grid.cell_of(direction(theta_i, phi_i), direction(theta_o, phi_o)).value();
}

// A cell wholly below the horizon.
std::size_t cell_below(const Grid& grid) {
  std::size_t cell = grid.cell_count() - 1;
  while (grid.any_above_horizon(cell)) --cell;
  return cell;
}

}  // namespace

TEST_CASE("nothing is found in tables where nothing is wrong") {
  for (const Grid& grid :
       {halfdiff3d(12, 12, 24), halfdiff3d(12, 12, 24, 360), halfdiff4d(8, 6, 8, 8),
        halfdiff4d(8, 6, 8, 8, 360), inout(6, 8, 6, 8)}) {
    INFO(grid.description());
    const TableCheck plain = check_table(lambertian(grid, 0.5), 1);
    CHECK(all_well(plain));
    CHECK(plain.cells == grid.cell_count());
    CHECK(plain.masked == 0);
    if (grid.axes.size() == 3) CHECK(plain.below_horizon > 0);
    const TableCheck cotton = check_table(preset_table("cotton", grid), 1);
    CHECK(all_well(cotton));
    CHECK(cotton.reciprocity.worst <= cotton.reciprocity.allowed);
  }
}

TEST_CASE("values that are no numbers are counted, and the first one placed") {
  const Table clean = lambertian(halfdiff3d(8, 8, 8), 0.5);
  const Table planted = with_value(with_value(clean, 20, 0, kNan), 10, 0, -kInfinity);
  const TableCheck check = check_table(planted, 1);
  CHECK(check.not_finite.count == 2);
  CHECK(check.not_finite.worst.cell == 10);
  CHECK(check.not_finite.worst.value == -kInfinity);
  CHECK(check.negative.count == 0);
  CHECK(check_table(with_value(clean, 20, 0, kNan), 1).not_finite.count == 1);
  CHECK(std::isnan(check_table(with_value(clean, 20, 0, kNan), 1).not_finite.worst.value));
}

TEST_CASE("a value that is no number is found below the horizon too") {
  const Grid grid = halfdiff3d(8, 8, 8);
  const Table planted = with_value(lambertian(grid, 0.5), cell_below(grid), 0, kNan);
  CHECK(check_table(planted, 1).not_finite.count == 1);
}

TEST_CASE("negative values above the horizon are counted, and the lowest one placed") {
  const Grid grid = halfdiff4d(6, 4, 6, 6);
  const Table clean = preset_table("cotton", grid);
  const Table planted =
      with_value(with_value(with_value(clean, 5, 2, -1e-9), 7, 1, -0.5), 9, 0, -1e-3);
  const TableCheck check = check_table(planted, 1);
  CHECK(check.negative.count == 3);
  CHECK(check.negative.worst.cell == 7);
  CHECK(check.negative.worst.channel == 1);
  CHECK(check.negative.worst.value == -0.5);
  CHECK(check.below_not_zero.count == 0);
}

TEST_CASE("below the horizon negative marks are excepted and positive values noted") {
  const Grid grid = halfdiff3d(8, 8, 8);
  const std::size_t below = cell_below(grid);
  const Table clean = lambertian(grid, 0.5);
  CHECK(all_well(check_table(with_value(clean, below, 0, kNotMeasured), 1)));
  const TableCheck check = check_table(with_value(clean, below, 0, 0.25), 1);
  CHECK(check.below_not_zero.count == 1);
  CHECK(check.below_not_zero.worst.cell == below);
  CHECK(check.below_not_zero.worst.value == 0.25);
  CHECK(check.negative.count == 0);
}

TEST_CASE("cells above the horizon that are marked as not valid are counted") {
  const Table clean = lambertian(halfdiff3d(8, 8, 8), 0.5);
  const TableSpec& spec = clean.spec();
  std::vector<double> values(clean.values().begin(), clean.values().end());
  values[3] = values[4] = values[cell_below(spec.grid())] = kNotMeasured;
  std::vector<std::uint8_t> valid = cells_with_values(spec);
  mask_not_measured(spec, values, valid);
  const TableCheck check = check_table({spec, values, valid}, 1);
  CHECK(check.masked == 2);
  CHECK(check.negative.count == 2);  // the excepted mask is the one below the horizon
}

TEST_CASE("a reciprocity break in an in/out table is found with both its values") {
  const Grid grid = inout(4, 8, 4, 8);
  const Table clean = preset_table("silk", grid);
  const TableCheck before = check_table(clean, 1);
  CHECK(all_well(before));
  CHECK(before.below_horizon == 0);
  CHECK(before.reciprocity.promised);
  CHECK(!before.reciprocity.by_construction);
  // Of 32 directions each pair of different ones.
  CHECK(before.reciprocity.compared == 32 * 31 / 2);
  const std::size_t cell = cell_of(grid, 22.5, 45, 67.5, 270);
  const std::size_t mirror = cell_of(grid, 67.5, 270, 22.5, 45);
  const double value = clean.value(cell, 1);
  constexpr double kBreak = 1e-9;
  const Table broken = with_value(clean, mirror, 1, value * (1 + kBreak));
  const TableCheck after = check_table(broken, 1);
  CHECK(after.reciprocity_broken());
  CHECK_THAT(after.reciprocity.worst, Catch::Matchers::WithinRel(kBreak, 1e-5));
  CHECK(after.reciprocity.here.cell == std::min(cell, mirror));
  CHECK(after.reciprocity.here.channel == 1);
  CHECK(after.reciprocity.here.value == broken.value(std::min(cell, mirror), 1));
  CHECK(after.reciprocity.mirrored == broken.value(std::max(cell, mirror), 1));
}

TEST_CASE("a reciprocity break in a half/difference table once around is found") {
  for (const Grid& grid : {kAround, halfdiff3d(6, 6, 8, 360)}) {
    const Table clean = preset_table("silk", grid);
    const TableCheck before = check_table(clean, 1);
    INFO(grid.description());
    CHECK(before.reciprocity.compared > 20);
    CHECK(before.reciprocity.worst <= before.reciprocity.allowed);
    // phi_d is the last axis, of 8 cells: the mirror is four further.
    const TableCheck after = check_table(with_value(clean, 5, 0, clean.value(5, 0) * 1.001), 1);
    CHECK(after.reciprocity_broken());
    CHECK(after.reciprocity.here.cell == 1);
    CHECK_THAT(after.reciprocity.worst, Catch::Matchers::WithinRel(1 - 1 / 1.001, 1e-9));
  }
}

TEST_CASE("where mirror cells are not in the grid, or are the same cell, none are compared") {
  CHECK(check_table(lambertian(halfdiff4d(4, 3, 4, 7, 360), 0.5), 1).reciprocity.compared == 0);
  const TableCheck folded = check_table(preset_table("silk", halfdiff4d(4, 3, 4, 8)), 1);
  CHECK(folded.reciprocity.by_construction);
  CHECK(folded.reciprocity.compared == 0);
  // Thetas 0, 45 are among 0, 22.5, 45, 67.5; azimuths 0, 120, 240 and 0, 90, 180, 270 share 0.
  const TableCheck uneven = check_table(lambertian(inout(2, 3, 4, 4), 0.5), 1);
  CHECK(uneven.reciprocity.compared == 1);
}

TEST_CASE(
    "reciprocity is promised of microfacet materials, not of the paper's nor of measured data") {
  const Grid grid = inout(4, 8, 4, 8);
  const TableCheck paper = check_table(preset_table("silk_paper", grid), 1);
  CHECK(!paper.reciprocity.promised);
  CHECK(paper.reciprocity.worst > 0.01);
  CHECK(!paper.reciprocity_broken());
  const TableCheck measured = check_table(with_value(lambertian(kAround, 0.5), 1, 0, 0.2), 1);
  CHECK(!measured.reciprocity.promised);
  CHECK(measured.reciprocity.worst > 0.1);
  CHECK(!measured.reciprocity_broken());
}

TEST_CASE("rounding to half floats is no reciprocity break, ten times as much is") {
  const std::uint64_t seed = seed_from_environment();
  INFO("CLOTHBRDF_SEED=" << seed);
  RandomInputs random(seed);
  const Table exact = preset_table("silk", kAround);
  std::vector<double> values;
  // Each value as far off as a half float may be, to either side.
  for (const double v : exact.values()) {
    values.push_back(v * (1 + (random.chance(0.5) ? 1 : -1) * kHalf.relative));
  }
  const std::vector<std::uint8_t> valid = cells_with_values(exact.spec());
  const Table rounded(exact.spec(), values, valid, kHalf);
  CHECK(!check_table(rounded, 1).reciprocity_broken());
  CHECK(check_table({exact.spec(), values, valid}, 1).reciprocity_broken());
  const double off = rounded.value(1, 2) * (1 + 10 * kHalf.relative);
  CHECK(check_table(with_value(rounded, 5, 2, off), 1).reciprocity_broken());
}

TEST_CASE("the smallest numbers of a file may be a step apart, not two") {
  const Table exact = preset_table("silk", kAround);
  std::vector<double> values(exact.values().size(), 3 * kHalf.step);
  const std::vector<std::uint8_t> valid = cells_with_values(exact.spec());
  const Table tiny(exact.spec(), values, valid, kHalf);
  CHECK(!check_table(with_value(tiny, 1, 0, 4 * kHalf.step), 1).reciprocity_broken());
  CHECK(check_table(with_value(tiny, 1, 0, 5 * kHalf.step), 1).reciprocity_broken());
}

TEST_CASE("the tolerance of averages is allowed for") {
  TableSpec spec = preset_table("silk", kAround).spec();
  const std::vector<double> values(spec.cell_count() * spec.channels.size(), 0.1);
  const std::vector<std::uint8_t> valid = cells_with_values(spec);
  spec.cells = {.average = true, .tolerance = 0.01};
  const Table even(spec, values, valid);
  CHECK(!check_table(with_value(even, 1, 0, 0.1 * 1.015), 1).reciprocity_broken());
  CHECK(check_table(with_value(even, 1, 0, 0.1 * 1.03), 1).reciprocity_broken());
}

}  // namespace clothbrdf::test
