#pragma once

#include <string>

#include "model/effects.h"
#include "table/table_spec.h"

namespace clothbrdf {

// Options that several commands share, from text to values. All throw InputError that names the
// option, what was given and what is allowed.

/// "specular,diffuse": the components named are on, the others off.
Effects parse_effects(const std::string& list);

/// "point", "average" or "average:REL".
CellRule parse_cells(const std::string& text);

/// 1 to 1024.
int parse_threads(const std::string& text);

/// "specular, diffuse", for people.
std::string effects_text(const Effects& effects);

}  // namespace clothbrdf
