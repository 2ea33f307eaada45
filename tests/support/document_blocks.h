#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

/// The blocks of one language in a Markdown file.
inline std::vector<std::string> blocks_of(const std::filesystem::path& document,
                                          const std::string& language) {
  std::istringstream text(read_file(document));
  std::vector<std::string> found;
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    if (!inside && line == "```" + language) {
      inside = true;
      found.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      found.back() += line + '\n';
    }
  }
  return found;
}

}  // namespace clothbrdf::test
