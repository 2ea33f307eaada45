#include "table/grid.h"

#include <cmath>
#include <optional>
#include <vector>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

const Grid kGrids[] = {halfdiff3d(), halfdiff3d(11, 9, 14, 360),
                       halfdiff4d(), halfdiff4d(7, 5, 6, 8, 360),
                       inout(),      inout(5, 9, 7, 4)};

double degrees(double radians) { return radians * 180 / std::acos(-1.0); }

}  // namespace

TEST_CASE("the directions of a cell's node lie in that cell") {
  RandomInputs random(seed_from_environment());
  for (const Grid& grid : kGrids) {
    int above = 0;
    for (int n = 0; n < 2000; ++n) {
      const auto cell =
          static_cast<std::size_t>(random.unit() * static_cast<double>(grid.cell_count()));
      const Directions d = grid.directions(cell);
      INFO(grid.description() << " cell " << cell);
      // At theta = 0 the azimuth is lost.
      if (grid.kind == GridKind::kInOut &&
          (grid.indices(cell)[0] == 0 || grid.indices(cell)[2] == 0))
        continue;
      CHECK(grid.cell_of(d.wi, d.wo) == cell);
      CHECK(d.above_horizon() == grid.node_above_horizon(cell));
      if (d.above_horizon()) ++above;
      if (d.above_horizon()) CHECK(grid.any_above_horizon(cell));
    }
    CHECK(above > 500);
  }
}

TEST_CASE("the cell of a pair is the one that MERL's own lookup takes") {
  // The lookup that came with the data: half and difference angles by rotating the light, floor of
  // the index.
  RandomInputs random(seed_from_environment());
  const Grid grid = halfdiff3d();
  for (int n = 0; n < 5000; ++n) {
    const DirectionPair p = random.pair();
    const Vector3<double> in = direction(p.theta_i, p.phi_i);
    const Vector3<double> out = direction(p.theta_o, p.phi_o);
    Vector3<double> half{};
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) half[k] = (in[k] + out[k]) / 2;
    for (const double h : half) length += h * h;
    for (double& h : half) h /= std::sqrt(length);
    const double theta_h = std::acos(half[2]);
    const double phi_h = std::atan2(half[1], half[0]);
    const double x = in[0] * std::cos(phi_h) + in[1] * std::sin(phi_h);
    const double y = in[1] * std::cos(phi_h) - in[0] * std::sin(phi_h);
    const Vector3<double> diff = {x * std::cos(theta_h) - in[2] * std::sin(theta_h), y,
                                  in[2] * std::cos(theta_h) + x * std::sin(theta_h)};
    double phi_d = std::atan2(diff[1], diff[0]);
    if (phi_d < 0) phi_d += std::acos(-1.0);
    const double at_h = std::sqrt(degrees(theta_h) / 90) * 90;
    const double at_d = degrees(std::acos(diff[2]));
    const double at_p = degrees(phi_d);
    // Rounding may put a pair on either side of an edge.
    const auto near_edge = [](double at) { return std::abs(at - std::round(at)) < 1e-6; };
    if (near_edge(at_h) || near_edge(at_d) || near_edge(at_p)) continue;
    const std::size_t expected =
        (static_cast<std::size_t>(at_h) * 90 + static_cast<std::size_t>(at_d)) * 180 +
        static_cast<std::size_t>(at_p);
    CHECK(grid.cell_of(in, out) == expected);
  }
}

TEST_CASE("a grid's description reads back to the same grid") {
  for (const Grid& grid : kGrids)
    CHECK(parse_grid(grid.description(), grid.axes.back().highest_deg) == grid);
  CHECK(parse_grid("halfdiff3d") == halfdiff3d());
  CHECK(parse_grid("halfdiff4d") == halfdiff4d());
  CHECK(parse_grid("inout") == inout());
}

TEST_CASE("a grid that is not one is refused with what is allowed") {
  for (const char* text :
       {"", "merl", "halfdiff3d:", "halfdiff3d:90x90", "halfdiff3d:90x90x180x2", "halfdiff3d:0x9x9",
        "halfdiff3d:-1x9x9", "halfdiff3d:9x9x9.5", "halfdiff3d:9x9x", "inout:1x2x3",
        "halfdiff4d:1000000x1000000x1000000x1", "inout:99999999999x1x1x1", "inout:1000001x1x1x1"}) {
    INFO(text);
    CHECK_THROWS_WITH(parse_grid(text),
                      ContainsSubstring("--grid: '") && ContainsSubstring("is not allowed: "));
  }
}

