#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/tensor_file.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// How many nodes a file has.
struct RglSizes {
  std::size_t phi = 0;      ///< azimuths of the eye, first and last the same; 1: isotropic
  std::size_t theta = 0;    ///< elevations of the eye
  std::size_t square = 0;   ///< along each side of a slice of values
  std::size_t density = 0;  ///< along each side of a slice of half-vector densities
  std::size_t channels = 0;

  std::size_t slice_cells() const { return square * square; }
  std::size_t cells() const { return phi * theta * slice_cells(); }
};

/// Nodes of the half-vector distribution, rows and columns, and of the projected area.
inline constexpr std::size_t kNdfSide = 128;
inline constexpr std::size_t kSigmaRows = 2;
inline constexpr std::size_t kSigmaColumns = 512;

/// A file laid out: nodes, and where each field goes.
struct RglLayout {
  RglSizes sizes;
  std::string description;
  std::vector<float> phi_i;           ///< radians
  std::vector<float> theta_i;         ///< radians
  std::vector<float> wavelengths_nm;  ///< empty: RGB
  TensorHeader header;

  const Tensor& field(const std::string& name) const;
  const std::string& values_field() const;  ///< "rgb" or "spectra"
};

/// The finest file of at most so many bytes.  Throws InputError, in one line that starts with
/// `name`, where no file of this spec is so small.
RglLayout rgl_layout(const TableSpec& spec, bool spectral, std::uint64_t bytes,
                     const std::string& name);

/// What a file says of itself in words.
std::string rgl_description(const TableSpec& spec);

}  // namespace clothbrdf
