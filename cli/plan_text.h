#pragma once

#include <string>

#include "scene/plan.h"

namespace clothbrdf {

/// What must be simulated of a scene and what need not be, for people: each effect that is left out
/// with the bound on its error, as a share of the scene's brightest and in the unit of radiance /
/// sr.
std::string plan_text(const Plan& plan);

/// What is left out of a material, and the bound: "left out: scatter, internal:2; within 0.42% of
/// the scene's brightest".
std::string left_out_text(const MaterialPlan& plan);

}  // namespace clothbrdf