TEST_CASE("halves of the sky that a grid leaves out are there by symmetry") {
  const Grid grid = halfdiff4d();
  RandomInputs random(seed_from_environment());
  for (int n = 0; n < 1000; ++n) {
    const auto cell =
        static_cast<std::size_t>(random.unit() * static_cast<double>(grid.cell_count()));
    const Directions d = grid.directions(cell);
    // The cloth turned by half a turn, and light and eye exchanged.
    CHECK(grid.cell_of({-d.wi[0], -d.wi[1], d.wi[2]}, {-d.wo[0], -d.wo[1], d.wo[2]}) == cell);
    CHECK(grid.cell_of(d.wo, d.wi) == cell);
  }
}

TEST_CASE("the cells of a grid cover all pairs of directions, by their measure") {
  const double pi = std::acos(-1.0);
  const auto sum = [](const Grid& grid) {
    double total = 0;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) total += grid.measure(cell);
    return total;
  };
  // The integral of 4 cos theta_d over half vectors and over difference directions around them.
  const auto halfdiff_total = [&](double phi_h, double phi_d) { return 2 * phi_h * phi_d; };
  // Nodes at 90 k / n: the last cell ends half a step before the horizon.
  const auto cap = [&](int nodes) { return 2 * pi * (1 - std::cos((1 - 0.5 / nodes) * pi / 2)); };
  constexpr double kRounding = 1e-12;  // of sums of thousands of terms
  const auto near = [&](double total) { return Catch::Matchers::WithinRel(total, kRounding); };
  CHECK_THAT(sum(halfdiff3d(9, 8, 7, 360)), near(halfdiff_total(2 * pi, 2 * pi)));
  CHECK_THAT(sum(halfdiff3d(9, 8, 7)), near(halfdiff_total(2 * pi, pi)));
  CHECK_THAT(sum(halfdiff4d(9, 5, 8, 7, 360)), near(halfdiff_total(pi, 2 * pi)));
  CHECK_THAT(sum(halfdiff4d(9, 5, 8, 7)), near(halfdiff_total(pi, pi)));
  CHECK_THAT(sum(inout(6, 9, 5, 4)), near(cap(6) * cap(5)));
}

TEST_CASE("a cell measures as many pairs as fall into it") {
  // Even draws of both directions over the upper hemisphere.
  const std::uint64_t seed = seed_from_environment();
  INFO("CLOTHBRDF_SEED=" << seed);
  RandomInputs random(seed);
  constexpr int kDraws = 100000;
  for (const Grid& grid : {halfdiff3d(4, 3, 2), halfdiff4d(3, 2, 3, 2), inout(2, 3, 3, 2)}) {
    std::vector<int> hits(grid.cell_count());
    for (int n = 0; n < kDraws; ++n) {
      const auto draw = [&] {
        return direction(degrees(std::acos(random.unit())), 360 * random.unit());
      };
      const Vector3<double> wi = draw();
      const Vector3<double> wo = draw();
      if (const std::optional<std::size_t> cell = grid.cell_of(wi, wo)) ++hits[*cell];
    }
    // phi_h and phi_d that end at 180 degrees stand for their other half, too.
    double folds = 1;
    for (const Axis& axis : grid.axes) folds *= axis.periodic ? 360 / axis.highest_deg : 1;
    int compared = 0;
    for (std::size_t cell = 0; cell < hits.size(); ++cell) {
      const std::array<int, 4> k = grid.indices(cell);
      // Cells wholly above the horizon: theta_h + theta_d at most 90 degrees at the upper edges.
      const std::size_t d = grid.axes.size() - 2;
      if (grid.kind != GridKind::kInOut &&
          grid.axes[0].edge_deg(k[0] + 1) + grid.axes[d].edge_deg(k[d] + 1) > 90)
        continue;
      const double share = grid.measure(cell) * folds / std::pow(2 * std::acos(-1.0), 2);
      const double expected = share * kDraws;
      INFO(grid.description() << ' ' << grid.place(cell));
      // Five standard deviations of a count.
      CHECK_THAT(hits[cell], Catch::Matchers::WithinAbs(expected, 5 * std::sqrt(expected)));
      compared += expected > 100;
    }
    CHECK(compared >= 4);
  }
}

TEST_CASE("the place of a cell names each angle of its node") {
  CHECK(halfdiff3d().place(0) == "theta_h 0.00277778 theta_d 0.5 phi_d 0.5");
  CHECK(inout().place(1) == "theta_i 0 phi_i 0 theta_o 0 phi_o 7.5");
  CHECK(halfdiff4d(2, 2, 2, 2, 360).place(15) == "theta_h 50.625 phi_h 135 theta_d 67.5 phi_d 270");
}

}  // namespace clothbrdf::test
