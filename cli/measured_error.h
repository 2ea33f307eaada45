#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "table/table_spec.h"

namespace clothbrdf {

/// The measured error of a file as its metadata has it.
nlohmann::ordered_json error_json(const MeasuredError& measured);

/// For people: "error read linear: rms 0.003, ...".
std::string error_text(const MeasuredError& measured);

}  // namespace clothbrdf
