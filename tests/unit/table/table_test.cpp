#include "table/table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

TableSpec small_spec() {
  return {halfdiff3d(3, 4, 5), {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}}, {}, {}};
}

Table counting_table(const TableSpec& spec) {
  std::vector<double> values(spec.cell_count() * spec.channels.size());
  std::iota(values.begin(), values.end(), 0.0);
  return {spec, values, std::vector<std::uint8_t>(spec.cell_count(), 1)};
}

// A table whose reader loses patience once it is asked for a row.
class CancelsAtRow final : public Producer {
 public:
  CancelsAtRow(const Table& table, std::size_t row, Progress& progress)
      : table_(table), row_(row), progress_(progress) {}
  const TableSpec& spec() const override { return table_.spec(); }
  void fill_rows(std::size_t first_row, std::span<double> values) const override {
    if (first_row == row_) progress_.cancel();
    table_.fill_rows(first_row, values);
  }
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override {
    table_.fill_pairs(pairs, values);
  }

 private:
  const Table& table_;
  std::size_t row_;
  Progress& progress_;
};

}  // namespace

TEST_CASE("a table finds its values by cell and channel") {
  const TableSpec spec = small_spec();
  const Table table = counting_table(spec);
  // values[row][channel][column] with 20 columns: cell 27 is column 7 of row 1.
  CHECK(table.value(27, 0) == 47);
  CHECK(table.value(27, 1) == 67);
}

TEST_CASE("a table gives its own values at the nodes of its cells") {
  for (const Grid& grid : {halfdiff3d(9, 8, 7), halfdiff4d(5, 6, 7, 8), inout(4, 5, 6, 7)}) {
    const Table table = counting_table({grid, {{"R", Part::kTotal, 0}}, {}, {}});
    int checked = 0;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      const std::array<int, 4> k = grid.indices(cell);
      const bool at_pole = grid.kind == GridKind::kInOut && (k[0] == 0 || k[2] == 0);
      if (at_pole || !grid.node_above_horizon(cell)) continue;  // a pole has no azimuth
      double value = 0;
      REQUIRE(table.interpolate(grid.directions(cell), std::span(&value, 1)));
      INFO(grid.description() << " cell " << cell);
      // The angles of a node come back to a few epsilons; steps between cells are up to the number
      // of cells.
      CHECK_THAT(value, Catch::Matchers::WithinAbs(table.value(cell, 0), 1e-9));
      ++checked;
    }
    CHECK(checked > 300);
  }
}

TEST_CASE("between nodes a table is linear in each axis's own coordinate, and wraps in azimuth") {
  // The value is the axis's index; its coordinate at any angle is expected back.
  const Grid grid = halfdiff4d(20, 12, 20, 12);
  RandomInputs random(seed_from_environment());
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const TableSpec spec{grid, {{"R", Part::kTotal, 0}}, {}, {}};
    std::vector<double> values(spec.cell_count());
    for (std::size_t cell = 0; cell < values.size(); ++cell)
      values[cell] = grid.indices(cell)[axis];
    const Table table(spec, values, std::vector<std::uint8_t>(values.size(), 1));
    const double last = grid.axes[axis].size - 1.0;
    int between = 0;
    for (int n = 0; n < 2000; ++n) {
      const DirectionPair p = random.pair();
      const Directions d = {direction(p.theta_i, p.phi_i), direction(p.theta_o, p.phi_o)};
      double value = 0;
      REQUIRE(table.interpolate(d, std::span(&value, 1)));
      double at = grid.axes[axis].coordinate(grid.angles(d.wi, d.wo)[axis]);
      if (grid.axes[axis].periodic && at > last + 0.5) at -= grid.axes[axis].size;  // half a turn
      double expected = std::clamp(at, 0.0, last);
      if (grid.axes[axis].periodic && (at < 0 || at > last)) {
        const double beyond = at < 0 ? at + 1 : at - last;  // from the last node to the first
        expected = last * (1 - beyond);
      }
      CHECK_THAT(value, Catch::Matchers::WithinAbs(expected, 1e-9));
      between += std::abs(at - std::round(at)) > 0.1;
    }
    CHECK(between > 500);
  }
}

