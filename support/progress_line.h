#pragma once

#include <string>

#include "support/progress.h"

namespace clothbrdf {

/// A phase of work that began `seconds` ago as a line of at most so many columns, for instance
/// "silk.exr: 42 %, 1.4 M of 3.3 M cells, 1.2 M cells/s, 2 s left". The name gives way first. Rate
/// and time left are those of the whole phase; both are missing as long as nothing is done.
std::string progress_line(const Progress::Snapshot& phase, double seconds, std::size_t columns);

}  // namespace clothbrdf
