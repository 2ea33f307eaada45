#pragma once

#include <string>

#include "cost/report.h"

namespace clothbrdf {

/// What a cost report says, for people: a table a front, by time, with '*' at its Pareto front;
/// then how errors converge, then the sentences. Columns are as wide as they need.
std::string cost_text(const CostReport& report);

}  // namespace clothbrdf
