#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fit/options.h"

namespace clothbrdf {

/// Reads a fit file (data-schemas/fit.schema.json): how to fit a table. What it leaves out keeps
/// the default. Refused as material files are, with InputError in one line that names the file, the
/// JSON pointer, the value and what is allowed; whether a name is that of a parameter shows only
/// with a table.
///
/// Of two names in "parameters" that stand for the same parameter, the one of more steps wins
/// ("warp.scatter" over "warp"), of as many the one that names the yarn ("warp" over "scatter"):
/// the order of a JSON object's keys means nothing. A start that is a path is taken from the fit
/// file's folder.
FitOptions read_fit_file(const std::filesystem::path& path);

/// The same from text; `name` stands for the file's name in errors, `folder` is that of its start.
FitOptions parse_fit_file(std::string_view text, const std::string& name,
                          const std::filesystem::path& folder);

}  // namespace clothbrdf
