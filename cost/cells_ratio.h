#pragma once

#include <optional>
#include <span>

#include "cost/report.h"

namespace clothbrdf {

/// What "chosen nodes" spare at one error.
struct CellsRatio {
  double times_fewer = 0;  ///< cells of "uniform axes" over those of "chosen nodes"
  double rms = 0;          ///< at which: the geometric middle of what both dials reach
};

/// Of 4-D tables read linearly, stored as in the first setting of "chosen nodes" with two or more
/// of its kind: cells between settings are interpolated, log to log. None where the dials share no
/// errors.
std::optional<CellsRatio> chosen_nodes_ratio(std::span<const CostSetting> settings);

}  // namespace clothbrdf
