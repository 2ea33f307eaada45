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

/// What is free where a table of the material is looked at: what the options free, less what lies
/// on its bound, where no derivative tells of both sides.
ParameterSet identified_set(const TableSpec& spec, const Material& material,
                            const FitOptions& options);
bool lies_at_bound(const ParameterSet& set, std::size_t parameter, const Material& material);

/// What other grids, less noise, and knowing one thing from elsewhere would settle, each by the
/// predicted standard errors; the least effort first.
std::vector<Remedy> try_remedies(const TableSpec& spec, const Material& material,
                                 const FitOptions& options, double noise, Workers workers);

/// All that was tried, for people.
std::string remedy_list(const std::vector<Remedy>& remedies);

}  // namespace clothbrdf