TEST_CASE("cells without a measurement take no part in what lies between") {
  const Grid grid = inout(4, 4, 4, 4);
  const TableSpec spec{grid, {{"R", Part::kTotal, 0}}, {}, {}};
  std::vector<double> values(spec.cell_count(), 2.0);
  std::vector<std::uint8_t> valid(spec.cell_count(), 1);
  const Directions between = {direction(30.0, 20.0), direction(30.0, 20.0)};
  const std::size_t near = grid.cell_of(between.wi, between.wo).value();
  values[near] = 1e9;
  valid[near] = 0;
  values[near + 1] = std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  REQUIRE(Table(spec, values, valid).interpolate(between, std::span(&value, 1)));
  CHECK(value == 2);
  std::fill(valid.begin(), valid.end(), std::uint8_t{0});
  CHECK_FALSE(Table(spec, values, valid).interpolate(between, std::span(&value, 1)));
  CHECK(value == 0);
}

TEST_CASE("below the horizon a table is 0") {
  const Table table = counting_table(small_spec());
  const std::vector<Directions> pairs = {{direction(30.0, 10.0), direction(20.0, 60.0)},
                                         {direction(120.0, 0.0), direction(20.0, 0.0)}};
  std::vector<double> values(4);
  table.fill_pairs(pairs, values);
  CHECK(values[0] > 0);
  CHECK(values[2] == 0);
  CHECK(values[3] == 0);
}

TEST_CASE("a table without its components keeps totals, mask and precision") {
  TableSpec spec = small_spec();
  spec.channels.insert(spec.channels.begin() + 1, {"R", Part::kInternal, 0});
  std::vector<double> values(spec.cell_count() * 3);
  std::iota(values.begin(), values.end(), 0.0);
  std::vector<std::uint8_t> valid(spec.cell_count(), 1);
  valid[7] = 0;
  const Table whole(spec, values, valid, {0x1p-11, 0x1p-24});
  const Table totals = without_components(whole);
  CHECK(totals.spec().channels == small_spec().channels);
  for (const std::size_t cell : {0U, 7U, 33U}) {
    CHECK(totals.value(cell, 0) == whole.value(cell, 0));
    CHECK(totals.value(cell, 1) == whole.value(cell, 2));
    CHECK(totals.valid(cell) == whole.valid(cell));
  }
  CHECK(totals.precision() == whole.precision());
}

TEST_CASE("a list of pairs is a table too") {
  const TableSpec spec{
      PairList{{{30, 10, 20, 60}, {10, 0, 20, 0}}}, {{"R", Part::kTotal, 0}}, {}, {}};
  const Table table(spec, {0.5, 0.25}, {1, 1});
  CHECK(spec.row_count() == 2);
  CHECK(spec.row_values() == 1);
  CHECK_FALSE(spec.isotropic());
  CHECK(spec.description() == "2 pairs");
  CHECK(spec.place(0) == "theta_i 30 phi_i 10 theta_o 20 phi_o 60");
  // Of the second sample, near it, and of none.
  const std::vector<Directions> asked = {{direction(10.0, 0.0), direction(20.0, 0.0)},
                                         {direction(13.0, 0.0), direction(22.0, 0.0)},
                                         {direction(19.0, 0.0), direction(30.0, 0.0)}};
  std::vector<double> values(3);
  table.fill_pairs(asked, values);
  CHECK(values == std::vector<double>{0.25, 0.25, 0});
}

TEST_CASE("isotropic samples stand for all rotations and for mirror images") {
  const TableSpec spec{
      PairList{{{30, 0, 20, 60}, {30, 0, 20, 120}}, true}, {{"R", Part::kTotal, 0}}, {}, {}};
  const Table table(spec, {0.5, 0.25}, {1, 1});
  double value = 0;
  for (const auto& [phi_i, phi_o, expected] :
       {std::array{77.0, 137.0, 0.5}, std::array{77.0, 17.0, 0.5}, std::array{77.0, -43.0, 0.25}}) {
    INFO(phi_i << ' ' << phi_o);
    REQUIRE(
        table.interpolate({direction(30.0, phi_i), direction(20.0, phi_o)}, std::span(&value, 1)));
    CHECK(value == expected);
  }
}

