#include "preview/slices.h"

#include <algorithm>
#include <cmath>

#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

const std::vector<Grid>& sliced_grids() {
  static const std::vector<Grid> kGrids = {
      halfdiff3d(),     halfdiff3d(9, 7, 10, 360), halfdiff3d(1, 1, 1),
      halfdiff4d(),     halfdiff4d(8, 6, 7, 9),    halfdiff4d(1, 1, 1, 1),
      inout(),          inout(18, 72, 9, 36),      inout(6, 1, 6, 48),
      inout(1, 1, 1, 1)};
  return kGrids;
}

}  // namespace

TEST_CASE("slices are runs of different cells inside the grid and on their axes") {
  for (const Grid& grid : sliced_grids()) {
    CAPTURE(grid.description());
    const std::vector<Slice> slices = typical_slices(grid);
    REQUIRE(slices.size() == 5);
    for (const Slice& slice : slices) {
      CAPTURE(slice.title.above, slice.title.below);
      REQUIRE(slice.cells.size() == slice.x.size());
      REQUIRE_FALSE(slice.cells.empty());
      CHECK(std::is_sorted(slice.x.begin(), slice.x.end()));
      for (std::size_t k = 0; k < slice.cells.size(); ++k) {
        CHECK(slice.cells[k] < grid.cell_count());
        CHECK(slice.x[k] >= slice.axis.lowest);
        CHECK(slice.x[k] <= slice.axis.highest);
      }
      std::vector<std::size_t> sorted = slice.cells;
      std::sort(sorted.begin(), sorted.end());
      CHECK(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
    }
  }
}

TEST_CASE("a slice's title says where its cells stand") {
  const Grid grid = halfdiff4d();
  const Slice slice = typical_slices(grid)[1];
  CHECK(slice.title.above == "f_r along theta_h");
  CHECK(slice.title.below == "phi_h 87.5, theta_d 5, phi_d 90");
  REQUIRE(slice.cells.size() == 45);
  for (std::size_t k = 0; k < slice.cells.size(); ++k) {
    const std::array<int, 4> place = grid.indices(slice.cells[k]);
    CHECK(place[0] == static_cast<int>(k));
    CHECK(grid.axes[1].node_deg(place[1]) == 87.5);
    CHECK(grid.axes[2].node_deg(place[2]) == 5);
    CHECK(grid.axes[3].node_deg(place[3]) == 90);
  }
}

TEST_CASE("the plane of incidence holds the eye on the light's side and on the other") {
  const Grid grid = inout(6, 8, 6, 8);
  for (const std::size_t which : {0U, 1U, 2U}) {
    const Slice slice = typical_slices(grid)[which];
    REQUIRE(slice.cells.size() == 11);
    for (std::size_t k = 0; k < slice.cells.size(); ++k) {
      const Directions d = grid.directions(slice.cells[k]);
      const double theta_o = slice.x[k] * std::acos(-1.0) / 180;
      const double sine = std::hypot(d.wi[0], d.wi[1]);
      const double along = (d.wo[0] * d.wi[0] + d.wo[1] * d.wi[1]) / sine;
      CHECK_THAT(along, Catch::Matchers::WithinAbs(-std::sin(theta_o), 1e-12));
      CHECK_THAT(d.wo[2], Catch::Matchers::WithinAbs(std::cos(theta_o), 1e-12));
      CHECK_THAT(sine, Catch::Matchers::WithinAbs(which == 1 ? std::sqrt(0.75) : 0.5, 1e-12));
      CHECK_THAT(d.wi[which == 2 ? 0 : 1], Catch::Matchers::WithinAbs(0, 1e-12));
    }
  }
}

TEST_CASE("the numbers of an angle's axis stand at the nodes of their angles") {
  for (const Grid& grid : sliced_grids()) {
    for (const Axis& axis : grid.axes) {
      const PlotAxis plot = angle_axis(axis);
      CAPTURE(grid.description(), axis.name);
      CHECK(plot.share(-0.5) == 0);
      CHECK(plot.share(axis.size - 0.5) == 1);
      for (const Tick& tick : plot.ticks) {
        CHECK_THAT(axis.coordinate(std::stod(tick.text)),
                   Catch::Matchers::WithinAbs(tick.at, 1e-9));
      }
      CHECK(plot.ticks.size() >= 7);
    }
  }
}

}  // namespace clothbrdf::test
