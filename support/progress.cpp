#include "support/progress.h"

#include <utility>

namespace clothbrdf {

void Progress::begin(std::string what, std::size_t total, std::string unit) {
  const std::lock_guard lock(mutex_);
  phase_ = {std::move(what), 0, total, std::move(unit), std::chrono::steady_clock::now()};
  done_.store(0, std::memory_order_relaxed);
  check();
}

Progress::Snapshot Progress::snapshot() const {
  const std::lock_guard lock(mutex_);
  Snapshot phase = phase_;
  phase.done = done_.load(std::memory_order_relaxed);
  return phase;
}

}  // namespace clothbrdf
