#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/support/run_program.h"

namespace clothbrdf::test {

/// A terminal of 80 columns, and a screen that remembers all that was written to it.
class PseudoTerminal {
 public:
  PseudoTerminal() : screen_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    char name[128];
    if (screen_.get() < 0 || ::grantpt(screen_.get()) != 0 || ::unlockpt(screen_.get()) != 0 ||
        ::ptsname_r(screen_.get(), name, sizeof name) != 0) {
      throw std::runtime_error("cannot make a pseudo-terminal");
    }
    end_ = detail::Descriptor(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
    const winsize size{24, 80, 0, 0};
    if (end_.get() < 0 || ::ioctl(end_.get(), TIOCSWINSZ, &size) != 0) {
      throw std::runtime_error("cannot open a pseudo-terminal");
    }
    ::setenv("TERM", "xterm", 1);  // for the programs under test
  }

  /// For the program to write to.
  int end() const { return end_.get(); }

  /// Stops the screen, as Ctrl-S does: whoever writes to it waits.
  void hold() const { ::tcflow(end_.get(), TCOOFF); }

  /// Everything written so far.
  const std::string& text() {
    char block[4096];
    for (pollfd ready{screen_.get(), POLLIN, 0}; ::poll(&ready, 1, 0) > 0;) {
      const ssize_t count = ::read(screen_.get(), block, sizeof block);
      if (count <= 0) break;
      text_.append(block, static_cast<std::size_t>(count));
    }
    return text_;
  }

 private:
  detail::Descriptor screen_;
  detail::Descriptor end_;
  std::string text_;
};

}  // namespace clothbrdf::test
