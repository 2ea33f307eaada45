#pragma once

#include <string>
#include <vector>

#include "fit/observations.h"
#include "fit/parameter_set.h"
#include "fit/report.h"

namespace clothbrdf {

/// An exchange of values within a material: of like parameters, of the shares, a turn.
struct Relabelling {
  std::string words;
  unsigned exchanges = 0;  ///< a bit for each that is made
  double turn_deg = 0;

  Material apply(const Material& material) const;
};

/// Every relabelling of a material that leaves the table as it is, the one that does nothing first;
/// found by trying them all at the given places. Those that would change what the set keeps fixed
/// are left out, and those that lead to a material that is already there.
std::vector<Relabelling> find_equivalents(const Observations& places, const Material& material,
                                          const ParameterSet& set);

/// The relabelling of a material that comes closest to another one.
Material nearest(const std::vector<Relabelling>& equivalents, const Material& material,
                 const Material& target, const ParameterSet& set);

/// How far apart two materials are: squares of relative changes, layers counted whole.
double distance(const Material& a, const Material& b, const ParameterSet& set);

/// The one of them that is reported: rotation in (-45, 45], then the yarn of the larger share with
/// a <= b (of equal shares the warp); without phi_h a <= b in each yarn and the warp with the
/// larger share.
Relabelling canonical(const std::vector<Relabelling>& equivalents, const Material& material,
                      bool with_phi_h);

}  // namespace clothbrdf
