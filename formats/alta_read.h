#pragma once

#include <filesystem>

#include "table/table.h"

namespace clothbrdf {

// Internal to formats/.

/// Reads an ALTA file, text or binary as its header says.
Table read_alta(const std::filesystem::path& path);

}  // namespace clothbrdf
