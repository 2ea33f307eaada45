#pragma once

#include <cmath>
#include <string>

#include "fit/report.h"
#include "tests/support/fit_cases.h"

namespace clothbrdf::test {

/// Names of all numbers of a report that are infinite or not a number; empty for an honest report.
inline std::string not_finite(const FitReport& r) {
  std::string names;
  const auto look = [&](const std::string& name, double value) {
    if (!std::isfinite(value)) names += name + ' ';
  };
  const auto look_at = [&](const std::string& name, const Material& m) {
    if (m.channel_count() == 0) return;  // of a report without a fit
    for (const FitParameter& p : fit_parameters(m.channel_count())) {
      look(name + '.' + p.name, parameter_value(m, p));
    }
  };
  look_at("material", r.material);
  for (const ParameterEstimate& p : r.parameters) {
    look(p.name, p.value);
    look(p.name + " error", p.standard_error.value_or(0));
    look(p.name + " start", p.start);
    look(p.name + " lowest", p.lowest);
    look(p.name + " highest", p.highest);
  }
  for (const BlindDirection& b : r.blind) {
    look("blind", b.singular_value);
    for (const BlindDirection::Part& part : b.parts) look("blind " + part.name, part.change);
  }
  for (const LayerFit& f : r.layers.fits) {
    look("layers " + std::to_string(f.warp) + ' ' + std::to_string(f.weft), f.chi2);
  }
  for (const Equivalent& e : r.equivalents) look_at(e.words, e.material);
  for (const ConventionFit& c : r.conventions) look("convention", c.chi2);
  for (const RegionResidual& x : r.residuals) {
    look(x.component + ' ' + x.region, x.rms);
    look(x.component + ' ' + x.region, x.mean);
  }
  for (const Optimum& o : r.optima) look("optimum", o.chi2);
  look("condition", r.condition);
  look("noise", r.noise);
  look("chi2", r.chi2);
  look("residual_rms", r.residual_rms);
  look("seconds", r.seconds);
  return names;
}

}  // namespace clothbrdf::test
