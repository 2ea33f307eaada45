#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <thread>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

#include "support/progress.h"

namespace clothbrdf {

/// Tells the thread sanitizer what TBB sees to, in a library that the sanitizer does not look into:
/// what a thread did before give() is done for every thread that comes to take() later. Does
/// nothing elsewhere.
class Handover {
 public:
#ifdef __SANITIZE_THREAD__
  void give() { __tsan_release(this); }
  void take() { __tsan_acquire(this); }
#else
  void give() {}
  void take() {}
#endif
};

/// The same of parallel work: its pieces find all that its caller did before, and the caller finds
/// all that they did, also where one of them throws.
class ParallelWork {
 public:
  /// Lives while the work is done.
  class Caller {
   public:
    explicit Caller(ParallelWork& work) : work_(work) { work_.start_.give(); }
    ~Caller() { work_.end_.take(); }
    Caller(const Caller&) = delete;
    Caller& operator=(const Caller&) = delete;

   private:
    ParallelWork& work_;
  };

  /// Lives while one piece is done.
  class Piece {
   public:
    explicit Piece(ParallelWork& work) : work_(work) { work_.start_.take(); }
    ~Piece() { work_.end_.give(); }
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

   private:
    ParallelWork& work_;
  };

 private:
  Handover start_;
  Handover end_;
};

/// Runs work whose parallel parts use up to `threads` threads, more than there are processors if
/// asked.
template <class Work>
void with_threads(int threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(work);
}

/// work(0) ... work(count - 1), in the threads of the surrounding with_threads(); one after the
/// other where the workers are one: then it may be part of other parallel work. What is thrown
/// reaches the caller.
template <class Work>
void run_parallel(std::size_t count, const Workers& workers, const Work& work) {
  if (workers.threads == 1) {
    for (std::size_t k = 0; k < count; ++k) work(k);
    return;
  }
  static ParallelWork parallel;  // a task would have to read where any other one is
  const ParallelWork::Caller caller(parallel);
  tbb::parallel_for(std::size_t{0}, count, [&work](std::size_t k) {
    const ParallelWork::Piece piece(parallel);
    work(k);
  });
}

/// Threads to use when the user does not say: one for each processor that the process may use. (TBB
/// could tell, but looks for libraries first, which costs a millisecond.)
inline int default_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace clothbrdf
