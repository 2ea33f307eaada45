#pragma once

#include <functional>

#include "cost/report.h"
#include "support/progress.h"

namespace clothbrdf {

/// Median, lowest and highest of what a function says it took, called `repeats` times, 1 or more.
/// The median of an even number of them is the mean of the middle two.
Timing timing_of(int repeats, const std::function<double()>& seconds);

/// Seconds that a million pairs take, of a function that does `pairs` of them: called once unseen,
/// then again and again for a twentieth of a second, in each of the `repeats`. Throws Cancelled.
Timing time_million_pairs(int repeats, std::size_t pairs, const Workers& workers,
                          const std::function<void()>& evaluate);

}  // namespace clothbrdf
