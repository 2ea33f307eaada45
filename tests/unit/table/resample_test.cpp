#include "table/resample.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>
#include <vector>

#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

using Catch::Matchers::WithinRel;

bool same_values(const Table& a, const Table& b) {
  return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end());
}

// Root mean square of the relative differences at the nodes up to 55 degrees: no cell around them
// is near the horizon. (The largest one depends on where nodes happen to lie between nodes.)
double error_away_from_grazing(const Table& found, const Table& expected) {
  const TableSpec& spec = expected.spec();
  const double lowest = sincosd(55.0).cos;
  double sum = 0;
  double count = 0;
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    const Directions d = spec.grid().directions(cell);
    if (d.wi[2] < lowest || d.wo[2] < lowest) continue;
    for (std::size_t c = 0; c < spec.channels.size(); ++c) {
      sum += std::pow(found.value(cell, c) / expected.value(cell, c) - 1, 2);
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

// Of cotton resampled to a table without phi_h, against the closed mean.
double error_of_mean(const Grid& from) {
  const Grid target = halfdiff3d(15, 15, 15);
  const double error = error_away_from_grazing(resample(preset_table("cotton", from), target, 2),
                                               preset_table("cotton", target));
  std::cout << "cotton from " << from.description() << " to " << target.description()
            << ": rms error " << error << '\n';
  return error;
}

}  // namespace

TEST_CASE("resampled on its own grid a table is the same") {
  const Table table = preset_table("silk", halfdiff4d(6, 4, 6, 6));
  const Table same = resample(table, halfdiff4d(6, 4, 6, 6), 1);
  CHECK(same_values(table, same));
  CHECK(same.spec() == table.spec());
}

TEST_CASE("a table that reflects evenly does so on every other grid") {
  const Grid grids[] = {halfdiff3d(8, 8, 8), halfdiff3d(7, 9, 6, 360), halfdiff4d(6, 4, 6, 6),
                        halfdiff4d(5, 3, 7, 8, 360), inout(4, 6, 5, 7)};
  for (const Grid& from : grids) {
    for (const Grid& to : grids) {
      const Table table = resample(lambertian(from, 0.5), to, 1);
      INFO(from.description() << " to " << to.description());
      CHECK(table.spec().grid() == to);
      std::size_t valid = 0;
      double worst = 0;
      for (std::size_t cell = 0; cell < to.cell_count(); ++cell) {
        if (!table.valid(cell)) continue;
        ++valid;
        worst = std::max(worst, std::abs(table.value(cell, 0) * 2 * std::acos(-1.0) - 1));
      }
      CHECK(worst < 1e-12);  // of sums of shares
      CHECK(valid > to.cell_count() / 4);
    }
  }
}

TEST_CASE("resampling keeps channels, material and precision, and values are those of nodes") {
  TableSpec spec = preset_table("silk", inout(3, 4, 3, 4), true).spec();
  spec.cells = {.average = true, .tolerance = 0.01};
  const std::vector<double> values(spec.cell_count() * spec.channels.size(), 0.25);
  const Table table(spec, values, std::vector<std::uint8_t>(spec.cell_count(), 1),
                    {0x1p-11, 0x1p-24});
  const Table other = resample(table, halfdiff3d(4, 4, 4), 1);
  CHECK(other.spec().channels == spec.channels);
  CHECK(other.spec().provenance == spec.provenance);
  CHECK(other.precision() == table.precision());
  CHECK(!other.spec().cells.average);
}

TEST_CASE("resampling is of second order: twice the nodes leave a quarter of the error") {
  for (const auto& [coarse_grid, fine_grid] :
       {std::pair(halfdiff4d(18, 12, 18, 18), halfdiff4d(36, 12, 36, 36)),
        std::pair(inout(9, 8, 9, 24), inout(18, 8, 18, 48))}) {
    const double coarse = error_of_mean(coarse_grid);
    const double fine = error_of_mean(fine_grid);
    CHECK(fine < 2e-3);  // cotton's lobes are many cells wide
    CHECK(coarse / fine > 3);
    CHECK(coarse / fine < 5.5);
  }
}

TEST_CASE("from the nodes of a target a mean over phi_h is the closed one") {
  // All axes but phi_h are those of the target: nothing is interpolated, and the rule of midpoints
  // of a periodic function converges faster than any power. Denim shows more warp than weft;
  // turned, it is no mirror image of itself either.
  Material denim = read_material(preset("denim"));
  denim.rotation_deg = 20;
  const auto tabulated = [&](const Grid& grid) {
    return collect(*make_producer(material_spec(denim, {}, grid), 1), 1);
  };
  const Table mean = resample(tabulated(halfdiff4d(12, 24, 12, 12)), halfdiff3d(12, 12, 12), 1);
  const Table expected = tabulated(halfdiff3d(12, 12, 12));
  double worst = 0;
  for (std::size_t at = 0; at < mean.values().size(); ++at) {
    const double of = expected.values()[at];
    if (of != 0) worst = std::max(worst, std::abs(mean.values()[at] / of - 1));
  }
  std::cout << "mean over 24 phi_h against the closed one: off by " << worst << '\n';
  CHECK(worst < 1e-6);
}

TEST_CASE("folded to 180 degrees a table is the mean of both orders of the directions") {
  const Table around = preset_table("silk_paper", halfdiff4d(6, 4, 6, 12, 360));
  const Table folded = resample(around, halfdiff4d(6, 4, 6, 6), 1);
  const Table expected = preset_table("silk_paper", halfdiff4d(6, 4, 6, 6));
  double worst = 0;
  for (std::size_t cell = 0; cell < folded.spec().cell_count(); ++cell) {
    if (!folded.valid(cell)) continue;
    const std::size_t first = cell / 6 * 12 + cell % 6;
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = (around.value(first, c) + around.value(first + 6, c)) / 2;
      worst = std::max(worst, std::abs(folded.value(cell, c) / mean - 1));
      CHECK_THAT(folded.value(cell, c), WithinRel(expected.value(cell, c), 1e-9));
    }
  }
  // The nodes come back from their directions to some epsilons, steep lobes magnify that.
  CHECK(worst < 1e-9);
  // Both orders matter here.
  CHECK(std::abs(around.value(1, 0) / around.value(7, 0) - 1) > 1e-3);
}

