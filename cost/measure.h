#pragma once

#include <filesystem>

#include "cost/report.h"
#include "support/progress.h"

namespace clothbrdf {

/// Pairs that errors are measured at: sampled_pairs of these.
inline constexpr std::size_t kCostPairs = 100000;
inline constexpr std::uint64_t kCostSeed = 4;

/// Measures every setting, one after the other: writes a file without a name into the scratch
/// folder, reads it back, and compares what its reader finds with the model. Up to three minutes on
/// two cores, 2 GB of memory and 400 MB of disk. Errors are the same bits each time. Counts
/// settings into the workers' progress; throws Cancelled.
CostReport measure_cost(const Material& material, const std::filesystem::path& scratch_folder,
                        const Workers& workers);

}  // namespace clothbrdf
