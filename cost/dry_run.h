#pragma once

#include <cstdint>

#include "cost/file_order.h"

namespace clothbrdf {

/// What a file is expected to cost.
struct Prediction {
  double seconds = 0;
  std::uint64_t bytes = 0;
  MeasuredError error;       ///< of tables without phi_h against the mean over rotations; of a
                             ///< scene's table as if it held all cells
  double isotropy_loss = 0;  ///< rms between that mean and the cloth; of other tables 0
};

/// Of large grids of points from files with fewer theta_h (rows cost alike) and the model at random
/// pairs; other files are made whole, in one without a name, and thrown away. Within a factor of
/// two of what a run then takes.
Prediction predict_file(const FileOrder& order, const FileSetting& setting, const Workers& workers);

}  // namespace clothbrdf
