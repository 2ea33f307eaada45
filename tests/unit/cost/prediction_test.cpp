#include "cost/prediction.h"

#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {

TEST_CASE("what is predicted of point cells is what is read from the table") {
  const TemporaryFolder folder;
  for (const char* name : {"silk", "tamamushi"}) {
    const Material material = read_material(preset(name));
    for (const Grid& grid : {halfdiff4d(8, 6, 9, 7), halfdiff3d(8, 9, 10), inout(4, 8, 5, 6)}) {
      for (const bool half : {false, true}) {
        const TableSpec spec = material_spec(material, {}, grid);
        const auto file = folder / "table.exr";
        write_table(*make_producer(spec, 1), file, {.half = half});
        const Table table = format_for(file).read(file);
        const auto model =
            make_producer(material_spec(material, {}, AnyPairs{spec.isotropic()}), 1);
        const Exact exact = exact_values(*model, 3000, 8, 1);
        for (const Reader reader : {Reader::kNearest, Reader::kInterpolated}) {
          const std::vector<double> read = read_pairs(table, reader, exact.sampled.pairs, 1);
          std::vector<double> predicted(read.size());
          fill_all_pairs(PointCells(*model, grid, reader, table.precision()), 1,
                         exact.sampled.pairs, predicted);
          double worst = 0;
          for (std::size_t k = 0; k < read.size(); ++k) {
            worst = std::max(worst, std::abs(read[k] - predicted[k]) / (read[k] + 1e-3));
          }
          INFO(name << ' ' << grid.description() << (half ? " half" : "") << ", worst " << worst);
          CHECK(worst < (half ? 1e-3 : 1e-6));  // a value may lie between two halves
          const TableError a = error_of(table, reader, exact, 1);
          const TableError b =
              error_of(PointCells(*model, grid, reader, table.precision()), exact, 1);
          CHECK_THAT(b.rms, Catch::Matchers::WithinRel(a.rms, 1e-4));
          CHECK_THAT(b.p99, Catch::Matchers::WithinRel(a.p99, 1e-3));
        }
      }
    }
  }
}

TEST_CASE("the nearest cell's reader takes the stored value, 0 outside the grid") {
  const Table table = preset_table("silk", inout(3, 4, 3, 4));
  const std::vector<Directions> pairs = {{direction(31.0, 92.0), direction(29.0, 268.0)},
                                         {direction(80.0, 0.0), direction(10.0, 0.0)}};
  const std::vector<double> read = read_pairs(table, Reader::kNearest, pairs, 1);
  const auto cell = table.spec().grid().cell_of(pairs[0].wi, pairs[0].wo);
  REQUIRE(cell);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(read[c] == table.value(*cell, c));
    CHECK(read[3 + c] == 0);
  }
}

}  // namespace clothbrdf::test
