#pragma once

#include <string>
#include <vector>

namespace clothbrdf {

/// A file that an option names to be written.
struct OutputName {
  std::string option;  ///< "--material"
  std::string file;
  std::string ending;  ///< ".json"; empty where any is allowed
};

/// Throws InputError where a file is to be written that is also read, or twice, or whose ending is
/// not allowed.
void check_output_names(const std::vector<OutputName>& outputs,
                        const std::vector<std::string>& inputs);

}  // namespace clothbrdf
