// For LD_PRELOAD: disturbs the calls by which a program writes files into one folder. What happens
// to them is set in the environment, see tests/faults/faults.h.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace {

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

struct Fault {
  std::string folder = variable("CLOTHBRDF_FAULT_FOLDER");
  std::string log = variable("CLOTHBRDF_FAULT_LOG");
  std::string kind = variable("CLOTHBRDF_FAULT");
  long at = std::atol(variable("CLOTHBRDF_FAULT_AT").c_str());
  int error = std::atoi(variable("CLOTHBRDF_FAULT_ERRNO").c_str());
  bool names_needed = !variable("CLOTHBRDF_FAULT_NAMES_NEEDED").empty();
};

const Fault& fault() {
  static const Fault kFault;
  return kFault;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool in_folder(std::string_view path) {
  const std::string& folder = fault().folder;
  return !folder.empty() && path.starts_with(folder) &&
         (path.size() == folder.size() || path[folder.size()] == '/');
}

bool in_folder(int fd) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(fd);
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path);
  return size > 0 && in_folder(std::string_view(path, static_cast<std::size_t>(size)));
}

std::atomic<long> calls = 0;

// Counts and records a call, and does to the program what is due before it; its number.
long count(const std::string& name) {
  const long number = ++calls;
  if (!fault().log.empty()) {
    const int log = static_cast<int>(
        ::syscall(SYS_open, fault().log.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600));
    const std::string line = name + '\n';
    ::syscall(SYS_write, log, line.data(), line.size());
    ::syscall(SYS_close, log);
  }
  if (number == fault().at && fault().kind == "kill") ::raise(SIGKILL);
  // To all of its threads, and over before the call is made.
  if (number == fault().at && fault().kind == "stop") ::kill(::getpid(), SIGSTOP);
  return number;
}

// Whether the call is to fail; with errno set.
bool fails(const std::string& name) {
  const long number = count(name);
  const bool once = fault().kind == "once" && number == fault().at;
  const bool from_then_on = fault().kind == "error" && number >= fault().at;
  if (once || from_then_on) errno = fault().error;
  return once || from_then_on;
}

// How many of the bytes a write shall take; -1, with errno set, where it is to fail.
ssize_t share(const std::string& name, std::size_t bytes, off_t offset) {
  if (fails(name)) return -1;
  const long number = calls;
  const auto wanted = static_cast<ssize_t>(bytes);
  const ssize_t half = (wanted + 1) / 2;
  if (fault().kind == "short" && number == fault().at) return half;
  if (fault().kind == "crumbs") {
    errno = EINTR;
    return number % 2 == 1 ? -1 : half;
  }
  if (fault().kind == "disk") {
    const ssize_t room = static_cast<ssize_t>(fault().at) - static_cast<ssize_t>(offset);
    errno = ENOSPC;
    return room <= 0 && wanted > 0 ? -1 : std::min(room, wanted);
  }
  return wanted;
}

int opened(const char* function, const char* path, int flags, mode_t mode) {
  const auto open = next<int(const char*, int, ...)>(function);
  if ((flags & O_ACCMODE) == O_RDONLY || !in_folder(path)) return open(path, flags, mode);
  const bool nameless = (flags & O_TMPFILE) == O_TMPFILE;
  const bool fresh = (flags & O_CREAT) != 0 && (flags & O_EXCL) != 0;
  if (nameless && fault().names_needed) {
    errno = EOPNOTSUPP;
    return -1;
  }
  if (fails(nameless ? "open nameless" : fresh ? "open fresh" : "open")) return -1;
  return open(path, flags, mode);
}

ssize_t written_at(const char* function, int fd, const void* bytes, std::size_t size,
                   off_t offset) {
  const auto pwrite = next<ssize_t(int, const void*, std::size_t, off_t)>(function);
  if (!in_folder(fd)) return pwrite(fd, bytes, size, offset);
  const ssize_t part = share("write", size, offset);
  return part < 0 ? -1 : pwrite(fd, bytes, static_cast<std::size_t>(part), offset);
}

ssize_t gathered_at(const char* function, int fd, const iovec* pieces, int count, off_t offset) {
  const auto pwritev = next<ssize_t(int, const iovec*, int, off_t)>(function);
  if (!in_folder(fd)) return pwritev(fd, pieces, count, offset);
  std::vector<iovec> taken(pieces, pieces + count);
  std::size_t size = 0;
  for (const iovec& piece : taken) size += piece.iov_len;
  const ssize_t part = share("write", size, offset);
  if (part < 0) return -1;
  auto left = static_cast<std::size_t>(part);
  for (iovec& piece : taken) {
    piece.iov_len = std::min(piece.iov_len, left);
    left -= piece.iov_len;
  }
  return pwritev(fd, taken.data(), count, offset);
}

int allocated(const char* function, int fd, int mode, off_t offset, off_t size) {
  const auto fallocate = next<int(int, int, off_t, off_t)>(function);
  if (!in_folder(fd)) return fallocate(fd, mode, offset, size);
  if (fails("fallocate")) return -1;
  if (fault().kind == "disk") {  // one that can set no space aside: the writes find it full
    errno = EOPNOTSUPP;
    return -1;
  }
  return fallocate(fd, mode, offset, size);
}

mode_t mode_of(int flags, va_list more) {
  const bool creates = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return creates ? va_arg(more, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return opened("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return opened("open64", path, flags, mode);
}

ssize_t pwrite(int fd, const void* bytes, std::size_t size, off_t offset) {
  return written_at("pwrite", fd, bytes, size, offset);
}

ssize_t pwrite64(int fd, const void* bytes, std::size_t size, off64_t offset) {
  return written_at("pwrite64", fd, bytes, size, offset);
}

ssize_t pwritev(int fd, const iovec* pieces, int count, off_t offset) {
  return gathered_at("pwritev", fd, pieces, count, offset);
}

ssize_t pwritev64(int fd, const iovec* pieces, int count, off64_t offset) {
  return gathered_at("pwritev64", fd, pieces, count, offset);
}

int fallocate(int fd, int mode, off_t offset, off_t size) {
  return allocated("fallocate", fd, mode, offset, size);
}

int fallocate64(int fd, int mode, off64_t offset, off64_t size) {
  return allocated("fallocate64", fd, mode, offset, size);
}

int fchmod(int fd, mode_t mode) noexcept {
  if (in_folder(fd) && fails("fchmod")) return -1;
  return next<int(int, mode_t)>("fchmod")(fd, mode);
}

int linkat(int from, const char* path, int to, const char* name, int flags) noexcept {
  if (in_folder(name) && fails("linkat")) return -1;
  return next<int(int, const char*, int, const char*, int)>("linkat")(from, path, to, name, flags);
}

int rename(const char* from, const char* to) noexcept {
  if (in_folder(to) && fails("rename")) return -1;
  return next<int(const char*, const char*)>("rename")(from, to);
}

// Linux closes the file even where that fails.
int close(int fd) {
  const bool failed = in_folder(fd) && fails("close");
  const int error = errno;
  const int result = next<int(int)>("close")(fd);
  if (!failed) return result;
  errno = error;
  return -1;
}

}  // extern "C"
