#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace clothbrdf {

// Internal to formats/.

/// Throws InputError if `value`, read from `file_name`, does not follow `schema_file` of
/// data-schemas/. One line, for the innermost place that is wrong, for instance
///   silk.json: /warp/lobe_axes/0: 1.5 is not allowed: a number from 1e-06 to 1
///   silk.json: /warp/layer: unknown key (did you mean "layers"?), allowed are absorption, layers,
///   ... silk.json: /warp/layers: missing, needed is an integer from 0 to 64
/// What is allowed is told from the schema's type, minimum, maximum, exclusiveMinimum,
/// exclusiveMaximum, enum, const, minItems, maxItems, items, required, properties,
/// additionalProperties, anyOf, oneOf, allOf and local $ref; schemas are written with these.
void check_against_schema(const nlohmann::json& value, std::string_view schema_file,
                          const std::string& file_name);

}  // namespace clothbrdf
