#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace clothbrdf {

// Internal to formats/.

/// What is wrong with `value`, in one line for the innermost place that is wrong; "" if it follows
/// the JSON Schema (draft 7) `schema`. For instance
///
///     /warp/lobe_axes/0: 1.5 is not allowed: a number from 1e-06 to 1
///     /warp/layer: unknown key (did you mean "layers"?), allowed are absorption, layers, ...
///     /warp/layers: missing, needed is an integer from 0 to 64
///
/// What is allowed is told from the schema's type, minimum, maximum, exclusiveMinimum,
/// exclusiveMaximum, enum, const, minItems, maxItems, items, required, properties,
/// additionalProperties, anyOf, oneOf, allOf and local $ref; schemas are written with these. Of
/// alternatives the first that has the value's type is meant.
std::string find_violation(const nlohmann::json& schema, const nlohmann::json& value);

/// Throws InputError in one line that starts with `file_name` if `value` does not follow
/// `schema_file` of data-schemas/.
void check_against_schema(const nlohmann::json& value, std::string_view schema_file,
                          const std::string& file_name);

}  // namespace clothbrdf
