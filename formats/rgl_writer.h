#pragma once

#include "formats/rgl_layout.h"
#include "support/atomic_file.h"
#include "table/producer.h"

namespace clothbrdf {

/// Writes all of a file, one azimuth of the eye after the other: a few of them are in memory.
/// Counts cells into the workers' progress; throws Cancelled and WorkError.
void write_rgl(const Producer& producer, const RglLayout& layout, AtomicFile& file,
               Workers workers);

}  // namespace clothbrdf
