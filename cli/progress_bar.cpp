#include "cli/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "support/progress_line.h"

namespace clothbrdf {
namespace {

constexpr std::chrono::milliseconds kPatience{1000};  // shorter work is not talked of
constexpr std::chrono::milliseconds kBetweenLines{200};
constexpr std::string_view kErase = "\r\x1b[K";

// What the handler needs. It takes the pointer away while it uses it.
std::atomic<Progress*> cancelled_by_signal = nullptr;
std::atomic<int> caught_signal = 0;
static_assert(std::atomic<Progress*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void cancel_work(int signal) {
  if (caught_signal.exchange(signal) != 0) {
    std::raise(signal);  // SA_RESETHAND: with its default action
    return;
  }
  Progress* const progress = cancelled_by_signal.exchange(nullptr);
  if (progress == nullptr) return;
  progress->cancel();
  cancelled_by_signal.store(progress);
}

struct sigaction install_handler(int signal) {
  struct sigaction old {};
  ::sigaction(signal, nullptr, &old);
  if (old.sa_handler == SIG_IGN) return old;
  struct sigaction handler {};
  handler.sa_handler = cancel_work;
  handler.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  ::sigaction(signal, &handler, nullptr);
  return old;
}

bool can_draw() {
  const char* const terminal = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 &&
         (terminal == nullptr || std::string_view(terminal) != "dumb");
}

// Jobs in the background keep off the terminal.
bool in_foreground() {
  const pid_t front = ::tcgetpgrp(STDERR_FILENO);
  return front < 0 || front == ::getpgrp();
}

std::size_t terminal_columns() {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

// In one piece, past all buffers. A terminal that is gone is no reason to stop.
void write_to_terminal(std::string_view text) {
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

ProgressBar::ProgressBar() : cleared_(std::chrono::steady_clock::now()) {
  cancelled_by_signal = &progress_;
  old_interrupt_ = install_handler(SIGINT);
  old_terminate_ = install_handler(SIGTERM);
  old_hang_up_ = install_handler(SIGHUP);
  if (!can_draw()) return;
  try {
    watcher_ = std::thread([this] { watch(); });
  } catch (const std::system_error&) {  // no more threads: the work is more important
  }
}

ProgressBar::~ProgressBar() {
  if (watcher_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      finished_ = true;
    }
    finished_changed_.notify_one();
    watcher_.join();
    erase();
  }
  ::sigaction(SIGINT, &old_interrupt_, nullptr);
  ::sigaction(SIGTERM, &old_terminate_, nullptr);
  ::sigaction(SIGHUP, &old_hang_up_, nullptr);
  while (cancelled_by_signal.exchange(nullptr) == nullptr) {  // a handler is about to give it back
  }
}

int ProgressBar::signal() { return caught_signal; }

void ProgressBar::clear() {
  const std::lock_guard lock(mutex_);
  cleared_ = std::chrono::steady_clock::now();
  erase();
}

void ProgressBar::erase() {
  if (drawn_) write_to_terminal(kErase);
  drawn_ = false;
}

void ProgressBar::watch() {
  std::unique_lock lock(mutex_);
  const auto finished = [this] { return finished_; };
  for (auto wait = kPatience; !finished_changed_.wait_for(lock, wait, finished);
       wait = kBetweenLines) {
    const Progress::Snapshot phase = progress_.snapshot();
    if (phase.since < cleared_ || !in_foreground()) continue;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - phase.since;
    // The last column stays free: some terminals begin a new line there.
    write_to_terminal("\r" + progress_line(phase, elapsed.count(), terminal_columns() - 1) +
                      "\x1b[K");
    drawn_ = true;
  }
}

}  // namespace clothbrdf
