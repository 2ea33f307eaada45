#pragma once

#include <filesystem>
#include <string>

namespace clothbrdf {

// Internal to formats/.

/// All of a file. Throws InputError, in one line that starts with its name, where it cannot be
/// read.
std::string file_bytes(const std::filesystem::path& path);

}  // namespace clothbrdf
