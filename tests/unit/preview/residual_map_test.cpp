#include "preview/residual_map.h"

#include <cmath>
#include <limits>

#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

const Rgb& middle(const Image& image) {
  return image.at(kResidualFrame.x + kResidualFrame.width / 2,
                  kResidualFrame.y + kResidualFrame.height / 2);
}

}  // namespace

TEST_CASE("means are those of all values at the same pair of thetas") {
  const Grid grids[] = {halfdiff3d(3, 4, 5), halfdiff4d(3, 2, 4, 5), inout(3, 2, 4, 5)};
  for (const Grid& grid : grids) {
    CAPTURE(grid.description());
    ResidualMap map(grid);
    const std::size_t second = grid.axes.size() - 2;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      const std::array<int, 4> place = grid.indices(cell);
      const double share = 0.01 * place[0] - 0.03 * place[second];
      // Two channels, whose mean it is.
      map.add(cell, 2 * (1 + share + 0.5), 2);
      map.add(cell, 0.1 * (1 + share - 0.5), 0.1);
    }
    const std::vector<std::optional<double>> means = map.means();
    REQUIRE(means.size() == 12);
    for (int k = 0; k < 12; ++k) {
      const std::optional<double>& mean = means[static_cast<std::size_t>(k)];
      const int row = k / 4;
      REQUIRE(mean);
      CHECK_THAT(*mean, Catch::Matchers::WithinAbs(0.01 * row - 0.03 * (k % 4), 1e-12));
    }
    CHECK(map.scale() == 0.1);
  }
}

TEST_CASE("the first theta runs to the right and the second upward") {
  const Grid grid = halfdiff3d(2, 2, 1);
  for (std::size_t cell = 0; cell < 4; ++cell) {
    ResidualMap map(grid);
    for (std::size_t other = 0; other < 4; ++other) map.add(other, other == cell ? 2 : 1, 1);
    const Image image = map.draw();
    for (std::size_t seen = 0; seen < 4; ++seen) {
      const int x = kResidualFrame.x + kResidualFrame.width * (seen / 2 == 0 ? 1 : 3) / 4;
      const int y = kResidualFrame.y + kResidualFrame.height * (seen % 2 == 0 ? 3 : 1) / 4;
      CAPTURE(cell, seen);
      CHECK((image.at(x, y) == kPlotPaper) == (seen != cell));
    }
  }
}

TEST_CASE("a higher table is red, a lower one blue, an equal one white, none grey") {
  const Grid grid = halfdiff3d(1, 1, 1);
  const auto colour = [&](double table) {
    ResidualMap map(grid);
    map.add(0, table, 1);
    return middle(map.draw());
  };
  CHECK(colour(1) == kPlotPaper);
  CHECK(colour(1 + 1e-9)[1] > 0.999);
  const Rgb red = colour(1.5);
  CHECK(red[0] > 2 * red[1]);
  CHECK(red[0] > 2 * red[2]);
  const Rgb blue = colour(0.5);
  CHECK(blue[2] > 2 * blue[0]);
  CHECK(blue[2] > 2 * blue[1]);
  CHECK(middle(ResidualMap(grid).draw()) == kPlotFaint);
}

TEST_CASE("what is no measurement, or stands against no fit, is not counted") {
  const double infinity = std::numeric_limits<double>::infinity();
  const double none = std::numeric_limits<double>::quiet_NaN();
  ResidualMap map(halfdiff3d(1, 1, 1));
  for (const double bad : {none, infinity, -infinity, -1.0}) {
    map.add(0, bad, 1);
    map.add(0, 1, bad);
  }
  map.add(0, 1, 0);
  CHECK_FALSE(map.means()[0]);
  CHECK(map.scale() == 0.001);
  map.add(0, 0, 1);
  CHECK(map.means()[0] == -1);
}

TEST_CASE("the scale follows most means, between a thousandth and one") {
  const Grid grid = halfdiff3d(10, 10, 1);
  const auto scale = [&](double share, double one) {
    ResidualMap map(grid);
    for (std::size_t cell = 0; cell < 100; ++cell) map.add(cell, 1 + (cell == 50 ? one : share), 1);
    return map.scale();
  };
  CHECK(scale(1e-12, 1e-12) == 0.001);
  CHECK(scale(0.003, 0.003) == 0.005);
  CHECK(scale(-0.03, 1e30) == 0.05);
  CHECK(scale(0.4, -1) == 0.5);
  CHECK(scale(1e50, 1) == 1);
}

}  // namespace clothbrdf::test
