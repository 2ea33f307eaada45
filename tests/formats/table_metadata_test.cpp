#include "formats/table_metadata.h"

#include <cmath>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {

TEST_CASE("the description of a table without a grid says whether it is isotropic") {
  const Material silk = read_material(preset("silk"));
  for (const bool isotropic : {false, true}) {
    const TableSpec any = material_spec(silk, {}, AnyPairs{isotropic});
    CHECK(parse_table_metadata(table_metadata(any), "t.bsdf") == any);
    const TableSpec list = material_spec(silk, {}, PairList{{{1, 2, 3, 4}}, isotropic});
    CHECK(parse_table_metadata(table_metadata(list), "t.bsdf") == any);
  }
}

TEST_CASE("the description of a table names either its grid or that it has none") {
  const TableSpec any = material_spec(read_material(preset("silk")), {}, AnyPairs{});
  std::string text = table_metadata(any);
  const std::string isotropic = "\"isotropic\":false,";
  REQUIRE(text.find(isotropic) != std::string::npos);
  std::string neither = text;
  neither.replace(neither.find(isotropic), isotropic.size(), "");
  CHECK_THROWS_WITH(parse_table_metadata(neither, "t.bsdf"),
                    ContainsSubstring("t.bsdf: ") && ContainsSubstring("/isotropic"));
  const std::string with_grid =
      table_metadata(material_spec(read_material(preset("silk")), {}, inout(2, 3, 4, 5)));
  const std::size_t from = with_grid.find("\"grid\"");
  const std::string grid = with_grid.substr(from, with_grid.find("\"channels\"") - from);
  text.insert(text.find(isotropic), grid);
  CHECK_THROWS_WITH(parse_table_metadata(text, "t.bsdf"), ContainsSubstring("/grid"));
}

namespace {

TableSpec for_scene(const Grid& grid) {
  TableSpec spec = material_spec(read_material(preset("silk")), {}, grid);
  spec.reach = Reach{{{{20, 50}, {-30, 40}}}, {{{30, 60}, {150, 200}}}, {0, 75}};
  return spec;
}

}  // namespace

TEST_CASE("tables made for a scene come back with their reach, values and marks") {
  const TemporaryFolder folder;
  for (const char* name : {"t.exr", "t.alta", "t.dat"}) {
    for (const Grid& grid :
         {halfdiff4d(18, 12, 18, 18), halfdiff3d(24, 24, 36), inout(5, 12, 5, 12)}) {
      const Table table = collect(*make_producer(for_scene(grid), 1), 1);
      write_table(table, folder / name);
      const Table back = format_for(folder / name).read(folder / name);
      INFO(name << ' ' << grid.description());
      CHECK(back.spec().reach == table.spec().reach);
      std::size_t valid = 0;
      for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
        REQUIRE(back.valid(cell) == table.valid(cell));
        valid += back.valid(cell) ? 1U : 0U;
        const double expected = table.value(cell, 1);
        REQUIRE(std::abs(back.value(cell, 1) - expected) <=
                back.precision().relative * expected + back.precision().step);
      }
      CHECK(valid > 0);
      CHECK(2 * valid < grid.cell_count());
    }
  }
}

TEST_CASE("a reach that is none is refused by its place in the description") {
  const std::string good = table_metadata(for_scene(inout(2, 4, 2, 4)));
  const auto told = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
    try {
      parse_table_metadata(text, "t.exr");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(told("[20.0,50.0]", "[20.0,95.0]").starts_with("t.exr: /reach/lights/0/theta_deg/1: 95"));
  CHECK(told("[20.0,50.0]", "[50.0,20.0]").starts_with("t.exr: /reach/lights/0/theta_deg: "));
  CHECK(told("[150.0,200.0]", "[0,361]").starts_with("t.exr: /reach/eyes/0/phi_deg: "));
  CHECK(told("\"rotations_deg\":[0.0,75.0]", "\"rotations_deg\":[]")
            .starts_with("t.exr: /reach/rotations_deg: "));
  TableSpec large = for_scene(inout(2, 4, 2, 4));
  large.reach->rotations_deg.assign(101, 0.0);
  large.reach->lights.assign(100, large.reach->lights[0]);
  CHECK_THROWS_WITH(parse_table_metadata(table_metadata(large), "t.exr"),
                    "t.exr: /reach: 10100 combinations of a light, an eye and a rotation are not "
                    "allowed: at most 10000");
  const TableSpec any = material_spec(read_material(preset("silk")), {}, AnyPairs{});
  std::string pairs = table_metadata(any);
  pairs.insert(pairs.size() - 1, R"(,"reach":{"lights":[{"theta_deg":[0,1],"phi_deg":[0,1]}],)"
                                 R"("eyes":[{"theta_deg":[0,1],"phi_deg":[0,1]}],)"
                                 R"("rotations_deg":[0]})");
  CHECK_THROWS_WITH(parse_table_metadata(pairs, "t.bsdf"),
                    "t.bsdf: /reach: is for the cells of a grid");
}

}  // namespace clothbrdf::test
