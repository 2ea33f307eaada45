#include "support/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace clothbrdf {
namespace {

// Of /proc/self/status, in bytes.
std::optional<std::uint64_t> status(const std::string& name) {
  std::ifstream in("/proc/self/status");
  std::string word;
  while (in >> word) {
    std::uint64_t kilobytes = 0;
    if (word == name && in >> kilobytes) return kilobytes * 1024;
  }
  return std::nullopt;
}

}  // namespace

PeakMemory::PeakMemory() {
  // What earlier work gave back counts again when it is used again.
  ::malloc_trim(0);
  std::ofstream reset("/proc/self/clear_refs");
  if (reset << '5' << std::flush) before_ = status("VmRSS:");
}

std::optional<std::uint64_t> PeakMemory::added() const {
  const std::optional<std::uint64_t> peak = status("VmHWM:");
  if (!before_ || !peak) return std::nullopt;
  return *peak > *before_ ? *peak - *before_ : 0;
}

}  // namespace clothbrdf
