#include <cmath>
#include <random>

#include "formats/table_metadata.h"
#include "support/errors.h"
#include "table/stencil.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

const Axis kTheta = {"theta_d", Spacing::kListed, 4, 0, 90, false, false, {0, 10, 40, 89}};
const Axis kPhi = {"phi_d", Spacing::kListed, 3, 0, 90, false, true, {0, 30, 90}};
const Axis kTurned = {"phi_h", Spacing::kListed, 3, 20, 110, false, true, {20, 65, 110}};

Grid chosen_grid() {
  Axis theta_h = kTheta;
  theta_h.name = "theta_h";
  return {GridKind::kHalfDifference4d, {theta_h, kTurned, kTheta, kPhi}};
}

}  // namespace

TEST_CASE("listed nodes lie in their own cells, which meet halfway and cover the axis") {
  for (const Axis& axis : {kTheta, kPhi, kTurned}) {
    INFO(axis.name);
    CHECK(axis.edge_deg(0) == axis.lowest_deg);
    CHECK(axis.edge_deg(axis.size) == axis.highest_deg);
    for (int k = 0; k < axis.size; ++k) {
      CHECK(axis.node_deg(k) == axis.listed_deg[static_cast<std::size_t>(k)]);
      CHECK(axis.cell_of(axis.node_deg(k)) == k);
      CHECK(axis.coordinate(axis.node_deg(k)) == k);
    }
  }
  CHECK(kTheta.edge_deg(2) == 25);
  CHECK(kTheta.cell_of(24.9) == 1);
  CHECK(kTheta.cell_of(25.1) == 2);
  CHECK(kTheta.cell_of(90) == 3);
  CHECK(kTheta.cell_of(91) == std::nullopt);
  CHECK(kTheta.coordinate(25) == 1.5);
}

TEST_CASE("a mirrored axis takes any angle, folded at both ends") {
  CHECK(kPhi.period_deg() == 180);
  CHECK(kPhi.folded_deg(100) == 80);
  CHECK(kPhi.folded_deg(-100) == 80);
  CHECK(kPhi.folded_deg(350) == 10);
  CHECK(kPhi.coordinate(165) == 0.5);
  CHECK(kPhi.cell_of(-80) == 2);
  CHECK(kTurned.folded_deg(0) == 40);
  CHECK(kTurned.folded_deg(200) == 20);
  CHECK(kTurned.coordinate(0) == kTurned.coordinate(40));
  CHECK(chosen_grid().folds_orders());
  CHECK_FALSE(chosen_grid().regular());
  CHECK(chosen_grid().description() == "halfdiff4d:4x3x4x3 at chosen nodes");
}

TEST_CASE("the weights of a linear stencil add up to 1, over cells of the grid") {
  const std::vector<Grid> grids = {chosen_grid(), halfdiff4d(3, 4, 5, 6), halfdiff3d(4, 5, 6, 360),
                                   inout(3, 4, 5, 6), inout(3, 1, 5, 6)};
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> share(0, 1);
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    const Directions pair = {direction(90 * share(engine), 360 * share(engine)),
                             direction(90 * share(engine), 360 * share(engine))};
    for (const Grid& grid : grids) {
      const Stencil stencil = linear_stencil(grid, pair);
      double sum = 0;
      for (std::size_t s = 0; s < stencil.count; ++s) {
        CHECK(stencil.cells[s] < grid.cell_count());
        CHECK(stencil.weights[s] >= 0);
        sum += stencil.weights[s];
      }
      worst = std::max(worst, std::abs(sum - 1));
    }
  }
  INFO("seed 11, worst " << worst);
  CHECK(worst < 1e-14);
}

TEST_CASE("a table at chosen nodes says f_r at its nodes, whichever way light and eye are turned") {
  Material silk = read_material(preset("silk"));
  silk.rotation_deg = 20;
  const TableSpec spec = material_spec(silk, {}, chosen_grid());
  const Table table = collect(*make_producer(spec, 1), 1);
  const auto model = make_producer(material_spec(silk, {}, AnyPairs{}), 1);
  double worst = 0;
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    const Directions d = spec.directions(cell);
    if (!d.above_horizon()) continue;
    // The same by symmetry: both orders, half a turn, and mirrored at the weft.
    const auto mirrored = [](const Vector3<double>& v) {
      const Vector3<double> weave = turned(v, sincosd(-20.0));
      return turned(Vector3<double>{weave[0], -weave[1], weave[2]}, sincosd(20.0));
    };
    for (const Directions& same :
         {d, Directions{d.wo, d.wi}, Directions{turned(d.wi, {0, -1}), turned(d.wo, {0, -1})},
          Directions{mirrored(d.wi), mirrored(d.wo)}}) {
      std::vector<double> exact(3);
      model->fill_pairs({&same, 1}, exact);
      std::vector<double> read(3);
      REQUIRE(table.interpolate(same, read));
      for (std::size_t c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(read[c] / exact[c] - 1));
      }
    }
  }
  INFO("worst relative difference " << worst);
  CHECK(worst < 1e-7);  // acos of angles near 0 gives back half the digits
}

TEST_CASE("the description of chosen nodes and of a measured error comes back as it was") {
  TableSpec spec = material_spec(read_material(preset("silk")), {}, chosen_grid());
  spec.provenance.error = {{0.0029, 0.012, 0.5}, "linear", 160123, true};
  CHECK(parse_table_metadata(table_metadata(spec), "t.exr") == spec);
}

TEST_CASE("axes of listed nodes that make no sense are refused") {
  const auto refused = [](const std::function<void(Axis&)>& damage, std::size_t axis) {
    Grid grid = chosen_grid();
    damage(grid.axes[axis]);
    const TableSpec spec = material_spec(read_material(preset("silk")), {}, grid);
    CHECK_THROWS_AS(parse_table_metadata(table_metadata(spec), "t.exr"), InputError);
  };
  refused([](Axis& a) { a.listed_deg[1] = a.listed_deg[2]; }, 0);  // not ascending
  refused([](Axis& a) { a.listed_deg.back() = 90.5; }, 2);         // beyond the end
  refused([](Axis& a) { a.listed_deg.pop_back(); }, 2);            // fewer than cells
  refused([](Axis& a) { a.mirrored = true; }, 2);                  // theta
  refused([](Axis& a) { a.periodic = true; }, 3);
  refused([](Axis& a) { a.mirrored = false; }, 3);
  refused([](Axis& a) { a.highest_deg = 100; }, 3);
}

}  // namespace clothbrdf::test