TEST_CASE("of scattered samples the invalid ones do not count") {
  const TableSpec spec{
      PairList{{{30, 0, 20, 60}, {31, 0, 20, 60}}}, {{"R", Part::kTotal, 0}}, {}, {}};
  double value = 0;
  const Directions asked = {direction(30.0, 0.0), direction(20.0, 60.0)};
  REQUIRE(Table(spec, {0.5, 0.25}, {0, 1}).interpolate(asked, std::span(&value, 1)));
  CHECK(value == 0.25);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  REQUIRE(Table(spec, {0.5, nan}, {1, 1}).interpolate(asked, std::span(&value, 1)));
  CHECK(value == 0.5);
  CHECK_FALSE(Table(spec, {0.5, nan}, {0, 1}).interpolate(asked, std::span(&value, 1)));
  CHECK(value == 0);
}

TEST_CASE("a table whose numbers do not match its axes is refused") {
  CHECK_THROWS_AS(Table(small_spec(), std::vector<double>(7), std::vector<std::uint8_t>(60)),
                  std::invalid_argument);
  CHECK_THROWS_AS(Table(small_spec(), std::vector<double>(120), std::vector<std::uint8_t>(61)),
                  std::invalid_argument);
}

TEST_CASE("streamed rows arrive in order, once each, for any number of threads") {
  const TableSpec spec{
      halfdiff4d(9, 8, 30, 40), {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}}, {}, {}};
  const Table table = counting_table(spec);
  for (const int threads : {1, 2, 5}) {
    const Table copy = collect(table, threads);
    CHECK(std::equal(copy.values().begin(), copy.values().end(), table.values().begin(),
                     table.values().end()));
  }
}

TEST_CASE("an error while rows are taken ends the stream and reaches the caller") {
  const Table table = counting_table({halfdiff4d(9, 8, 30, 40), {{"R", Part::kTotal, 0}}, {}, {}});
  CHECK_THROWS_AS(
      stream_rows(table, 2,
                  [](std::size_t, std::span<double>) { throw std::runtime_error("full"); }),
      std::runtime_error);
}

TEST_CASE("streamed cells are counted, all of them, for any number of threads") {
  const Table table = counting_table({halfdiff4d(9, 8, 30, 40), {{"R", Part::kTotal, 0}}, {}, {}});
  for (const int threads : {1, 2, 5}) {
    Progress progress;
    collect(table, {threads, &progress});
    CHECK(progress.snapshot().done == table.spec().cell_count());
  }
}

TEST_CASE("cancelled in mid-stream, the work ends there and the caller is told") {
  const Table table = counting_table({halfdiff4d(90, 8, 30, 40), {{"R", Part::kTotal, 0}}, {}, {}});
  const std::size_t rows = table.spec().row_count();
  for (const int threads : {1, 2, 5}) {
    Progress progress;
    const CancelsAtRow producer(table, rows / 2, progress);
    std::size_t taken = 0;
    const auto take = [&](std::size_t first_row, std::span<double> values) {
      taken = first_row + values.size() / table.spec().row_values();
    };
    CHECK_THROWS_AS(stream_rows(producer, {threads, &progress}, take), Cancelled);
    CHECK(taken <= rows / 2);
    CHECK(progress.snapshot().done < table.spec().cell_count());
  }
}

TEST_CASE("cells above the horizon: by their node for point values, by any part for averages") {
  TableSpec spec{halfdiff3d(), {{"R", Part::kTotal, 0}}, {}, {}};
  const std::vector<std::uint8_t> points = cells_with_values(spec);
  spec.cells.average = true;
  const std::vector<std::uint8_t> parts = cells_with_values(spec);
  std::size_t more = 0;
  for (std::size_t cell = 0; cell < points.size(); ++cell) {
    if (points[cell] != 0) CHECK(parts[cell] != 0);
    if (parts[cell] != 0 && points[cell] == 0) ++more;
  }
  CHECK(more > 1000);
  CHECK(std::count(parts.begin(), parts.end(), 0) > 10000);
}

}  // namespace clothbrdf::test
