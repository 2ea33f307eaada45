#pragma once

#include <span>
#include <string_view>

namespace clothbrdf {

/// A material of materials/ that travels inside the program.
struct Preset {
  std::string_view name;  ///< of the file, without ".json"
  std::string_view text;  ///< the file's content, for parse_material
};

/// All of them, by name.
std::span<const Preset> presets();

/// Null for an unknown name.
const Preset* find_preset(std::string_view name);

}  // namespace clothbrdf
