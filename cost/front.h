#pragma once

#include <span>
#include <string>
#include <vector>

#include "cost/report.h"

namespace clothbrdf {

/// Marks the settings that no other of their front beats: none takes as little time (the median)
/// and errs as little (rms), and less in one of the two. Sorts by front, "3-D", "4-D",
/// "evaluation", then by time. The dial "rotations" errs against other values than the rest of
/// "evaluation" and has a front of its own.
void mark_fronts(std::vector<CostSetting>& settings);

/// What marked settings say, for people:
///
/// - for each front of files and target of 10, 3, 1, 0.3, 0.1 and 0.03 % rms what reaches it
///   soonest (once where it reaches several, for the tightest), and the first target that nothing
///   reaches;
/// - what single paths and fewer layers save and cost against all paths (nothing where it is less
///   than 5 % or the timings overlap);
/// - how many times fewer cells of a 4-D grid "chosen nodes" need than "uniform axes" at one error,
///   in the geometric middle of what both reach.
std::vector<std::string> sentences(std::span<const CostSetting> settings);

}  // namespace clothbrdf
