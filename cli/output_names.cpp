#include "cli/output_names.h"

#include <algorithm>
#include <filesystem>

#include "cli/options.h"
#include "support/errors.h"

namespace clothbrdf {

void check_output_names(const std::vector<OutputName>& outputs,
                        const std::vector<std::string>& inputs) {
  for (auto at = outputs.begin(); at != outputs.end(); ++at) {
    const std::string ending = std::filesystem::path(at->file).extension().string();
    if (!at->ending.empty() && ending != at->ending) {
      throw InputError(at->option + ": " + at->file + ": the ending '" + ending +
                       "' is not allowed: " + at->ending);
    }
    const auto is_it = [&](const std::string& file) { return same_file(at->file, file); };
    if (std::any_of(outputs.begin(), at, [&](const auto& other) { return is_it(other.file); })) {
      throw InputError(at->option + ": " + at->file + " is given twice");
    }
    if (std::any_of(inputs.begin(), inputs.end(), is_it)) {
      throw InputError(at->option + ": " + at->file + " is also read; it needs another name");
    }
  }
}

}  // namespace clothbrdf
