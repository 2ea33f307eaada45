#pragma once

#include <string>
#include <vector>

#include "fit/options.h"
#include "fit/parameter_set.h"
#include "support/progress.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// Another measurement, and what it would settle.
struct Remedy {
  std::string words;
  std::vector<bool> settles;  ///< by parameter: identifiable then
};

/// Whether a table can tell the rotation of a cloth.
bool has_phi_h(const TableSpec& spec);

/// What a table without some effects shows of a material; what is known then (weights of 0, no
/// layers) is fixed in the options.
Material without_effects(const TableSpec& spec, const Material& material, FitOptions& options);

/// What the options free where a table of the material is looked at.
ParameterSet asked_set(const TableSpec& spec, const Material& material, const FitOptions& options);

/// The same, less what lies on its bound, where no derivative tells of both sides.
ParameterSet identified_set(const TableSpec& spec, const Material& material,
                            const FitOptions& options);

/// What other grids, less noise, and knowing one thing from elsewhere would settle, each by the
/// predicted standard errors; the least effort first.
std::vector<Remedy> try_remedies(const TableSpec& spec, const Material& material,
                                 const FitOptions& options, double noise, Workers workers);

}  // namespace clothbrdf
