#include "formats/format.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>

#include "formats/exr.h"
#include "formats/merl.h"
#include "support/errors.h"

namespace clothbrdf {

std::span<const Format> formats() {
  static const Format kFormats[] = {merl_format(), exr_format()};
  return kFormats;
}

void require_readable(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::string name = path.string();
  if (!std::filesystem::exists(path, ignored)) throw InputError(name + ": there is no such file");
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw InputError(name + ": is no regular file; a table is needed");
  }
  if (::access(path.c_str(), R_OK) != 0) {
    throw InputError(name + ": cannot be read: " + std::strerror(errno));
  }
}

const Format* find_format(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Format& format : formats()) {
    if (format.ending == ending) return &format;
  }
  return nullptr;
}

const Format& format_for(const std::filesystem::path& path) {
  if (const Format* format = find_format(path)) return *format;
  std::string known;
  for (const Format& format : formats()) {
    known += (known.empty() ? "" : ", ") + std::string(format.ending) + " (" +
             std::string(format.name) + ")";
  }
  throw InputError(path.string() + ": the ending '" + path.extension().string() +
                   "' is not that of a table; known: " + known);
}

}  // namespace clothbrdf
