#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/material.h"

namespace clothbrdf {

/// What one unit of misfit is.
enum class Weighting {
  kRelative,     ///< a share of the fitted value: noise proportional to f_r
  kAbsolute,     ///< f_r in 1/sr: the same noise everywhere
  kLogarithmic,  ///< log f_r: log-normal noise; cells that are not positive are left out
};

/// How much far outliers count. All but kSquared by re-weighting; the scale of a residual is the
/// noise.
enum class Loss {
  kSquared,  ///< r^2
  kHuber,    ///< as |r| beyond 1.345 noise
  kCauchy,   ///< log(1 + (r / (2.385 noise))^2)
};

/// A wish about one parameter, or about all those that the name stands for.
struct ParameterWish {
  enum class Kind {
    kFix,    ///< not fitted, at `value`, or where the start has it
    kFree,   ///< fitted, within [lowest, highest] where they are given
    kStart,  ///< fitted from `value`
    kTie,    ///< the weft's value is the warp's
  };
  Kind kind = Kind::kFree;
  /// "warp.lobe_axes.0"; parts of it stand for all that they name: "warp", "weights",
  /// "warp.absorption", or for both yarns "absorption", "lobe_axes.0". Also "layers". See
  /// parameter_names().
  std::string name;
  std::optional<double> value;
  std::optional<double> lowest;
  std::optional<double> highest;

  bool operator==(const ParameterWish&) const = default;
};

/// How to fit a table.
struct FitOptions {
  std::vector<ParameterWish> wishes;  ///< later ones win
  std::optional<Material> start;      ///< every parameter starts there; conventions are not taken
  int fewest_layers = 0;              ///< every count from here ...
  int most_layers = 8;                ///< ... to here is fitted, for both yarns
  std::vector<Reflectance> reflectances = {Reflectance::kMicrofacet, Reflectance::kPaper};
  std::vector<Paths> paths = {Paths::kAll, Paths::kSingle};
  std::optional<double> noise;  ///< standard deviation in units of the weighting; else estimated
  Weighting weighting = Weighting::kRelative;
  Loss loss = Loss::kSquared;
  int starts = 24;  ///< where no start is given; up to four times as many while the best fit does
                    ///< not match the data and few starts agree on it
  std::uint64_t seed = 1;
};

/// What is identified: a table that would be measured of a known cloth.
struct IdentifyOptions {
  FitOptions fit;          ///< what is free, fixed, tied; the noise, 0.01 where none is given
  int refits = 200;        ///< of noisy tables
  int profile_points = 9;  ///< of each profile likelihood
};

}  // namespace clothbrdf
