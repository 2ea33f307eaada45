#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/material.h"

namespace clothbrdf {

// Plain data: what a fit, and a look at what can be identified, found out. Every number in a report
// is finite; what has no finite value is absent.

/// What a table tells of one parameter, at the given noise.
enum class Verdict {
  kIdentifiable,     ///< standard error at most kIdentifiableError
  kWeak,             ///< at most kWeakError
  kNotIdentifiable,  ///< beyond, or the table does not change with it, or only with others
  kAtBound,          ///< the best value lies on a bound: no standard error
  kFixed,            ///< not fitted
  kTied,             ///< the weft's value is the warp's
};

/// Limits of the verdicts, as shares of the value (of 0.05 where that is larger; of 45 degrees for
/// the rotation).
inline constexpr double kIdentifiableError = 0.05;
inline constexpr double kWeakError = 0.5;

struct ParameterEstimate {
  std::string name;  ///< "warp.lobe_axes.0"
  std::string unit;
  double value = 0;
  std::optional<double> standard_error;  ///< none where it is not fitted or cannot be told
  double start = 0;                      ///< of the best fit
  double lowest = 0;                     ///< bounds
  double highest = 0;
  Verdict verdict = Verdict::kFixed;
  std::string reason;  ///< in words, where the verdict is neither kIdentifiable nor kFixed
};

/// A combination of parameters that hardly changes the table, or does not.
struct BlindDirection {
  struct Part {
    std::string name;
    double change;  ///< relative (log) change of the parameter along the direction
  };
  double singular_value = 0;  ///< change of the table in units of the noise, along `parts`
  std::string words;          ///< "warp_fraction up, weights.specular down"
  std::vector<Part> parts;    ///< largest first; squares add up to 1
};

/// The best fit with given layer counts.
struct LayerFit {
  int warp = 0;
  int weft = 0;
  double chi2 = 0;          ///< sum of squared residuals, in units of the noise
  bool told = false;        ///< from the chosen counts: chi2 is higher by more than kToldApart
  bool equivalent = false;  ///< the chosen fit, relabelled
};

/// Two fits whose chi2 differ by more than this are told apart: three standard deviations.
inline constexpr double kToldApart = 9;

struct LayerProfile {
  int fewest = 0;
  int most = 0;
  int warp = 0;  ///< chosen
  int weft = 0;
  std::vector<LayerFit> fits;  ///< all pairs of counts; those of the warp slowest
};

/// A minimum that scattered starts ended in, with layer counts of its own; chi2 over the rows of
/// the search, in units of the noise.
struct Optimum {
  double chi2 = 0;
  int starts = 0;  ///< that ended there
  int warp_layers = 0;
  int weft_layers = 0;
};

/// The best fit of one convention.
struct ConventionFit {
  Reflectance reflectance = Reflectance::kMicrofacet;
  Paths paths = Paths::kAll;
  double chi2 = 0;
  bool chosen = false;
  bool told = false;  ///< from the chosen one
};

/// Another material with the same table.
struct Equivalent {
  std::string words;  ///< "the yarns exchanged"
  Material material;
};

/// Residuals of a part of the table.
struct RegionResidual {
  std::string component;  ///< that is the largest there: specular, internal or diffuse
  std::string region;  ///< by the larger of theta_i, theta_o: "0-45 deg", "45-75 deg", "75-90 deg"
  std::size_t values = 0;
  double rms = 0;   ///< relative to the fitted value
  double mean = 0;  ///< of (table - fit) / fit
};

/// What a fit says of a table.
struct FitReport {
  std::string table;  ///< file name
  std::string grid;   ///< "halfdiff3d:90x90x180"
  bool cell_averages = false;
  std::size_t values = 0;  ///< fitted: valid cells times channels
  std::size_t masked = 0;  ///< left out: negative, not finite
  std::size_t below_horizon = 0;

  bool converged = false;
  std::string termination;  ///< of the solver, in its own words
  std::string message;
  int iterations = 0;   ///< over all rounds of weights
  std::string failure;  ///< why there is nothing to tell; empty where there is

  Material material;      ///< best fit, in the form that product.md names
  bool one_yarn = false;  ///< two yarns fit no better than this cloth of one
  std::vector<ParameterEstimate> parameters;
  std::vector<BlindDirection> blind;  ///< weak ones too, the worst first
  double condition = 0;  ///< of the Jacobian, columns scaled to 1; 0 where it is infinite
  LayerProfile layers;
  std::vector<Equivalent> equivalents;
  std::vector<ConventionFit> conventions;

  std::string weighting;
  std::string loss;
  double noise = 0;  ///< standard deviation that the standard errors assume
  bool noise_estimated = false;
  double chi2 = 0;          ///< in units of the noise
  double residual_rms = 0;  ///< in units of the weighting
  std::vector<RegionResidual> residuals;

  int starts = 0;          ///< scattered ones
  int starts_at_best = 0;  ///< that reached the best optimum
  std::vector<Optimum> optima;
  std::vector<std::string> notes;  ///< what to bear in mind, in words
  std::size_t rows = 0;            ///< of the compressed problem
  double seconds = 0;
};

/// A point of a profile likelihood: the best chi2 with one parameter held.
struct ProfilePoint {
  double value = 0;
  double chi2 = 0;                    ///< above the best one
  std::vector<std::string> at_bound;  ///< other parameters that sit at their bounds there
};

struct Profile {
  std::string name;
  std::vector<ProfilePoint> points;
};

/// Predicted and observed spread of one parameter.
struct VerifiedParameter {
  std::string name;
  std::string unit;
  double value = 0;
  std::optional<double> predicted;  ///< standard error from the Fisher information
  std::optional<double> observed;   ///< standard deviation over the refits
  std::optional<double> bias;       ///< mean of the refits less the value
  Verdict verdict = Verdict::kFixed;
  std::string reason;
  std::string remedy;  ///< what would settle it: another grid, effect or measurement
};

/// What a table can reveal of a cloth.
struct IdentifyReport {
  Material material;
  std::string grid;
  bool cell_averages = false;
  double noise = 0;
  std::size_t values = 0;
  std::vector<VerifiedParameter> parameters;
  std::vector<double> singular_values;  ///< of the Jacobian in log parameters over the noise
  double condition = 0;
  std::vector<BlindDirection> blind;
  std::vector<Equivalent> equivalents;
  LayerProfile layers;  ///< chi2 that another count would cost, expected
  int refits = 0;
  int refits_converged = 0;
  std::vector<Profile> profiles;
  std::vector<std::string> tried;  ///< other measurements, whether or not they settle anything
  double seconds = 0;
};

/// How many layer counts can be told, over absorption and noise.
struct SweepCell {
  double absorption = 0;
  double noise = 0;
  int told_layers = 0;  ///< counts 0..told_layers are told from their neighbours
};

std::string_view verdict_text(Verdict verdict);

}  // namespace clothbrdf
