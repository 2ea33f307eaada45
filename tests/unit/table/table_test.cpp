#include "table/table.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "tests/catch.h"

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
  void fill_pairs(std::span<const DirectionPair> pairs, std::span<double> values) const override {
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

TEST_CASE("a table answers a pair of directions with the cell that holds it, 0 below the horizon") {
  const Table table = counting_table(small_spec());
  const std::vector<DirectionPair> pairs = {{30, 10, 20, 60}, {120, 0, 20, 0}};
  std::vector<double> values(4);
  table.fill_pairs(pairs, values);
  const Vector3<double> wi = direction(30.0, 10.0);
  const Vector3<double> wo = direction(20.0, 60.0);
  const std::size_t cell = table.spec().grid().cell_of(wi, wo).value();
  CHECK(values[0] == table.value(cell, 0));
  CHECK(values[1] == table.value(cell, 1));
  CHECK(values[2] == 0);
}

TEST_CASE("a list of pairs is a table too") {
  const TableSpec spec{std::vector<DirectionPair>{{30, 10, 20, 60}, {10, 0, 20, 0}},
                       {{"R", Part::kTotal, 0}},
                       {},
                       {}};
  const Table table(spec, {0.5, 0.25}, {1, 1});
  CHECK(spec.row_count() == 2);
  CHECK(spec.row_values() == 1);
  const std::vector<DirectionPair> asked = {{10, 0, 20, 0}, {11, 0, 20, 0}};
  std::vector<double> values(2);
  table.fill_pairs(asked, values);
  CHECK(values[0] == 0.25);
  CHECK(values[1] == 0);
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
  const std::vector<std::uint8_t> points = cells_above_horizon(spec);
  spec.cells.average = true;
  const std::vector<std::uint8_t> parts = cells_above_horizon(spec);
  std::size_t more = 0;
  for (std::size_t cell = 0; cell < points.size(); ++cell) {
    if (points[cell] != 0) CHECK(parts[cell] != 0);
    if (parts[cell] != 0 && points[cell] == 0) ++more;
  }
  CHECK(more > 1000);
  CHECK(std::count(parts.begin(), parts.end(), 0) > 10000);
}

}  // namespace clothbrdf::test
