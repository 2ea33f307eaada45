#pragma once

#include <cstdint>
#include <optional>

namespace clothbrdf {

/// The most memory that this process held since it was made, beyond what it held then. Works where
/// Linux lets a process reset its peak (/proc/self/clear_refs); one at a time.
class PeakMemory {
 public:
  PeakMemory();

  /// Bytes; none where the system does not tell.
  std::optional<std::uint64_t> added() const;

 private:
  std::optional<std::uint64_t> before_;
};

}  // namespace clothbrdf
