#include "formats/file_bytes.h"

#include <fstream>

#include "formats/format.h"
#include "support/errors.h"

namespace clothbrdf {

std::string file_bytes(const std::filesystem::path& path) {
  require_readable(path);
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(path.string() + ": cannot be read");
  return bytes;
}

}  // namespace clothbrdf
