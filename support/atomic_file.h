#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace clothbrdf {

/// 16 hexadecimal digits, for names that nobody can expect in a shared folder.
std::string unguessable_digits();

/// A file that appears under its name only when it is whole; an old file of that name stays as it
/// was until then, and passes on its permissions. The bytes sit in a file without a name in the
/// same folder, which goes with the process, however that ends. Where the file system knows no such
/// files, they sit in a hidden one beside it, .clothbrdf-DIGITS.part with digits that nobody can
/// guess, which the destructor removes, but not a process that is killed; elsewhere that name is
/// there only within a commit() that replaces an old file. There is no fsync: it is not safe
/// against power loss. All members throw WorkError, in one line that starts with the file's name.
class AtomicFile {
 public:
  /// The target must be a regular file or not exist; a symbolic link is followed, also to where
  /// there is no file yet, and stays, unless the system forbids to follow it.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;

  /// The name as the user gave it, for messages.
  const std::filesystem::path& name() const { return name_; }

  /// Sets space aside for a file of at least so many bytes: a full disk is found before the work,
  /// and writing is faster. Does nothing on file systems that cannot.
  void reserve(std::uint64_t bytes);

  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// One piece of the file from several pieces of memory: large writes cost less than small ones.
  void write_at(std::uint64_t offset, std::span<const std::span<const std::byte>> pieces);
  std::uint64_t size() const { return size_; }

  /// A name under which this process can read what was written so far.
  std::filesystem::path readable() const;

  /// Gives the file its name, in place of an older one.
  void commit();

 private:
  [[noreturn]] void fail(const char* what, int error) const;
  void open_anonymous(mode_t mode);
  void open_hidden(mode_t mode);
  void link_to_target();

  std::filesystem::path name_;
  std::filesystem::path target_;
  std::filesystem::path hidden_;  // empty while the file has no name
  std::uint64_t size_ = 0;
  int fd_ = -1;
};

}  // namespace clothbrdf
