#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "table/table.h"

namespace clothbrdf {

// Internal to formats/: what the writer and the reader of MDL files share.

inline constexpr const char* kMdlMagic = "NVIDIA ARC MBSDF V1\n";
inline constexpr const char* kMdlReflection = "MBSDF_DATA_REFLECTION=\n";

/// The head of a block of data, as it stands in the file.
struct MdlSizes {
  std::uint32_t type = 0;  ///< 0: one number a node, 1: R, G and B
  std::uint32_t theta = 0;
  std::uint32_t phi = 0;

  std::size_t node_count() const { return std::size_t{theta} * theta * phi; }

  /// The pair of directions of a node, phi_i = 0; nodes count theta_i, theta_o, phi, the last one
  /// fastest.
  DirectionPair pair(std::size_t node) const;
};

Table read_mdl(const std::filesystem::path& path);

}  // namespace clothbrdf
