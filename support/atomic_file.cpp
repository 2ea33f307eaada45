#include "support/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <utility>

#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr mode_t kMode = 0666;  // less the user's umask
constexpr int kMostLinks = 40;  // as Linux follows

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

// Short, so that a target's name may be as long as the system allows.
std::filesystem::path hidden_name(const std::filesystem::path& target) {
  return folder_of(target) / (".clothbrdf-" + unguessable_digits() + ".part");
}

// What a signal interrupts is begun again: some network file systems do not do so themselves.
template <class Call>
int uninterrupted(const Call& call) {
  int result = 0;
  do {
    result = call();
  } while (result < 0 && errno == EINTR);
  return result;
}

}  // namespace

std::string unguessable_digits() {
  std::random_device random;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%08x%08x", random(), random());
  return digits;
}

AtomicFile::AtomicFile(const std::filesystem::path& target) : name_(target), target_(target) {
  struct stat status {};
  const bool replaces = ::stat(target_.c_str(), &status) == 0;
  // The system may forbid to follow a link that somebody else put into a shared folder.
  if (!replaces && errno != ENOENT) fail("cannot write", errno);
  // Not by canonical(), which stays at a link that leads to no file yet.
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(target_, error); ++links) {
    if (links == kMostLinks) fail("cannot write", ELOOP);
    target_ = folder_of(target_) / std::filesystem::read_symlink(target_, error);
    if (error) fail("cannot follow the link", error.value());
  }
  if (replaces) {
    if (S_ISDIR(status.st_mode)) fail("cannot write", EISDIR);
    if (!S_ISREG(status.st_mode))
      throw WorkError(name_.string() + ": cannot write: not a regular file");
  }
  // A file that others must not read stays so, from the start.
  const mode_t mode = replaces ? status.st_mode & 0777 : kMode;
  open_anonymous(mode);
  if (fd_ < 0) open_hidden(mode);
  // What the umask took away; not where the system refuses.
  if (replaces) static_cast<void>(::fchmod(fd_, mode));
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : name_(std::move(other.name_)),
      target_(std::move(other.target_)),
      hidden_(std::exchange(other.hidden_, {})),
      size_(other.size_),
      fd_(std::exchange(other.fd_, -1)) {}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!hidden_.empty()) ::unlink(hidden_.c_str());
}

void AtomicFile::fail(const char* what, int error) const {
  throw WorkError(name_.string() + ": " + what + ": " + std::strerror(error));
}

void AtomicFile::open_anonymous(mode_t mode) {
  // A file without a name gets one through /proc.
  if (::access("/proc/self/fd", X_OK) != 0) return;
  fd_ = uninterrupted(
      [&] { return ::open(folder_of(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode); });
  const bool not_supported = errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL;
  if (fd_ < 0 && !not_supported) fail("cannot write", errno);
}

void AtomicFile::open_hidden(mode_t mode) {
  std::filesystem::path hidden;
  do {
    hidden = hidden_name(target_);
    // O_EXCL: never through a link, never into a file that is there already.
    fd_ = uninterrupted(
        [&] { return ::open(hidden.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode); });
  } while (fd_ < 0 && errno == EEXIST);
  if (fd_ < 0) fail("cannot write", errno);
  hidden_ = hidden;
}

void AtomicFile::reserve(std::uint64_t bytes) {
#ifdef __linux__
  const auto allocate = [&] { return ::fallocate(fd_, 0, 0, static_cast<off_t>(bytes)); };
  if (uninterrupted(allocate) != 0 && (errno == ENOSPC || errno == EFBIG || errno == EDQUOT)) {
    fail("cannot write", errno);
  }
#else
  static_cast<void>(bytes);
#endif
}

void AtomicFile::write_at(std::uint64_t offset,
                          std::span<const std::span<const std::byte>> pieces) {
  constexpr std::size_t kMostPieces = 64;  // well below the system's IOV_MAX
  while (!pieces.empty()) {
    const std::span<const std::span<const std::byte>> now =
        pieces.first(std::min(pieces.size(), kMostPieces));
    std::array<iovec, kMostPieces> vector{};
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      // The interface is older than const; the bytes are only read.
      vector[k] = {const_cast<std::byte*>(now[k].data()), now[k].size()};
      bytes += now[k].size();
    }
    const ssize_t done =
        ::pwritev(fd_, vector.data(), static_cast<int>(now.size()), static_cast<off_t>(offset));
    if (done != static_cast<ssize_t>(bytes)) {
      // Interrupted, full, or cut short: piece by piece, which finds out.
      std::uint64_t at = offset;
      for (const std::span<const std::byte> piece : now) {
        write_at(at, piece);
        at += piece.size();
      }
    }
    offset += bytes;
    pieces = pieces.subspan(now.size());
  }
  size_ = std::max(size_, offset);
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot write", errno);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  size_ = std::max(size_, offset);
}

void AtomicFile::link_to_target() {
  const std::string self = "/proc/self/fd/" + std::to_string(fd_);
  const auto link = [&](const std::filesystem::path& to) {
    return uninterrupted(
        [&] { return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, to.c_str(), AT_SYMLINK_FOLLOW); });
  };
  if (link(target_) == 0) return;
  while (errno == EEXIST) {
    const std::filesystem::path candidate = hidden_name(target_);
    if (link(candidate) == 0) {
      hidden_ = candidate;
      return;
    }
  }
  fail("cannot write", errno);
}

std::filesystem::path AtomicFile::readable() const {
  return "/proc/self/fd/" + std::to_string(fd_);
}

void AtomicFile::commit() {
  // On a network file system closing tells of bytes that never arrived: a second descriptor is
  // closed before the file has its name. Linux closes it even where a signal interrupts that.
  const int copy = ::fcntl(fd_, F_DUPFD_CLOEXEC, 0);
  if (copy < 0 || (::close(copy) != 0 && errno != EINTR)) fail("cannot write", errno);
  if (hidden_.empty()) link_to_target();
  ::close(std::exchange(fd_, -1));
  if (hidden_.empty()) return;
  const auto rename = [&] { return ::rename(hidden_.c_str(), target_.c_str()); };
  if (uninterrupted(rename) != 0) fail("cannot write", errno);
  hidden_.clear();
}

}  // namespace clothbrdf
