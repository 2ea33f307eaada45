#pragma once

#include <vector>

#include "fit/options.h"
#include "fit/report.h"
#include "support/progress.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// What a table of the given samples and cell rule would reveal of the material, predicted from
/// exact derivatives and verified by refits of noisy tables. Effects that are off in the spec's
/// provenance are known to be: their weights, and with `internal` the layers, are fixed. `valid`:
/// which cells are measured; empty for all above the horizon.
IdentifyReport identify(const TableSpec& spec, const Material& material,
                        const std::vector<unsigned char>& valid, const IdentifyOptions& options,
                        Workers workers);

/// The map of how many layers can be told: every channel of both yarns at each absorption, each
/// noise.
std::vector<SweepCell> sweep_layers(const TableSpec& spec, const Material& material,
                                    const std::vector<double>& absorptions,
                                    const std::vector<double>& noises,
                                    const IdentifyOptions& options, Workers workers);

}  // namespace clothbrdf
