#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace clothbrdf {

// Internal to formats/.

/// An ALTA file taken apart.
struct AltaRows {
  std::map<std::string, std::string, std::less<>> keys;
  std::size_t inputs = 0;       ///< coordinates of a row
  std::size_t outputs = 0;      ///< values of a row
  bool has_intervals = false;   ///< of confidence, which are left out
  std::vector<double> numbers;  ///< inputs + outputs for each row

  std::size_t count() const { return numbers.size() / (inputs + outputs); }

  /// The value of a key. Throws InputError where there is none.
  const std::string& required(std::string_view key, const std::string& name) const;
};

/// Takes the bytes of a file apart; `name` is the file's, for messages. Throws InputError.
AltaRows parse_alta(std::string_view bytes, const std::string& name);

}  // namespace clothbrdf