TEST_CASE("what a target averages is told") {
  const Grid grids[] = {halfdiff3d(), halfdiff4d(), halfdiff4d(4, 4, 4, 4, 360), inout()};
  const bool rotations[4][4] = {{false, false, false, false},
                                {true, false, false, false},
                                {true, false, false, false},
                                {true, false, false, false}};
  const bool orders[4][4] = {{false, false, false, false},
                             {false, false, false, false},
                             {true, true, false, false},
                             {true, true, false, false}};
  for (std::size_t from = 0; from < 4; ++from) {
    for (std::size_t to = 0; to < 4; ++to) {
      const TableSpec source{grids[from], {}, {}, {}};
      const TableSpec target{grids[to], {}, {}, {}};
      CHECK(averages_rotations(source, target) == rotations[from][to]);
      CHECK(averages_orders(source, target) == orders[from][to]);
    }
  }
}

TEST_CASE("where nothing was measured around, cells hold the mark above the horizon, 0 below") {
  const Table whole = lambertian(halfdiff3d(12, 12, 12), 0.5);
  const Grid& grid = whole.spec().grid();
  std::vector<double> values(whole.values().begin(), whole.values().end());
  std::vector<std::uint8_t> valid = cells_with_values(whole.spec());
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    if (grid.indices(cell)[1] < 6) values[cell] = kNotMeasured;  // theta_d below 45 degrees
  }
  mask_not_measured(whole.spec(), values, valid);
  const Grid target = halfdiff4d(9, 4, 24, 8);
  const Table table = resample({whole.spec(), values, valid}, target, 1);
  std::size_t marked = 0;
  for (std::size_t cell = 0; cell < target.cell_count(); ++cell) {
    const double theta_d = target.axes[2].node_deg(target.indices(cell)[2]);
    const bool above = target.node_above_horizon(cell);
    INFO(target.place(cell));
    // The last node without a measurement is at 41.25 degrees, the first with one at 48.75.
    if (!above) CHECK(table.value(cell, 0) == 0);
    if (!above || theta_d < 41.25) CHECK(!table.valid(cell));
    if (above && theta_d < 41.25) CHECK(table.value(cell, 0) == kNotMeasured);
    if (above && !table.valid(cell)) CHECK(table.value(cell, 0) == kNotMeasured);
    marked += above && !table.valid(cell);
    if (table.valid(cell))
      CHECK_THAT(table.value(cell, 0), WithinRel(0.5 / std::acos(-1.0), 1e-12));
  }
  CHECK(marked > 100);
}

TEST_CASE("a node at a cell without a measurement takes nothing from its neighbours") {
  // Twice the azimuths, every other node the same: roundings of angles are no shares of cells.
  const Table whole = lambertian(inout(4, 6, 4, 6), 0.5);
  const Grid& grid = whole.spec().grid();
  std::vector<double> values(whole.values().begin(), whole.values().end());
  std::vector<std::uint8_t> valid = cells_with_values(whole.spec());
  for (std::size_t cell = 0; cell < values.size(); cell += 5) values[cell] = kNotMeasured;
  mask_not_measured(whole.spec(), values, valid);
  const Grid target = inout(4, 12, 4, 12);
  const Table table = resample({whole.spec(), values, valid}, target, 1);
  int masked = 0;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    const std::array<int, 4> k = grid.indices(cell);
    if (k[0] == 0 || k[2] == 0) continue;  // a pole has no azimuth
    const auto same = static_cast<std::size_t>(((k[0] * 12 + 2 * k[1]) * 4 + k[2]) * 12 + 2 * k[3]);
    CHECK(table.valid(same) == (valid[cell] != 0));
    masked += valid[cell] == 0;
  }
  CHECK(masked > 50);
}

TEST_CASE("any number of threads resamples to the same bits") {
  const Table table = preset_table("silk", inout(5, 6, 5, 6));
  for (const Grid& to : {halfdiff3d(8, 8, 8), halfdiff4d(5, 4, 5, 6)}) {
    const Table one = resample(table, to, 1);
    for (const int threads : {2, 5}) CHECK(same_values(one, resample(table, to, threads)));
  }
}

TEST_CASE("resampling counts the cells of each pass, all of them") {
  const Table table = lambertian(halfdiff4d(5, 4, 5, 6), 0.5);
  Progress progress;
  resample(table, halfdiff3d(6, 6, 6), {2, &progress});
  CHECK(progress.snapshot().what == "resampling");
  CHECK(progress.snapshot().done == 216);
  CHECK(progress.snapshot().total == 216);
  // The mean over rotations is all there is to do.
  resample(table, halfdiff3d(5, 5, 6), {2, &progress});
  CHECK(progress.snapshot().done == 150);
  CHECK(progress.snapshot().total == 150);
}

}  // namespace clothbrdf::test
