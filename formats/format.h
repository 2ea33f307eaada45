#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/atomic_file.h"
#include "support/progress.h"
#include "table/producer.h"
#include "table/reading.h"
#include "table/table.h"

namespace clothbrdf {

/// The colours of a file whose format offers both.
enum class Flavour { kRgb, kSpectral };

/// How to write a table. Formats that have no such choice refuse it.
struct WriteOptions {
  bool half = false;                    ///< 16-bit floats; a value that does not fit is an error
  bool compress = false;                ///< without loss
  std::optional<Flavour> flavour = {};  ///< RGB where left out
  std::optional<std::uint64_t> bytes = {};  ///< the largest file; the format's own where left out
  Workers workers = {};

  /// The names of the options that were given.
  std::vector<std::string_view> given() const;
};

/// Which channels a format holds.
enum class Colours {
  kAny,
  kRgb,       ///< R, G and B, totals only
  kSpectrum,  ///< wavelengths, totals only
};

/// What a file of a table will hold: "halfdiff3d:90x90x180".
struct Layout {
  std::string description;
  std::size_t cells = 0;
};

/// One table format. Everything that lists, chooses or describes formats goes by formats().
struct Format {
  std::string_view name;
  std::string_view ending;   ///< of file names, with the dot; the longest that fits counts
  std::string_view summary;  ///< one line for people
  std::span<const std::string_view> options;  ///< those of WriteOptions that it has
  /// Where a table of a material is sampled unless the user says it; AnyPairs where the format has
  /// nodes of its own.
  Samples (*default_samples)(Reflectance reflectance, bool isotropic);
  Colours (*colours)(const WriteOptions& options);
  bool keeps_description;  ///< whether a file says what its table was made of
  bool keeps_listed_nodes =
      false;  ///< whether axes of listed nodes, and mirrored ones, can be kept
  /// What its values are means of, for people; empty where they are those of directions.
  std::string_view averages;
  StoredPrecision (*precision)(const WriteOptions& options);
  Reader reader = Reader::kInterpolated;  ///< what the programs do that read its files
  /// Throws InputError, in one line that starts with the file's name, where the format cannot hold
  /// the table. Options and colours are check_output's.
  void (*check)(const TableSpec& spec, const WriteOptions& options, const std::string& name);
  Layout (*layout)(const TableSpec& spec, const WriteOptions& options);

  /// As write_table, once check_output has passed.
  void (*write)(const Producer& producer, AtomicFile& file, const WriteOptions& options);

  /// Reads a whole file. Throws InputError, in one line that starts with the file's name. Cells
  /// that are not numbers are accepted.
  Table (*read)(const std::filesystem::path& path);
};

std::span<const Format> formats();

/// Throws InputError, in one line that starts with the file's name, where the format cannot hold
/// the table, or lacks an option that was given.
void check_output(const Format& format, const TableSpec& spec, const WriteOptions& options,
                  const std::string& name);

/// Checks, and writes all of a table into the file; the caller commits. Throws WorkError where
/// writing fails; counts and is cancelled as stream_rows is.
void write_table(const Format& format, const Producer& producer, AtomicFile& file,
                 const WriteOptions& options);

/// The layout of formats that keep the table's own samples.
Layout own_samples(const TableSpec& spec, const WriteOptions& options);

/// For readers: throws InputError, with the reason, where a file is not there, is no regular file
/// or cannot be opened.
void require_readable(const std::filesystem::path& path);

/// The format that a file's ending stands for; null for an unknown ending.
const Format* find_format(const std::filesystem::path& path);

/// The same; throws InputError that lists the known endings.
const Format& format_for(const std::filesystem::path& path);

}  // namespace clothbrdf
