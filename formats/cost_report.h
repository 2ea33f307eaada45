#pragma once

#include <string>

#include "cost/report.h"

namespace clothbrdf {

/// The text of a cost report (data-schemas/cost_report.schema.json). What is not known is absent,
/// and so is a number that is not finite, or a material that read_material() refuses.
std::string cost_report_json(const CostReport& report);

/// Its settings as a table: a line of names, then one line a setting (RFC 4180, but lines end in a
/// line feed alone). Seconds, bytes; numbers as a double reads them back. A field is empty where
/// there is no value, or none that is finite.
std::string cost_report_csv(const CostReport& report);

}  // namespace clothbrdf
