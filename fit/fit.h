#pragma once

#include <string>
#include <vector>

#include "fit/options.h"
#include "fit/report.h"
#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// The names of the parameters of a material with so many channels: "weights.specular", ...,
/// "warp.lobe_axes.0", ..., without the layer counts.
std::vector<std::string> parameter_names(std::size_t channels);

/// Throws InputError where a wish names no parameter, or asks for a value or bounds out of range.
void check_wishes(const FitOptions& options, std::size_t channels);

/// Fits the model to a table. Of the table's metadata only axes, cell rule and channels are used.
/// Wishes that make no sense throw InputError; a table with nothing to fit gives a report that says
/// so (`failure`). Counts into the workers' progress and throws Cancelled.
FitReport fit_table(const Table& table, const FitOptions& options, Workers workers);

}  // namespace clothbrdf
