#include "formats/window_xml.h"

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/window_xml_text.h"

namespace clothbrdf::test {

TEST_CASE("every cut of a Klems file is refused, and no changed byte does harm") {
  const TemporaryFolder folder;
  const std::string bases =
      "<ColumnAngleBasis>LBNL/Klems Quarter</ColumnAngleBasis>"
      "<RowAngleBasis>LBNL/Klems Quarter</RowAngleBasis>";
  std::string numbers;
  for (int k = 0; k < 41 * 41; ++k) numbers += "1 ";
  const std::string file = window_file("Columns", bases, numbers);
  // Within the numbers one cut is like another.
  const std::size_t numbers_begin = file.find("<ScatteringData>") + 40;
  const std::size_t numbers_end = file.find("</ScatteringData>") - 20;
  for (std::size_t size = 0;
       size<file.size(); size += size> numbers_begin && size < numbers_end ? 19 : 1) {
    write_file(folder / "cut.xml", file.substr(0, size));
    INFO("cut to " << size << " of " << file.size() << " bytes");
    REQUIRE_THROWS_WITH(
        format_for("cut.xml").read(folder / "cut.xml"),
        ContainsSubstring((folder / "cut.xml").string() + ": ") && !ContainsSubstring("\n"));
  }
  std::size_t refused = 0;
  std::size_t read = 0;
  const std::size_t header = file.find("<ScatteringData>") + 20;
  for (std::size_t at = 0; at < header; ++at) {
    for (const char changed : {'\0', '<', '"', '9', '\xff'}) {
      std::string other = file;
      other[at] = changed;
      write_file(folder / "other.xml", other);
      try {
        const Table table = format_for("other.xml").read(folder / "other.xml");
        INFO("byte " << at << " as " << static_cast<int>(changed));
        REQUIRE(table.spec().cell_count() == 41 * 41);
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  WARN(refused << " changes refused, " << read << " without effect on the shape");
  CHECK(refused > 1000);
  CHECK(read > 100);
}

TEST_CASE("what is not a Klems file is refused in one line with what is allowed") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const std::string& part) {
    write_file(folder / "bad.xml", content);
    CHECK_THROWS_WITH(format_for("bad.xml").read(folder / "bad.xml"),
                      ContainsSubstring((folder / "bad.xml").string() + ": ") &&
                          ContainsSubstring(part) && !ContainsSubstring("\n"));
  };
  const std::string quarter =
      "<ColumnAngleBasis>LBNL/Klems Quarter</ColumnAngleBasis>"
      "<RowAngleBasis>LBNL/Klems Quarter</RowAngleBasis>";
  refused("", "empty");
  refused("{}", "no XML");
  refused("<html/>", "WindowElement");
  refused(window_file("Diagonals", quarter, "1"), "'Diagonals'; allowed: Columns");
  refused(window_file("Columns", "", "1"), "allowed: LBNL/Klems Full, Half, Quarter");
  refused(window_file("Columns", quarter, "1 2 3"), "after 3 numbers; it has 1681");
  refused(window_file("Columns", quarter, "1 2 three"), "'three' after 2 numbers");
  std::string many;
  for (int k = 0; k < 41 * 41 + 1; ++k) many += "1 ";
  refused(window_file("Columns", quarter, many), "after 1681 numbers");
  std::string front = window_file("Columns", quarter, many);
  front.replace(front.find("Reflection Back"), 15, "Reflection Fron");
  refused(front, "'Reflection Back'");
  // Entities are not expanded.
  refused("<!DOCTYPE a [<!ENTITY b \"" + std::string(1000, 'x') + "\">]>" +
              window_file("Columns", quarter, "&b;&b;"),
          "'&b;&b;'");
  CHECK_THROWS_AS(format_for("x.xml").read(folder / "absent.xml"), InputError);
  const Table table = preset_table("silk", inout());
  CHECK_THROWS_WITH(write_table(table, folder / "k.xml"), ContainsSubstring("patches of its own"));
}

TEST_CASE("every cut of a tree is refused, and no changed byte does harm") {
  const TemporaryFolder folder;
  const std::string basis = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>";
  std::string leaves = "{";
  for (int n = 0; n < 15; ++n) leaves += "{0." + std::to_string(n) + "},";
  leaves += "{1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16}}";
  const std::string file = window_file("TensorTree4", basis, leaves);
  write_file(folder / "whole.xml", file);
  CHECK(format_for("whole.xml").read(folder / "whole.xml").spec().cell_count() == 15 + 16);
  for (std::size_t size = 0; size < file.size(); ++size) {
    write_file(folder / "cut.xml", file.substr(0, size));
    INFO("cut to " << size << " of " << file.size() << " bytes");
    REQUIRE_THROWS_AS(format_for("cut.xml").read(folder / "cut.xml"), InputError);
  }
  std::size_t refused = 0;
  std::size_t read = 0;
  for (std::size_t at = 0; at < file.size(); ++at) {
    for (const char changed : {'\0', '<', '9', '{', '}'}) {
      std::string other = file;
      other[at] = changed;
      write_file(folder / "other.xml", other);
      try {
        const Table table = format_for("other.xml").read(folder / "other.xml");
        INFO("byte " << at << " as " << static_cast<int>(changed));
        REQUIRE(table.spec().cell_count() <= 31);
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  WARN(refused << " changes refused, " << read << " read");
  CHECK(refused > 1000);
}

TEST_CASE("trees that no cloth needs are refused at once") {
  const TemporaryFolder folder;
  const std::string basis = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>";
  const auto refused = [&](const std::string& content, const std::string& part) {
    write_file(folder / "bad.tree.xml", content);
    CHECK_THROWS_WITH(format_for("bad.tree.xml").read(folder / "bad.tree.xml"),
                      ContainsSubstring((folder / "bad.tree.xml").string() + ": ") &&
                          ContainsSubstring(part) && !ContainsSubstring("\n"));
  };
  refused(window_file("TensorTree4", basis, std::string(1000000, '{')), "depth 16");
  refused(window_file("TensorTree4", basis, "{}"), "1, 16, 256");
  refused(window_file("TensorTree4", basis, "{1 2}"), "1, 16, 256");
  refused(window_file("TensorTree3", basis, "{1 2}"), "1, 8, 64");
  refused(window_file("TensorTree4", basis, "{1}{2}"), "nothing more");
  refused(window_file("TensorTree4", basis, "{x}"), "numbers between braces");
  refused(window_file("TensorTree4", "", "{1}"), "LBNL/Shirley-Chiu");
  std::string nested;
  for (int k = 0; k < 200000; ++k) nested += "<a>";
  refused(nested, "no XML");
}

}  // namespace clothbrdf::test
