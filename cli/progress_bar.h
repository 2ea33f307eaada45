#pragma once

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <thread>

#include "support/progress.h"

namespace clothbrdf {

/// Shows a Progress to whoever sits before it, and lets them stop the work. For its lifetime
/// SIGINT, SIGTERM and SIGHUP cancel the progress, unless they were ignored before; a second signal
/// ends the program at once. (After a first one main() ends it by that signal.) So an AtomicFile
/// that is opened after it is always destroyed, and leaves nothing hidden. Where standard error is
/// a terminal, one line there tells from the first second on how far the work is; elsewhere there
/// is no output and no thread. One at a time.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  Progress& progress() { return progress_; }

  /// Takes the line away until the next phase begins, to make room for other output.
  void clear();

  /// The signal that cancelled the progress; 0 before.
  static int signal();

 private:
  void watch();
  void erase();

  Progress progress_;
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
  struct sigaction old_hang_up_ {};

  std::mutex mutex_;  // guards what follows, and the terminal's line
  std::condition_variable finished_changed_;
  bool finished_ = false;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point cleared_;  // phases that began before are not shown
  std::thread watcher_;                            // only on a terminal
};

}  // namespace clothbrdf
