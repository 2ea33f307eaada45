#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>

namespace clothbrdf {

/// Thrown out of work that was given up because the user asked for it.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// How far long work has come, and whether it shall go on. Passive: workers count into it, whoever
/// shows it takes snapshots. All members may be called from several threads at once, begin() only
/// between phases.
class Progress {
 public:
  struct Snapshot {
    std::string what;  ///< of the phase; empty before the first one
    std::size_t done = 0;
    std::size_t total = 0;
    std::string unit;                             ///< of what is counted, in the plural
    std::chrono::steady_clock::time_point since;  ///< when the phase began
  };

  /// Starts a phase of work: begin("silk.exr", cells, "cells"). Throws Cancelled.
  void begin(std::string what, std::size_t total, std::string unit);

  /// Counts finished work. Throws Cancelled.
  void advance(std::size_t count) {
    done_.fetch_add(count, std::memory_order_relaxed);
    check();
  }

  /// Throws Cancelled once cancel() was called. Costs a load.
  void check() const {
    if (cancelled_.load(std::memory_order_relaxed)) throw Cancelled();
  }

  /// Makes the work end soon. May be called in a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }

  Snapshot snapshot() const;

 private:
  static_assert(std::atomic<bool>::is_always_lock_free);

  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> cancelled_ = false;
  mutable std::mutex mutex_;
  Snapshot phase_;  // but for `done`
};

/// Who does long work: so many threads that count into `progress` and end when it is cancelled. A
/// plain number of threads is one, too; nobody counts then.
struct Workers {
  Workers(int threads = 1, Progress* progress = nullptr) : threads(threads), progress(progress) {}

  void advance(std::size_t count) const {
    if (progress != nullptr) progress->advance(count);
  }
  void check() const {
    if (progress != nullptr) progress->check();
  }

  int threads;
  Progress* progress;
};

}  // namespace clothbrdf
