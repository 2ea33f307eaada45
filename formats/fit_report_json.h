#pragma once

#include <string>

#include "fit/report.h"

namespace clothbrdf {

/// The text of a fit report (data-schemas/fit_report.schema.json). What is not known is absent, and
/// so would be a number that is not finite, or a material that read_material() refuses.
std::string fit_report_to_json(const FitReport& report);

/// The text of an identify report (data-schemas/identify_report.schema.json), likewise.
std::string identify_report_to_json(const IdentifyReport& report);

}  // namespace clothbrdf
