#pragma once

#include <string>
#include <vector>

#include "scene/plan.h"

namespace clothbrdf {

// Internal to formats/: what all materials of a plan have in common.

/// Effects that some material needs, in the order in which they first come; of limits
/// ("internal:2", "internal:4") the one that covers all, none over any.
std::vector<std::string> kept_by_any(const Plan& plan);

/// Effects that no material needs, each with the largest of its bounds; of limits the one beyond
/// which all leave out. A value that differs ("fresnel_angle=0.8") is not told.
std::vector<LeftOut> left_out_by_all(const Plan& plan);

/// The mean over the materials.
Saving mean_saving(const Plan& plan);

}  // namespace clothbrdf
