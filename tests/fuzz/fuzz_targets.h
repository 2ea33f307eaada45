#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace clothbrdf::test {

using Bytes = std::span<const unsigned char>;

/// A way into the program for bytes that nobody vouches for.
struct FuzzTarget {
  std::string name;  ///< "read.exr", "write.exr", "material"
  /// Ends normally, whatever the bytes: they are taken, or refused in one line. Throws
  /// std::logic_error where they are refused otherwise, or where what was written reads back as
  /// something else.
  std::function<void(Bytes)> run;
  /// Small inputs that are taken.
  std::function<std::vector<std::string>()> seeds;
};

/// A reader each of the table formats, a round trip each, and the readers of JSON files, which are
/// round trips too where the program writes such files.
std::vector<FuzzTarget> fuzz_targets();

}  // namespace clothbrdf::test
