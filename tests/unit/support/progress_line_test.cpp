#include "support/progress_line.h"

#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

Progress::Snapshot phase(std::size_t done, std::size_t total,
                         const std::string& what = "silk.exr") {
  return {what, done, total, "cells", {}};
}

}  // namespace

TEST_CASE("a progress line tells per cent, counts, rate and time left") {
  const auto line = [](std::size_t done, std::size_t total, double seconds) {
    return progress_line(phase(done, total), seconds, 100);
  };
  CHECK(line(0, 1024, 3) == "silk.exr: 0 %, 0 of 1024 cells");
  CHECK(line(256, 1024, 2) == "silk.exr: 25 %, 256 of 1024 cells, 128 cells/s, 6 s left");
  CHECK(line(1'366'875, 3'280'500, 1) ==
        "silk.exr: 41 %, 1.4 M of 3.3 M cells, 1.4 M cells/s, 2 s left");
  CHECK(line(3, 83'000, 3600) == "silk.exr: 0 %, 3 of 83 k cells, 3.0 cells/h, 1153 days left");
  CHECK(line(2, 10, 8) == "silk.exr: 20 %, 2 of 10 cells, 15 cells/min, 32 s left");
  CHECK(line(1, 2, 98) == "silk.exr: 50 %, 1 of 2 cells, 37 cells/h, 98 s left");
  CHECK(line(1, 2, 150) == "silk.exr: 50 %, 1 of 2 cells, 24 cells/h, 3 min left");
  CHECK(line(1, 2, 7200) == "silk.exr: 50 %, 1 of 2 cells, 0.5 cells/h, 2 h left");
  CHECK(line(1999, 2000, 1) == "silk.exr: 99 %, 1999 of 2000 cells, 2.0 k cells/s, 1 s left");
  CHECK(line(2000, 2000, 1) == "silk.exr: 100 %, 2000 of 2000 cells, 2.0 k cells/s, 0 s left");
}

TEST_CASE("digits that round up to a new one move on to the next suffix") {
  const auto rate = [](double per_second) {
    const std::string line = progress_line(phase(9999, 9999), 9999 / per_second, 100);
    const std::string before = "cells, ";
    const std::size_t from = line.find(before) + before.size();
    return line.substr(from, line.find(" cells/s") - from);
  };
  CHECK(rate(9.94) == "9.9");
  CHECK(rate(9.96) == "10");
  CHECK(rate(999.4) == "999");
  CHECK(rate(999.6) == "1.0 k");
  CHECK(rate(9960) == "10 k");
  CHECK(rate(999'600) == "1.0 M");
}

TEST_CASE("a progress line fits into its columns, whatever the file is called") {
  const std::string numbers = ": 25 %, 256 of 1024 cells, 128 cells/s, 6 s left";
  // Beyond ASCII a character may take two columns.
  for (const std::string& name : {std::string(200, 'a'), std::string("玉虫織り玉虫織り.exr")}) {
    for (std::size_t columns = 0; columns <= 80; ++columns) {
      const std::string line = progress_line(phase(256, 1024, name), 2, columns);
      std::size_t used = 0;
      for (const char c : line) {
        const auto byte = static_cast<unsigned char>(c);
        used += byte < 0x80 ? 1 : (byte >= 0xC0 ? 2 : 0);
      }
      CAPTURE(line, columns);
      CHECK(used <= columns);
      if (columns >= numbers.size() + 8) CHECK(line.ends_with(numbers));
    }
  }
  CHECK(progress_line(phase(256, 1024, "玉虫織り"), 2, 5) == "玉虫");
}

TEST_CASE("a progress line is one line without control characters") {
  CHECK(progress_line(phase(0, 8, "a\n\x1b[2Jb.exr"), 1, 80) == "a??[2Jb.exr: 0 %, 0 of 8 cells");
}

}  // namespace clothbrdf::test
