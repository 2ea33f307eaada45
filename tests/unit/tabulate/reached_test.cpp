#include <algorithm>
#include <iostream>
#include <vector>

#include "formats/material_json.h"
#include "table/table.h"
#include "tabulate/model_producer.h"
#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

// Light from one side, an eye at the other, the cloth turned twice.
Reach some_directions() {
  return {{{{20, 50}, {-30, 40}}, {{5, 5}, {0, 360}}}, {{{30, 60}, {150, 200}}}, {0, 75}};
}

struct Compared {
  std::size_t reached = 0;
  std::size_t changed = 0;  // among them
  std::size_t left = 0;     // others that are not 0
};

Compared with_and_without_reach(TableSpec spec, Precision precision, int threads) {
  const auto all = [&] {
    std::vector<double> values(spec.cell_count() * spec.channels.size());
    const auto producer = make_producer(spec, threads, precision);
    stream_rows(*producer, threads, [&](std::size_t first_row, std::span<double> rows) {
      std::copy(rows.begin(), rows.end(),
                values.begin() + static_cast<std::ptrdiff_t>(first_row * spec.row_values()));
    });
    return values;
  };
  const std::vector<double> whole = all();
  spec.reach = some_directions();
  const std::vector<double> part = all();
  std::vector<std::uint8_t> reached(spec.cell_count(), 1);
  ReachedCells(spec.grid(), *spec.reach).restrict(reached);
  Compared result;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    const std::size_t row = at / spec.row_values();
    const std::size_t cell = row * spec.column_count() + at % spec.column_count();
    if (reached[cell] != 0) {
      ++result.reached;
      result.changed += part[at] != whole[at];
    } else {
      result.left += part[at] != 0;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("cells that a scene reaches have the bits of the whole table, the others are 0") {
  const Material silk = read_material(preset("silk"));
  Material paper = read_material(preset("tamamushi"));
  paper.reflectance = Reflectance::kPaper;
  paper.rotation_deg = 20;
  const CellRule average = {true, 1e-2};
  const std::vector<TableSpec> specs = {
      material_spec(silk, {}, halfdiff3d(30, 30, 61)),
      material_spec(silk, {}, halfdiff4d(20, 18, 20, 15)),
      material_spec(paper, {}, halfdiff4d(20, 18, 20, 30, 360), {}, true),
      material_spec(silk, {}, inout()),
      material_spec(paper, {}, inout(5, 1, 6, 24)),
      material_spec(silk, {}, halfdiff3d(12, 12, 9), average),
      material_spec(silk, {}, halfdiff4d(6, 6, 6, 5), average),
      material_spec(read_material(preset("cotton")), {}, inout(3, 6, 3, 6), {true, 0.1})};
  for (const TableSpec& spec : specs) {
    for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
      const Compared found = with_and_without_reach(spec, precision, 2);
      INFO(spec.description() << (spec.cells.average ? ", averages" : ""));
      const std::size_t values = spec.cell_count() * spec.channels.size();
      std::cout << spec.description() << ": " << found.reached << " of " << values
                << " values reached\n";
      CHECK(found.reached > 0);
      CHECK(found.reached < values);
      CHECK(found.changed == 0);
      CHECK(found.left == 0);
    }
  }
}

TEST_CASE("a scene that reaches nothing of a grid has a table of zeros") {
  TableSpec spec = material_spec(read_material(preset("silk")), {}, halfdiff3d(10, 10, 9));
  spec.reach = Reach{{{{0, 0}, {0, 0}}}, {}, {0}};
  std::vector<double> values(spec.row_values(), 1.0);
  make_producer(spec, 1)->fill_rows(3, values);
  CHECK(std::all_of(values.begin(), values.end(), [](double v) { return v == 0; }));
}

TEST_CASE("pairs of directions without a grid have no reach") {
  TableSpec spec = material_spec(read_material(preset("silk")), {}, AnyPairs{});
  spec.reach = some_directions();
  CHECK_THROWS_WITH(make_producer(spec, 1), "a reach is for the cells of a grid");
}

}  // namespace clothbrdf::test
