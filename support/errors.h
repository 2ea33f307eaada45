#pragma once

#include <stdexcept>
#include <string>

namespace clothbrdf {

/// Bad input: a file, field or argument that the user can mend. The message is one line that names
/// the file, the field, its value and what is allowed. The program exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Work that failed for a reason outside the input: a full disk, a folder that cannot be written.
/// One line; the program exits with 1.
class WorkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace clothbrdf
