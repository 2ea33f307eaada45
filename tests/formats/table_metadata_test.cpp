#include "formats/table_metadata.h"

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

}  // namespace clothbrdf::test
