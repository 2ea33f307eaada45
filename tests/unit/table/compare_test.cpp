#include "table/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Catch::Matchers::WithinRel;

Table random_table(const Grid& grid, RandomInputs& random) {
  return plain_table(grid, [&](std::size_t) { return random.log_uniform(1e-3, 10); });
}

double mean_of(const Table& table, std::size_t channel) {
  double sum = 0;
  double sizes = 0;
  for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
    if (!table.valid(cell)) continue;
    const double size = table.spec().grid().measure(cell);
    sum += size * std::abs(table.value(cell, channel));
    sizes += size;
  }
  return sum / sizes;
}

}  // namespace

TEST_CASE("a table does not differ from itself") {
  for (const Grid& grid : {halfdiff3d(8, 8, 8), halfdiff4d(6, 4, 6, 6), inout(3, 6, 3, 6)}) {
    const Table table = preset_table("silk", grid);
    const Comparison same = compare(table, table, 1);
    CHECK(same.only_a == 0);
    REQUIRE(same.channels.size() == 3);
    for (const ChannelDifference& d : same.channels) {
      CHECK(d.rms == 0);
      CHECK(d.p99 == 0);
      CHECK(d.max == 0);
      CHECK(d.a == d.b);
    }
  }
}

TEST_CASE("a table scaled by 1 + e differs by e, less the floor") {
  const Table a = preset_table("silk", halfdiff4d(8, 6, 8, 8));
  constexpr double kScale = 1.125;  // exact in binary
  const Comparison scaled = compare(a, mapped(a, [&](double v) { return v * kScale; }), 1);
  for (std::size_t c = 0; c < 3; ++c) {
    const ChannelDifference& d = scaled.channels[c];
    double highest = 0;
    for (std::size_t cell = 0; cell < a.spec().cell_count(); ++cell) {
      highest = std::max(highest, a.value(cell, c));
    }
    // |b - a| / (|a| + floor) grows with a.
    const double max = 0.125 * highest / (highest + 1e-3 * mean_of(a, c));
    constexpr double kRounding = 1e-12;
    CHECK_THAT(d.rms, WithinRel(0.125, kRounding));
    CHECK_THAT(d.max, WithinRel(max, kRounding));
    CHECK(d.p99 <= d.max);
    CHECK(d.p99 > 0.12);
    CHECK(d.a == highest);
    CHECK(d.b == highest * kScale);
  }
}

TEST_CASE("one changed cell is the worst one, in its channel alone") {
  const Table a = preset_table("silk", halfdiff3d(10, 10, 12));
  const std::size_t cell = 2 * 120 + 3 * 12 + 4;
  REQUIRE(a.valid(cell));
  const double value = a.value(cell, 1);
  const Comparison changed = compare(a, with_value(a, cell, 1, 0.5 * value), 1);
  CHECK(changed.channels[0].max == 0);
  CHECK(changed.channels[2].max == 0);
  const ChannelDifference& d = changed.channels[1];
  CHECK(d.channel == "G");
  CHECK(d.worst_cell == cell);
  CHECK(d.a == value);
  CHECK(d.b == 0.5 * value);
  CHECK_THAT(d.max, WithinRel(0.5 * value / (value + 1e-3 * mean_of(a, 1)), 1e-12));
  CHECK(d.rms > 0);
  CHECK(d.p99 == 0);  // less than a hundredth of all directions
}

TEST_CASE("rms and p99 are what their formulas say") {
  const std::uint64_t seed = seed_from_environment();
  INFO("CLOTHBRDF_SEED=" << seed);
  RandomInputs random(seed);
  for (const Grid& grid : {halfdiff3d(6, 6, 8), halfdiff4d(5, 3, 5, 4, 360), inout(4, 5, 4, 5)}) {
    const Table a = random_table(grid, random);
    const Table b = random_table(grid, random);
    const double floor = 1e-3 * mean_of(a, 0);
    double squares = 0;
    double all_squares = 0;
    double all = 0;
    std::vector<std::pair<double, double>> relative;  // and its size
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      if (!a.valid(cell)) continue;
      const Directions d = grid.directions(cell);
      const double size = grid.measure(cell);
      const double weight = size * std::pow(d.wi[2] * d.wo[2], 2);
      squares += weight * std::pow(b.value(cell, 0) - a.value(cell, 0), 2);
      all_squares += weight * std::pow(a.value(cell, 0), 2);
      all += size;
      relative.emplace_back(
          std::abs(b.value(cell, 0) - a.value(cell, 0)) / (a.value(cell, 0) + floor), size);
    }
    const ChannelDifference found = compare(a, b, 1).channels.at(0);
    INFO(grid.description());
    CHECK_THAT(found.rms, WithinRel(std::sqrt(squares / all_squares), 1e-12));
    // Of all directions, 99 in a hundred are in cells with at most this difference, fewer in those
    // with less.
    double up_to = 0;
    double below = 0;
    double max = 0;
    for (const auto& [difference, size] : relative) {
      if (difference <= found.p99 * (1 + 1e-12)) up_to += size;
      if (difference < found.p99 * (1 - 1e-12)) below += size;
      max = std::max(max, difference);
    }
    CHECK(up_to >= 0.99 * all * (1 - 1e-12));
    CHECK(below < 0.99 * all);
    CHECK_THAT(found.max, WithinRel(max, 1e-12));
    CHECK(found.p99 < found.max);
  }
}

