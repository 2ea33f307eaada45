#pragma once

#include <string>

#include "cost/report.h"

namespace clothbrdf {

/// A whole gnuplot script of the fronts side by side, "3-D", "4-D", "evaluation", error over time
/// on logarithmic axes; fronts without settings that can be drawn are left out, as are settings
/// whose rms or time is not above 0 and finite. `terminal` is gnuplot's: "svg", "pngcairo"; the
/// sheet is kCostPlotWidth x kCostPlotHeight. The picture goes to standard output. Throws WorkError
/// where nothing can be drawn.
std::string cost_plot(const CostReport& report, const std::string& terminal);

inline constexpr int kCostPlotWidth = 1500;  ///< px
inline constexpr int kCostPlotHeight = 620;  ///< px

}  // namespace clothbrdf
