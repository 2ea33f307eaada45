#pragma once

#include <string>
#include <vector>

#include "fit/misfit.h"
#include "fit/report.h"

namespace clothbrdf {

/// What other cloths that fit as well have to say of a parameter.
struct Doubt {
  Verdict verdict = Verdict::kIdentifiable;
  std::string reason;
};

/// Standard errors know only the neighbourhood of one fit. Where other cloths fit as well, a
/// parameter is known no better than their values are alike, and no better than each of them knows
/// it. By parameter of the set.
std::vector<Doubt> doubts(const Misfit& misfit, const ParameterSet& set, const Material& chosen,
                          const std::vector<Material>& others, double noise);

/// Three digits, for people.
std::string short_text(double value);

}  // namespace clothbrdf
