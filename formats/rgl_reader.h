#pragma once

#include <filesystem>

#include "table/table.h"

namespace clothbrdf {

/// Reads any RGL tensor file; see rgl_format(). Throws InputError, in one line that starts with the
/// file's name.
Table read_rgl(const std::filesystem::path& path);

}  // namespace clothbrdf
