#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "model/material.h"

namespace clothbrdf {

/// Reads a material file (data-schemas/material.schema.json). Refused with InputError, in one line
/// that starts with the file's name and names the JSON pointer, the value and what is allowed: what
/// is not JSON, unknown or duplicate keys, wrong types or lengths, values out of range, nesting too
/// deep, values that contradict one another.
Material read_material(const std::filesystem::path& path);

/// The same from text; `name` stands for the file's name in errors.
Material parse_material(std::string_view text, const std::string& name);

/// The text of a material file: "$schema" first, then every key that is set, numbers so that they
/// read back to the same bits. A weft equal to the warp is left out. Throws std::invalid_argument
/// for an invalid material.
std::string material_to_json(const Material& material);

}  // namespace clothbrdf
