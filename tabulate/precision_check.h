#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/directions.h"
#include "model/material.h"
#include "support/progress.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// Pairs of directions at which cloth models usually fail, for this very material: light and eye at
/// grazing incidence, the eye at the light, light and eye nearly opposite, the half vector at the
/// pole, at the horizon and on the crests of the material's lobes. Degrees, above the horizon.
std::vector<DirectionPair> hard_pairs(const Material& material);

/// One way to evaluate f_r, held to the same formula in extended precision (64
/// bits or more) at some pairs of directions.
struct PrecisionFigure {
  std::string evaluation;  ///< "double", "double, vectors", "double batches", "float batches"
  double worst = 0;        ///< largest relative error; infinite where a value is no number
  double worst_share = 0;  ///< largest share of the error that is promised there; at most 1
  std::size_t compared =
      0;  ///< values that the scalar can hold: not above 1e300, or 1e37 of floats
  // Where the share is largest.
  double error = 0;
  double promised = 0;
  DirectionPair pair{};
  Channel channel;
  double value = 0;
  double exact = 0;
};

/// What is promised, relative to the exact value of a channel (docs/model.md):
/// - double: 1e-13 from angles in degrees; 4e-16 X where the exponent X of the absorption is above
///   300; 4e-16 / u more where the half vector leans across a yarn and only u along it, not below
///   the yarn's axis.
/// - double, vectors: that, and 2 eps / (narrowest axis * cos_theta_d).
/// - batches: their tolerance times max(1, 1 / (narrowest axis * cos_theta_d)).
/// Results below 1e-290 (1e-36 of floats) may be anything from 0 to twice that.
std::vector<PrecisionFigure> check_precision(const Material& material,
                                             std::span<const DirectionPair> pairs, Workers workers);

}  // namespace clothbrdf
