#pragma once

#include <string>
#include <vector>

#include "fit/report.h"

namespace clothbrdf {

/// The absorptions and noises of identify --sweep.
struct Sweep {
  std::vector<double> absorptions;
  std::vector<double> noises;
};

/// "absorption=LO:HI:N,noise=LO:HI:N": N values from LO to HI, evenly spaced in their logarithms.
/// Throws InputError.
Sweep parse_sweep(const std::string& text);

/// The map as a table, one line a cell, after a line of names.
std::string sweep_csv(const std::vector<SweepCell>& cells);

/// The map as one JSON object.
std::string sweep_json(const std::vector<SweepCell>& cells);

}  // namespace clothbrdf
