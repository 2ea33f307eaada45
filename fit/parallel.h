#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

#include "support/progress.h"

namespace clothbrdf {

/// work(0) ... work(count - 1), in the threads of the surrounding with_threads(); one after the
/// other where the workers are one: then it may be part of other parallel work.
template <class Work>
void run_parallel(std::size_t count, const Workers& workers, const Work& work) {
  if (workers.threads == 1) {
    for (std::size_t k = 0; k < count; ++k) work(k);
  } else {
    tbb::parallel_for(std::size_t{0}, count, work);
  }
}

}  // namespace clothbrdf
