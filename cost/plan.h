#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cost/nodes.h"
#include "table/reading.h"

namespace clothbrdf {

/// A file that `cost` measures, and the readers that it is measured with.
struct PlannedFile {
  std::string dial;
  std::string ending;  ///< of the format
  Samples samples;
  CellRule cells;
  bool half = false;
  std::uint64_t bytes = 0;  ///< of formats with --size; else 0
  std::vector<Reader> readers = {Reader::kInterpolated};
  bool even_axes = false;  ///< all axes even in angle
};

/// Isotropic files: axes uniform in angle, MERL's, chosen nodes; averages; half, float and double;
/// RGL. `nodes` are those of the mean over rotations. Files that a material of reflectance 'paper'
/// has not are left out.
std::vector<PlannedFile> isotropic_files(const ChosenNodes& nodes, Reflectance reflectance);

/// The same of anisotropic files, with in/out grids and one axis of the grid doubled at a time.
std::vector<PlannedFile> anisotropic_files(const ChosenNodes& nodes, Reflectance reflectance);

}  // namespace clothbrdf
