#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/reflectance.h"
#include "scene/contribution.h"

namespace clothbrdf {

/// One way to do with less: an effect that is off, or limited.
struct Candidate {
  std::string effect;   ///< LeftOut::effect
  std::string what;     ///< LeftOut::what
  Quantity quantity;    ///< what goes with it
  bool changes = true;  ///< false: the cloth is the same without it, to the last bit
};

/// All that can be asked of a cloth, in the order in which it is to be taken away: each Quantity is
/// that of the cloth without those before it. Of one effect there may be several, each less drastic
/// than the one before.
/// `mean_cosine` stands for cos theta_d where Fresnel's angle is left out.
std::vector<std::vector<Candidate>> candidates(const Material& whole, double mean_cosine);

/// Takes one more thing away.
void leave_out(Effects& effects, const Candidate& candidate);

/// Work to evaluate a pair of directions, and its share of what comes before all pairs: about the
/// instructions of the batch evaluator, with vector registers of eight floats.
double evaluation_cost(const Material& whole, const Effects& effects);

/// The share of a table's cells that is left where anisotropy is off: no axis phi_h.
inline constexpr double kCellsWithoutAnisotropy = 1.0 / 36;

}  // namespace clothbrdf
