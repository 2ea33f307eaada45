#pragma once

#include "fit/report.h"
#include "fit/solve.h"

namespace clothbrdf {

/// The best chi2 (over the noise, above that at `best`) with one parameter held at values on both
/// sides of its own, all others fitted, from one value to the next.
Profile profile_likelihood(const Misfit& misfit, const ParameterSet& set, std::size_t parameter,
                           const Material& best, double noise, int points, Workers workers);

}  // namespace clothbrdf
