#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/plan.h"

namespace clothbrdf {

/// The text of a plan file (data-schemas/plan.schema.json). Beside what the plan holds it says what
/// all materials together need and what none does. Numbers read back to the same bits. Throws
/// std::invalid_argument for a plan of an invalid material.
std::string plan_to_json(const Plan& plan);

/// Reads a plan file: what was written, to the last bit. Refused as material files are, with
/// InputError in one line that names the file, the JSON pointer, the value and what is allowed.
/// What the file says of all materials together is not read: it follows from each.
Plan read_plan(const std::filesystem::path& path);

/// The same from text; `name` stands for the file's name in errors.
Plan parse_plan(std::string_view text, const std::string& name);

}  // namespace clothbrdf
