#pragma once

#include <string>

namespace clothbrdf {

/// Runs gnuplot on a script and returns what it writes to standard output. Throws WorkError in one
/// line where gnuplot is not installed, or with its first complaint where it fails.
std::string run_gnuplot(const std::string& script);

/// Throws WorkError where gnuplot is not installed.
void require_gnuplot();

}  // namespace clothbrdf
