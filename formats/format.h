#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "support/atomic_file.h"
#include "support/progress.h"
#include "table/producer.h"
#include "table/table.h"

namespace clothbrdf {

/// How to write a table. Formats that have no such choice refuse it.
struct WriteOptions {
  bool half = false;      ///< 16-bit floats; a value that does not fit is an error
  bool compress = false;  ///< without loss
  Workers workers = {};
};

/// One table format. Everything that lists, chooses or describes formats goes by formats().
struct Format {
  std::string_view name;
  std::string_view ending;   ///< of file names, with the dot
  std::string_view summary;  ///< one line for people
  Grid (*default_grid)(Reflectance reflectance);
  bool keeps_description;  ///< whether a file says what its table was made of
  StoredPrecision (*precision)(const WriteOptions& options);
  /// Throws InputError, in one line that starts with the file's name, where the format cannot hold
  /// the table or has no such option.
  void (*check)(const TableSpec& spec, const WriteOptions& options, const std::string& name);

  /// Checks, and writes all of a table into the file; the caller commits. Throws WorkError where
  /// writing fails; counts and is cancelled as stream_rows is.
  void (*write)(const Producer& producer, AtomicFile& file, const WriteOptions& options);

  /// Reads a whole file. Throws InputError, in one line that starts with the file's name. Cells
  /// that are not numbers are accepted.
  Table (*read)(const std::filesystem::path& path);
};

std::span<const Format> formats();

/// For readers: throws InputError, with the reason, where a file is not there, is no regular file
/// or cannot be opened.
void require_readable(const std::filesystem::path& path);

/// The format that a file's ending stands for; null for an unknown ending.
const Format* find_format(const std::filesystem::path& path);

/// The same; throws InputError that lists the known endings.
const Format& format_for(const std::filesystem::path& path);

}  // namespace clothbrdf
