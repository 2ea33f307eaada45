#pragma once

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

/// The first column of a table.
inline std::vector<std::string> names_of(const std::string& rows) {
  std::vector<std::string> names;
  std::istringstream lines(rows);
  for (std::string line; std::getline(lines, line);) {
    names.push_back(line.substr(2, line.find(" |", 2) - 2));
  }
  return names;
}

/// Of the table in docs/accuracy.md that begins so: with CLOTHBRDF_WRITE_REFERENCES=1 its rows
/// become these; else it must have rows of the same names.
inline void check_or_write_rows(const std::string& head, const std::vector<std::string>& rows) {
  std::string all;
  for (const std::string& row : rows) all += row;
  const std::filesystem::path file = CLOTHBRDF_SOURCE_DIR "/docs/accuracy.md";
  const std::string text = read_file(file);
  const std::size_t at = text.find(head);
  REQUIRE(at != std::string::npos);
  const std::size_t begin = text.find('\n', text.find('\n', at) + 1) + 1;
  const std::size_t end = text.find("\n\n", begin - 1) + 1;
  if (std::getenv("CLOTHBRDF_WRITE_REFERENCES") != nullptr) {
    write_file(file, text.substr(0, begin) + all + text.substr(end));
  } else {
    CHECK(names_of(text.substr(begin, end - begin)) == names_of(all));
  }
}

}  // namespace clothbrdf::test
