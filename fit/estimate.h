#pragma once

#include "fit/observations.h"
#include "fit/parameter_set.h"
#include "fit/rows.h"

namespace clothbrdf {

/// A first guess at the material, read off the table: the darkest values are taken for the diffuse
/// part, whose colours give its weight and the absorption; the half vectors at half the height of
/// what lies above it, light and eye close together, give the lobe axes (the nearest and the
/// farthest from the normal). All else, and what the table does not show, is as in set.defaults();
/// so is what was given a start.
Material estimate_from_table(const Observations& observations, const ValueSource& source,
                             const ParameterSet& set);

}  // namespace clothbrdf
