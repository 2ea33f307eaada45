#pragma once

#include <vector>

#include "fit/observations.h"
#include "fit/report.h"
#include "fit/rows.h"
#include "support/progress.h"

namespace clothbrdf {

/// Residuals of a fit by the component that is the largest and by the larger of theta_i and
/// theta_o.
std::vector<RegionResidual> residual_regions(const Observations& observations,
                                             const ValueSource& source, const Material& material,
                                             Workers workers);

}  // namespace clothbrdf
