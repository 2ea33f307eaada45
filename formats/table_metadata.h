#pragma once

#include <string>
#include <string_view>

#include "table/table_spec.h"

namespace clothbrdf {

/// All that a table says of itself, as one line of JSON (data-schemas/table.schema.json). Of a
/// table without a grid the pairs are left out: its file holds them.
std::string table_metadata(const TableSpec& spec);

/// The spec again, with AnyPairs for samples that are no grid. Throws InputError, in one line that
/// starts with `name`, the file's name.
TableSpec parse_table_metadata(std::string_view text, const std::string& name);

}  // namespace clothbrdf