TEST_CASE("tables of different grids are compared at the first one's nodes") {
  const Table a = lambertian(halfdiff4d(6, 4, 6, 6), 0.5);
  for (const Grid& grid : {halfdiff3d(20, 20, 20), inout(9, 8, 9, 8)}) {
    const Comparison even = compare(a, lambertian(grid, 0.25), 1);
    CHECK_THAT(even.channels[0].rms, WithinRel(0.5, 1e-12));
    CHECK(even.cells + even.only_a == compare(a, a, 1).cells);
    CHECK(even.channels[0].worst_cell < a.spec().cell_count());
  }
}

TEST_CASE("channels are matched by name, whatever their order") {
  Table a = preset_table("silk", halfdiff3d(6, 6, 6), true);
  const Table b = preset_table("silk", halfdiff3d(6, 6, 6));
  CHECK(compare(a, b, 1).channels.size() == 3);
  TableSpec blue = b.spec();
  blue.channels = {{"B", Part::kTotal, 2}};
  std::vector<double> values;
  for (std::size_t cell = 0; cell < blue.cell_count(); ++cell) values.push_back(b.value(cell, 2));
  const Comparison only_blue = compare(b, {blue, values, cells_with_values(blue)}, 1);
  REQUIRE(only_blue.channels.size() == 1);
  CHECK(only_blue.channels[0].channel == "B");
  CHECK(only_blue.channels[0].max == 0);
}

TEST_CASE("tables with no channel or no cell in common are refused") {
  const Table red = lambertian(halfdiff3d(4, 4, 4), 0.5);
  TableSpec spec = red.spec();
  spec.channels = {{"550nm", Part::kTotal, 0}};
  const std::vector<double> values(red.values().begin(), red.values().end());
  const Table other(spec, values, cells_with_values(spec));
  CHECK_THROWS_AS(compare(red, other, 1), InputError);
  const Table empty(red.spec(), values, std::vector<std::uint8_t>(values.size()));
  CHECK_THROWS_AS(compare(red, empty, 1), InputError);
  CHECK_THROWS_AS(compare(empty, red, 1), InputError);
}

TEST_CASE("cells that only the first table has are counted, and take no other part") {
  const Table a = lambertian(halfdiff3d(6, 6, 6), 0.5);
  const Table whole = lambertian(halfdiff3d(6, 6, 6), 0.5);
  std::vector<double> values(whole.values().begin(), whole.values().end());
  std::vector<std::uint8_t> valid = cells_with_values(whole.spec());
  const auto all = static_cast<std::size_t>(std::count(valid.begin(), valid.end(), 1));
  values[1] = kNotMeasured;
  valid[1] = 0;
  values[2] = std::numeric_limits<double>::infinity();
  const Table b(whole.spec(), values, valid);
  const Comparison forth = compare(a, b, 1);
  CHECK(forth.cells == all - 2);
  CHECK(forth.only_a == 2);
  CHECK(forth.channels[0].max == 0);
  // Of b, the cell without a measurement does not count; the infinite one is its own.
  const Comparison back = compare(b, a, 1);
  CHECK(back.cells == all - 2);
  CHECK(back.only_a == 1);
  CHECK(back.channels[0].max == 0);
}

TEST_CASE("where the first table is 0 a difference is infinite, no difference is 0") {
  const Table zero = lambertian(halfdiff3d(4, 4, 4), 0);
  const ChannelDifference none = compare(zero, zero, 1).channels[0];
  CHECK(none.rms == 0);
  CHECK(none.max == 0);
  const ChannelDifference some = compare(zero, lambertian(halfdiff3d(4, 4, 4), 1), 1).channels[0];
  CHECK(std::isinf(some.rms));
  CHECK(std::isinf(some.max));
}

}  // namespace clothbrdf::test
