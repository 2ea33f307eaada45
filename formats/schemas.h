#pragma once

#include <string_view>

namespace clothbrdf {

/// The text of a file of data-schemas/, for instance "material.schema.json".
std::string_view schema_text(std::string_view file_name);

}  // namespace clothbrdf
