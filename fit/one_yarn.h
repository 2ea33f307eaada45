#pragma once

#include <optional>

#include "fit/settle.h"

namespace clothbrdf {

/// The weft tied to the warp, where all of both is free; without phi_h the share then has no effect
/// and is fixed.
std::optional<ParameterSet> one_yarn_set(const ParameterSet& set, const FitOptions& options,
                                         bool with_phi_h);

/// Puts a cloth of one yarn in the place of the fit where that fits as well: the simpler one is
/// reported, and what sets the yarns apart shows as what cannot be told. Whether it did.
bool try_one_yarn(const FitProblem& problem, const FitOptions& options, bool with_phi_h,
                  SettledFit& fit, LayerTable& layers, Workers workers);

}  // namespace clothbrdf
