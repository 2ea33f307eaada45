#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/catch.h"

namespace clothbrdf::test {

/// A measured file that is not part of the project; empty, with a message, where it is not there.
/// They are looked for in $CLOTHBRDF_SHARED_DATA, or in shared/data beside the source folder.
inline std::filesystem::path shared_data(const std::string& name) {
  const char* given = std::getenv("CLOTHBRDF_SHARED_DATA");
  const std::filesystem::path folder =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "../shared/data";
  std::filesystem::path file = folder / name;
  if (std::filesystem::exists(file)) return file;
  WARN("skipped: no measured file " << file.string());
  return {};
}

}  // namespace clothbrdf::test
