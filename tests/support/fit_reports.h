#pragma once

#include "fit/report.h"
#include "formats/material_json.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

inline LayerProfile some_layers() {
  return {3, 4, 4, 4, {{3, 3, 250, true}, {3, 4, 20, true}, {4, 3, 5, false}, {4, 4, 1, false}}};
}

inline BlindDirection some_blind_direction() {
  return {0.5,
          "warp_fraction up, weights.specular down",
          {{"warp_fraction", 0.8}, {"weights.specular", -0.6}}};
}

/// A fit report with a value in every field.
inline FitReport full_fit_report() {
  FitReport report;
  report.table = "silk.exr";
  report.grid = "halfdiff3d:12x12x24";
  report.cell_averages = true;
  report.values = 1000;
  report.masked = 2;
  report.below_horizon = 3;
  report.converged = true;
  report.termination = "CONVERGENCE";
  report.message = "Gradient tolerance reached.";
  report.iterations = 12;
  report.material = read_material(preset("silk"));
  report.parameters = {
      {"warp.scatter", "1", 0.05, 0.001, 0.1, 0, 1, Verdict::kIdentifiable, ""},
      {"rotation_deg", "deg", 0, std::nullopt, 0, -45, 45, Verdict::kNotIdentifiable, "isotropic"}};
  report.blind = {some_blind_direction()};
  report.condition = 1e4;
  report.layers = some_layers();
  report.equivalents = {{"the yarns exchanged", report.material}};
  report.conventions = {{Reflectance::kMicrofacet, Paths::kAll, 990, true, false},
                        {Reflectance::kPaper, Paths::kSingle, 1e5, false, true}};
  report.weighting = "relative";
  report.loss = "huber";
  report.noise = 0.01;
  report.noise_estimated = true;
  report.chi2 = 990;
  report.residual_rms = 0.0099;
  report.residuals = {{"specular", "0-45 deg", 100, 0.01, -1e-4}};
  report.starts = 24;
  report.starts_at_best = 23;
  report.optima = {{990, 23, 4, 4}, {1400, 1, 3, 8}};
  report.rows = 77;
  report.seconds = 0.5;
  return report;
}

/// An identify report with a value in every field.
inline IdentifyReport full_identify_report() {
  IdentifyReport report;
  report.material = read_material(preset("silk"));
  report.grid = "halfdiff3d:12x12x24";
  report.noise = 0.01;
  report.values = 1000;
  report.parameters = {
      {"warp.scatter", "1", 0.05, 0.001, 0.0011, 1e-5, Verdict::kIdentifiable, "", ""},
      {"rotation_deg", "deg", 0, {}, {}, {}, Verdict::kNotIdentifiable, "isotropic", "halfdiff4d"}};
  report.singular_values = {1e4, 1};
  report.condition = 1e4;
  report.blind = {some_blind_direction()};
  report.equivalents = {{"the yarns exchanged", report.material}};
  report.layers = some_layers();
  report.refits = 200;
  report.refits_converged = 199;
  report.profiles = {{"warp.scatter", {{0.05, 0, {}}, {0.5, 12, {"warp_fraction"}}}}};
  report.seconds = 2;
  return report;
}

}  // namespace clothbrdf::test
