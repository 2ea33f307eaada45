#include "table/reached_cells.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <vector>

#include "table/stencil.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"
#include "tests/support/random_scene.h"

namespace clothbrdf::test {
namespace {

std::vector<Grid> grids() {
  Grid chosen = halfdiff4d(8, 6, 7, 5);
  chosen.axes[0] = {
      "theta_h", Spacing::kListed, 8, 0, 90, false, false, {0, 2, 5, 10, 20, 35, 60, 85}};
  chosen.axes[1] = {"phi_h", Spacing::kListed, 6, 30, 120, false, true, {32, 40, 60, 80, 100, 115}};
  chosen.axes[3] = {"phi_d", Spacing::kListed, 5, 0, 90, false, true, {5, 20, 45, 70, 85}};
  return {halfdiff3d(20, 20, 30),
          halfdiff3d(11, 9, 14, 360),
          halfdiff4d(12, 9, 12, 8),
          halfdiff4d(7, 5, 6, 8, 360),
          inout(),
          inout(5, 9, 7, 4),
          inout(6, 1, 6, 24),
          chosen};
}

std::vector<std::uint8_t> marks(const Grid& grid, const Reach& reach) {
  std::vector<std::uint8_t> cells(grid.cell_count(), 1);
  ReachedCells(grid, reach).restrict(cells);
  return cells;
}

// A pair of the scene in the cloth's own frame.
Directions drawn(RandomInputs& draw, const Scene& scene) {
  const ScenePair p = random_pair(draw, scene);
  return {direction(p.pair.theta_i, p.pair.phi_i - p.rotation_deg),
          direction(p.pair.theta_o, p.pair.phi_o - p.rotation_deg)};
}

// A cell and those next to it on every axis, which may be around a periodic one.
std::vector<std::size_t> with_neighbours(const Grid& grid, std::size_t cell) {
  const std::array<int, 4> index = grid.indices(cell);
  std::vector<std::size_t> cells = {0};
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    const int size = grid.axes[a].size;
    std::set<int> near;
    for (int k = index[a] - 1; k <= index[a] + 1; ++k) {
      near.insert(grid.axes[a].periodic ? (k + size) % size : std::clamp(k, 0, size - 1));
    }
    std::vector<std::size_t> longer;
    for (const std::size_t begun : cells) {
      for (const int k : near) {
        longer.push_back(begun * static_cast<std::size_t>(size) + static_cast<std::size_t>(k));
      }
    }
    cells = std::move(longer);
  }
  return cells;
}

}  // namespace

TEST_CASE("all cells that a scene's pairs are read from are reached, and those next to them") {
  RandomInputs draw(seed_from_environment());
  int pairs = 0;
  for (int n = 0; n < 60; ++n) {
    const Scene scene = random_scene(draw);
    for (const Grid& grid : grids()) {
      const std::vector<std::uint8_t> reached = marks(grid, scene.reach());
      int missed = 0;
      for (int k = 0; k < 300; ++k) {
        const Directions d = drawn(draw, scene);
        if (!d.above_horizon()) continue;
        ++pairs;
        const Stencil stencil = linear_stencil(grid, d);
        for (std::size_t s = 0; s < stencil.count; ++s) {
          if (stencil.weights[s] > 1e-9) missed += reached[stencil.cells[s]] == 0;
        }
        if (grid.kind == GridKind::kInOut && grid.axes[1].size == 1) continue;
        const std::optional<std::size_t> cell = grid.cell_of(d.wi, d.wo);
        if (!cell) continue;
        for (const std::size_t near : with_neighbours(grid, *cell)) missed += reached[near] == 0;
      }
      INFO("scene " << n << ", " << grid.description());
      REQUIRE(missed == 0);
    }
  }
  std::cout << "reached cells: none of " << pairs << " pairs missed a cell\n";
}

TEST_CASE("few cells are reached beyond those that pairs of a scene lie in or next to") {
  RandomInputs draw(seed_from_environment());
  std::vector<double> ratios;
  for (int n = 0; n < 12; ++n) {
    const Scene scene = random_scene(draw);
    for (const Grid& grid : {halfdiff3d(20, 20, 30), halfdiff4d(12, 9, 12, 8), inout()}) {
      std::vector<std::uint8_t> seen(grid.cell_count());
      for (int k = 0; k < 60000; ++k) {
        const Directions d = drawn(draw, scene);
        const std::optional<std::size_t> cell = grid.cell_of(d.wi, d.wo);
        if (!cell || seen[*cell] == 2) continue;
        for (const std::size_t near : with_neighbours(grid, *cell)) {
          seen[near] = std::max<std::uint8_t>(seen[near], 1);
        }
        seen[*cell] = 2;
      }
      const auto found = static_cast<double>(grid.cell_count()) -
                         static_cast<double>(std::count(seen.begin(), seen.end(), 0));
      ratios.push_back(static_cast<double>(ReachedCells(grid, scene.reach()).count()) / found);
    }
  }
  std::sort(ratios.begin(), ratios.end());
  std::cout << "reached cells / cells seen or beside: median " << ratios[ratios.size() / 2]
            << ", largest " << ratios.back() << '\n';
  CHECK(ratios.front() >= 1);
  CHECK(ratios[ratios.size() / 2] < 1.5);
  CHECK(ratios.back() < 8);
}

TEST_CASE("a scene of all directions reaches all cells above the horizon") {
  const DirectionRange all = {{0, 90}, {0, 360}};
  for (const Grid& grid : grids()) {
    const std::vector<std::uint8_t> above = grid.above_horizon(CellPart::kAny);
    const std::vector<std::uint8_t> reached = marks(grid, {{all}, {all}, {0}});
    std::size_t missed = 0;
    for (std::size_t cell = 0; cell < above.size(); ++cell) missed += above[cell] > reached[cell];
    INFO(grid.description());
    CHECK(missed == 0);
  }
}

TEST_CASE("one direction of light and one of the eye reach a cell and its neighbours") {
  // Nodes of in/out grids: theta 30 is cell 2 of 6, phi 90 cell 12 of 48.
  const Reach reach = {{{{30, 30}, {90, 90}}}, {{{45, 45}, {0, 0}}}, {0}};
  const ReachedCells cells(inout(), reach);
  CHECK(cells.count() == 81);
  const auto rows = [&](int theta, int phi) {
    return cells.row(static_cast<std::size_t>(theta * 48 + phi));
  };
  CHECK(rows(2, 12).size() > 0);
  CHECK(rows(3, 13).size() > 0);
  CHECK(rows(4, 12).empty());
  CHECK(rows(2, 14).empty());
  // The eye's azimuths 352.5, 0 and 7.5 at three thetas: the last, first and second columns.
  CHECK(cells.columns().begin == 2 * 48);
  CHECK(cells.columns().end == 5 * 48);

  // Light at the pole has no azimuth: where one stands for any, the eye is counted from none.
  const Grid any = inout(6, 1, 6, 24);
  const Reach above = {{{{0, 0}, {50, 50}}}, {{{45, 45}, {90, 90}}}, {0}};
  const Directions seen = {direction(0.0, 50.0), direction(45.0, 90.0)};
  CHECK(marks(any, above)[linear_stencil(any, seen).cells[0]] == 1);

  // The cloth turned by 90 degrees sees both a quarter turn back.
  const ReachedCells turned(inout(), {reach.lights, reach.eyes, {90}});
  CHECK(turned.row(2 * 48).size() == 3);
  CHECK(turned.row(2 * 48 + 12).empty());
}

}  // namespace clothbrdf::test
