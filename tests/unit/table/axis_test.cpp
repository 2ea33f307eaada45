#include "table/axis.h"

#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

const Axis kAxes[] = {
    {"theta_h", Spacing::kSquared, 90, 0, 90, false},
    {"theta_d", Spacing::kUniform, 45, 0, 90, false},
    {"phi_h", Spacing::kUniform, 36, 0, 180, true},
    {"phi_d", Spacing::kUniform, 180, 0, 360, true},
    {"theta_i", Spacing::kNodes, 6, 0, 90, false},
    {"phi_o", Spacing::kNodes, 48, 0, 360, true},
};

}  // namespace

TEST_CASE("a node lies in its own cell, between the cell's edges") {
  for (const Axis& axis : kAxes) {
    for (int k = 0; k < axis.size; ++k) {
      INFO(axis.name << " cell " << k);
      CHECK(axis.cell_of(axis.node_deg(k)) == k);
      CHECK(axis.edge_deg(k) <= axis.node_deg(k));
      CHECK(axis.node_deg(k) < axis.edge_deg(k + 1));
    }
  }
}

TEST_CASE("cells cover an axis from end to end, nodes up to half a step beyond the last one") {
  for (const Axis& axis : kAxes) {
    INFO(axis.name);
    if (axis.spacing == Spacing::kNodes) continue;
    CHECK(axis.edge_deg(0) == axis.lowest_deg);
    CHECK(axis.edge_deg(axis.size) == axis.highest_deg);
  }
  CHECK(kAxes[4].edge_deg(0) == 0);  // no elevation is negative
  CHECK(kAxes[4].edge_deg(1) == 7.5);
  CHECK(kAxes[4].edge_deg(6) == 82.5);
  CHECK(kAxes[4].cell_of(83) == std::nullopt);
  CHECK(kAxes[5].edge_deg(0) == -3.75);
}

TEST_CASE("nodes are those of MERL and of UTIA") {
  CHECK(kAxes[0].node_deg(0) == 0.25 / 90);
  CHECK(kAxes[0].node_deg(89) == 89.5 * 89.5 / 90);
  CHECK(kAxes[1].node_deg(0) == 1);
  CHECK(kAxes[4].node_deg(5) == 75);
  CHECK(kAxes[5].node_deg(47) == 352.5);
}

TEST_CASE("a periodic axis takes any angle, another one only its own range") {
  CHECK(kAxes[2].cell_of(181) == kAxes[2].cell_of(1));
  CHECK(kAxes[2].cell_of(-1) == 35);
  CHECK(kAxes[5].cell_of(359) == 0);
  CHECK(kAxes[1].cell_of(90) == 44);
  CHECK(kAxes[1].cell_of(90.001) == std::nullopt);
  CHECK(kAxes[1].cell_of(-0.001) == std::nullopt);
}

TEST_CASE("a coordinate is the index at the nodes, and half of one between uniform ones") {
  for (const Axis& axis : kAxes) {
    for (int k = 0; k < axis.size; ++k) {
      INFO(axis.name << " cell " << k);
      // A few roundings of an index of at most 180.
      CHECK_THAT(axis.coordinate(axis.node_deg(k)), Catch::Matchers::WithinAbs(k, 1e-12));
      if (axis.spacing == Spacing::kSquared || k + 1 == axis.size) continue;
      const double between = (axis.node_deg(k) + axis.node_deg(k + 1)) / 2;
      CHECK_THAT(axis.coordinate(between), Catch::Matchers::WithinAbs(k + 0.5, 1e-12));
    }
  }
  // Between squared nodes it is the square root that runs evenly; it goes on beyond the ends.
  CHECK_THAT(kAxes[0].coordinate(1.0 / 90), Catch::Matchers::WithinAbs(0.5, 1e-12));
  CHECK(kAxes[0].coordinate(0) == -0.5);
  CHECK(kAxes[1].coordinate(90) == 44.5);
  CHECK(kAxes[2].coordinate(185) == 36.5);
  CHECK(kAxes[4].coordinate(90) == 6);
}

}  // namespace clothbrdf::test
