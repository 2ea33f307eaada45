#pragma once

#include <filesystem>

namespace clothbrdf {

// Internal to formats/.

/// Reads the attributes of an EXR header by themselves, before OpenEXR allocates what they claim.
/// Throws InputError, in one line that starts with the file's name, where the file is no picture of
/// scan lines in one part, where an attribute is longer than what is left of the file or not as
/// long as its type, or where the picture is too large for the file's bytes.
void require_honest_exr_header(const std::filesystem::path& path);

}  // namespace clothbrdf
