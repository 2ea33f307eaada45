#pragma once

#include "fit/settle.h"

namespace clothbrdf {

/// The fit that is reported. Holds references.
struct ChosenFit {
  const Observations& observations;
  const SettledFit& fit;
  const LayerTable& layers;
  const ParameterSet& set;
  const FitOptions& options;
  bool with_phi_h;
  bool misses_data;  ///< then no parameter is identifiable
};

/// Fills the material, its equivalents, the parameters with their standard errors and verdicts,
/// what cannot be told, and the profile of layer counts. Noise, chi2 and one_yarn of the report are
/// already there.
void report_estimates(const ChosenFit& chosen, Workers workers, FitReport& report);

}  // namespace clothbrdf
