#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <thread>

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

/// Threads to use when the user does not say: one for each processor that the process may use. (TBB
/// could tell, but looks for libraries first, which costs a millisecond.)
inline int default_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace clothbrdf
