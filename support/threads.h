#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace clothbrdf {

/// Runs work whose parallel parts use up to `threads` threads, more than there are processors if
/// asked.
template <class Work>
void with_threads(int threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(work);
}

/// Threads to use when the user does not say: one a processor.
inline int default_threads() { return tbb::info::default_concurrency(); }

}  // namespace clothbrdf
