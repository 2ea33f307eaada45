#pragma once

#include <string>

namespace clothbrdf {

/// Holds the evaluations of a material to extended precision at its hard directions and prints the
/// worst errors. Throws WorkError where one is larger than promised.
void check_material(const std::string& file, int threads, bool json);

}  // namespace clothbrdf
