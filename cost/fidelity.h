#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cost/report.h"
#include "support/progress.h"
#include "table/sampled_error.h"

namespace clothbrdf {

/// Name of the setting that all others of the front "evaluation" are compared with.
inline constexpr const char* kAllPaths = "all paths";

/// Settings of the front "evaluation", which writes no file: what simplifying the model costs and
/// saves. `seconds` are those of a million pairs on one thread, without preparing tables.
///
/// - "paths": kAllPaths and "single paths", against all paths. BatchEvaluator<double>.
/// - "layers kept": so many layers of each yarn or all it has, whichever is less: 0 up to one less
///   than the yarn with most, at most 8 numbers of them; against the material as it is. `size`:
///   layers. BatchEvaluator<double>.
/// - "path sum": BatchEvaluator with fewer lobes and shorter polynomials, floats of tolerances 0.1
///   ... 1e-4 and both defaults; against the material as it is. The default of doubles made `exact`
///   itself and is compared with ClothModel at the first 2,000 pairs.
/// - "rotations": means over cloths turned by equal steps of half a turn, a cloth's period, against
///   the closed form, IsotropicMean. `size`: steps. BatchEvaluator<double>.
///
/// exact: [pair][channel] of the material as it is, in doubles. Errors are the same bits for any
/// number of threads. Counts settings into the workers' progress; throws Cancelled.
std::vector<CostSetting> measure_fidelity(const Material& material, const SampledPairs& sampled,
                                          std::span<const double> exact, int repeats,
                                          const Workers& workers);

/// How many settings that gives.
std::size_t fidelity_settings(const Material& material);

}  // namespace clothbrdf
