#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/catch.h"

namespace clothbrdf::test {

/// A file of measured or foreign tables that is not part of the project; none, with a warning,
/// where it is absent. The folder is CLOTHBRDF_SHARED_DATA or shared/data beside the project's.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
  const char* const folder = std::getenv("CLOTHBRDF_SHARED_DATA");
  const std::filesystem::path path =
      std::filesystem::path(folder ? folder : CLOTHBRDF_SOURCE_DIR "/../shared/data") / name;
  if (std::filesystem::exists(path)) return path;
  WARN("skipped: there is no " << path.string());
  return std::nullopt;
}

}  // namespace clothbrdf::test
