#pragma once

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

/// Enters a mount namespace of its own, where mounts are seen by nobody else; as an ordinary user
/// in a user namespace of its own. False where the system forbids that. For forked children only.
inline bool enter_own_namespace() {
  const uid_t user = ::getuid();
  const gid_t group = ::getgid();
  if (user == 0) {
    if (::unshare(CLONE_NEWNS) != 0) return false;
  } else {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    write_file("/proc/self/setgroups", "deny");
    write_file("/proc/self/uid_map", "0 " + std::to_string(user) + " 1");
    write_file("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
  }
  return ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
}

/// A file system of its own of a few MiB, full sooner than any disk; it can be made read-only,
/// which binds root, too. A child process holds it in a namespace of its own, so that nothing is
/// left of it however the test ends; others reach it through /proc.
class MountedFolder {
 public:
  explicit MountedFolder(int mebibytes) {
    int orders[2];
    int answers[2];
    if (::pipe2(orders, O_CLOEXEC) != 0 || ::pipe2(answers, O_CLOEXEC) != 0) return;
    holder_ = ::fork();
    if (holder_ == 0) {
      ::close(orders[1]);
      hold(mebibytes, orders[0], answers[1]);
      ::_exit(0);
    }
    ::close(orders[0]);
    ::close(answers[1]);
    orders_ = orders[1];
    answers_ = answers[0];
    ready_ = answered();
  }
  ~MountedFolder() {
    ::close(orders_);
    ::close(answers_);
    if (holder_ > 0) ::waitpid(holder_, nullptr, 0);
  }
  MountedFolder(const MountedFolder&) = delete;
  MountedFolder& operator=(const MountedFolder&) = delete;

  /// False where the system allows no mounts.
  bool ready() const { return ready_; }

  bool make_read_only() { return ::write(orders_, "r", 1) == 1 && answered(); }

  std::filesystem::path path() const {
    return "/proc/" + std::to_string(holder_) + "/root" + mount_point_.path().string();
  }
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }

  /// Of all it holds, hidden files too.
  std::size_t entry_count() const {
    const std::filesystem::directory_iterator entries(path());
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
  }

 private:
  bool answered() {
    char answer = 0;
    return ::read(answers_, &answer, 1) == 1 && answer == 'y';
  }

  // Until the other end of `orders` is closed.
  void hold(int mebibytes, int orders, int answers) const {
    const char* where = mount_point_.path().c_str();
    const std::string size = "size=" + std::to_string(mebibytes) + "m";
    bool good = enter_own_namespace() && ::mount("tmpfs", where, "tmpfs", 0, size.c_str()) == 0;
    for (char order = 0;;) {
      if (::write(answers, good ? "y" : "n", 1) != 1 || ::read(orders, &order, 1) != 1) return;
      good = ::mount(nullptr, where, nullptr, MS_REMOUNT | MS_RDONLY, size.c_str()) == 0;
    }
  }

  TemporaryFolder mount_point_;
  pid_t holder_ = -1;
  int orders_ = -1;
  int answers_ = -1;
  bool ready_ = false;
};

}  // namespace clothbrdf::test
