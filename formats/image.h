#pragma once

#include <filesystem>

#include "support/atomic_file.h"
#include "support/image.h"

namespace clothbrdf {

/// Throws InputError where a file's ending is not that of a picture: .png or .exr, in letters of
/// any case.
void check_picture_name(const std::filesystem::path& path);

/// Writes all of a picture, by the file's ending; the caller commits. .png: 8 bits, sRGB, values
/// beyond 0 to 1 cut off. .exr: linear 32-bit floats, Rec. 709. Throws WorkError.
void write_picture(const Image& image, AtomicFile& file);

}  // namespace clothbrdf
