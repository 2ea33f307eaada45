#pragma once

namespace clothbrdf {

/// Fits of a MERL table from a start nearby, its weights given: with its rows reduced, and with all
/// of them. Wall-clock time on one thread, reduction included.
void register_fit_benchmarks();

}  // namespace clothbrdf
