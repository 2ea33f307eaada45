#include "formats/merl.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

constexpr std::size_t kBytes = 34992012;

std::string header(std::int32_t a, std::int32_t b, std::int32_t c) {
  const std::int32_t sizes[] = {a, b, c};
  return {reinterpret_cast<const char*>(sizes), sizeof sizes};
}

double stored(const std::string& file, std::size_t index) {
  double value = 0;
  std::memcpy(&value, file.data() + 12 + 8 * index, sizeof value);
  return value;
}

}  // namespace

TEST_CASE("a MERL file has the published layout, order and scales, and 0 below the horizon") {
  const TemporaryFolder folder;
  const Table table = preset_table("tamamushi", halfdiff3d());
  write_table(table, folder / "t.binary");
  const std::string file = read_file(folder / "t.binary");
  REQUIRE(file.size() == kBytes);
  CHECK(file.substr(0, 12) == header(90, 90, 180));
  for (const std::size_t cell :
       {std::size_t{0}, std::size_t{700000}, std::size_t{1457999}, std::size_t{123456}}) {
    INFO("cell " << cell);
    CHECK(std::abs(stored(file, cell) - table.value(cell, 0) * 1500) <= 1e-15 * stored(file, cell));
    CHECK(std::abs(stored(file, 1458000 + cell) - table.value(cell, 1) * 1500 / 1.15) <=
          1e-15 * stored(file, 1458000 + cell));
    CHECK(std::abs(stored(file, 2916000 + cell) - table.value(cell, 2) * 1500 / 1.66) <=
          1e-15 * stored(file, 2916000 + cell));
  }
  // theta_h and theta_d near 90 degrees, phi_d near 0: unreachable.
  CHECK(stored(file, (89 * 90 + 89) * 180) == 0);
}

TEST_CASE("a MERL file reads back to the table that was written") {
  const TemporaryFolder folder;
  const Table table = preset_table("silk", halfdiff3d());
  write_table(table, folder / "t.binary");
  const Table back = format_for("t.binary").read(folder / "t.binary");
  CHECK(back.spec().grid() == table.spec().grid());
  double worst = 0;
  for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double f = table.value(cell, c);
      worst = std::max(worst, std::abs(back.value(cell, c) - f) / std::max(f, 1e-300));
    }
  }
  CHECK(worst <= 3e-16);  // a product and a quotient
  write_table(back, folder / "again.binary");
  const Table again = format_for("t.binary").read(folder / "again.binary");
  CHECK(std::equal(again.values().begin(), again.values().end(), back.values().begin(),
                   [](double a, double b) { return std::abs(a - b) <= 3e-16 * b; }));
}

TEST_CASE(
    "cells that a measured MERL file marks by negative values are not valid, others are kept as "
    "they are") {
  const TemporaryFolder folder;
  std::string file = header(90, 90, 180) + std::string(kBytes - 12, '\0');
  const auto put = [&](std::size_t index, double value) {
    std::memcpy(file.data() + 12 + 8 * index, &value, 8);
  };
  put(5, -1);
  put(1458000 + 6, -0.5);
  put(7, std::numeric_limits<double>::quiet_NaN());
  put(8, 3000);
  write_file(folder / "m.binary", file);
  const Table table = format_for("m.binary").read(folder / "m.binary");
  CHECK(!table.valid(5));
  CHECK(!table.valid(6));
  CHECK(table.valid(7));
  CHECK(std::isnan(table.value(7, 0)));
  CHECK(table.valid(8));
  CHECK(table.value(8, 0) == 2);
}

TEST_CASE("what is not a MERL file is refused in one line with its name and what is allowed") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const std::string& part) {
    write_file(folder / "bad.binary", content);
    CHECK_THROWS_WITH(format_for("bad.binary").read(folder / "bad.binary"),
                      ContainsSubstring((folder / "bad.binary").string() + ": ") &&
                          ContainsSubstring(part) && !ContainsSubstring("\n"));
  };
  refused("", "0 bytes");
  refused("short", "5 bytes");
  refused(header(90, 90, 360) + std::string(8, '\0'), "90 x 90 x 360");
  refused(header(-1, -1, -1458000), "-1 x -1");
  refused(header(90, 90, 180) + std::string(100, '\0'), "34992012");
  refused(header(90, 90, 180) + std::string(kBytes - 12 + 1, '\0'), "34992013");
  CHECK_THROWS_AS(format_for("x.binary").read(folder / "absent.binary"), InputError);
  CHECK_THROWS_AS(format_for("x.binary").read(folder.path()), InputError);
}

TEST_CASE("a table that MERL cannot hold is refused") {
  const TemporaryFolder folder;
  AtomicFile file(folder / "t.binary");
  const auto write = [&](const Table& table, const WriteOptions& options = {}) {
    clothbrdf::write_table(format_for("t.binary"), table, file, options);
  };
  CHECK_THROWS_WITH(write(preset_table("silk", halfdiff4d(2, 2, 2, 2))),
                    ContainsSubstring("halfdiff4d:2x2x2x2"));
  CHECK_THROWS_WITH(write(preset_table("silk", halfdiff3d(9, 9, 9))),
                    ContainsSubstring("halfdiff3d:90x90x180 only"));
  CHECK_THROWS_WITH(write(preset_table("silk", halfdiff3d(), true)),
                    ContainsSubstring("12 channels"));
  const Table small = preset_table("silk", halfdiff3d());
  CHECK_THROWS_WITH(write(small, {.half = true}), ContainsSubstring("half"));
}

}  // namespace clothbrdf::test
