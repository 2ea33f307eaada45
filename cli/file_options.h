#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/format.h"

namespace clothbrdf {

/// Options of files to be written, as text.
struct FileOptions {
  bool half = false;
  bool compress = false;
  std::optional<std::string> flavour;
  std::optional<std::string> size;
};

/// Adds them to a command. `options` must live as long as it does.
void add_file_options(CLI::App& command, FileOptions& options);

/// "silk.bsdf" with "_rgb": "silk_rgb.bsdf". Throws InputError for an ending that is no table's.
std::string with_suffix(const std::string& name, const std::string& suffix);

/// A file to write, and how.
struct FileToWrite {
  std::string name;
  WriteOptions options;
};

/// One file, or two for `--flavour both`, with _rgb and _spec before the ending. Throws InputError
/// that names the option.
std::vector<FileToWrite> files_to_write(const std::string& name, const FileOptions& options);

}  // namespace clothbrdf
