#include "formats/alta.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "formats/alta_layout.h"
#include "formats/alta_read.h"
#include "formats/table_metadata.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

enum class Encoding { kText, kBinary };

constexpr std::size_t kCountDigits = 10;  // room for any count that ALTA can take

// A header in two pieces, before and after the number of rows, which is known in the end.
struct Header {
  std::string before;
  std::string after;
};

Header header_of(const TableSpec& spec, const AltaLayout& layout, Encoding encoding) {
  Header header;
  header.before = "#DIM " + std::to_string(layout.dimension()) + " " +
                  std::to_string(spec.channels.size()) + "\n#PARAM_IN " +
                  std::string(layout.parametrisation()) + "\n#PARAM_OUT " +
                  std::string(layout.output()) + "\n#VS 0\n#SAMPLE_COUNT ";
  header.after = "\n#CLOTHBRDF " + table_metadata(spec) + "\n";
  if (encoding == Encoding::kBinary) {
    header.after +=
        "#FORMAT binary\n#VERSION 0\n#PRECISION ieee754-double\n#ENDIAN little\n#BEGIN_STREAM\n";
  }
  return header;
}

// Gathers rows and writes them in pieces.
class RowWriter {
 public:
  RowWriter(AtomicFile& file, Header header, Encoding encoding)
      : file_(file), header_(std::move(header)), encoding_(encoding) {}

  void add(std::span<const double> coordinates, std::span<const double> values) {
    if (count_ == 0) write_header(coordinates.front());
    for (const double x : coordinates) append(x);
    for (const double y : values) append(y);
    if (encoding_ == Encoding::kText) buffer_.back() = '\n';
    ++count_;
    if (buffer_.size() > kBufferBytes) flush();
  }

  std::size_t count() const { return count_; }

  void finish() {
    if (encoding_ == Encoding::kBinary) buffer_ += "\n#END_STREAM\n";
    flush();
    const std::string count = std::to_string(count_);
    file_.write_at(header_.before.size(), std::as_bytes(std::span(count)));
  }

 private:
  void write_header(double first) {
    // ALTA takes data that begin with a '#' for a line of the header, unless that has an end.
    char byte = 0;
    std::memcpy(&byte, &first, 1);
    if (encoding_ == Encoding::kBinary && byte == '#') header_.after += "#ALTA END HEADER\n";
    buffer_ = header_.before + std::string(kCountDigits, ' ') + header_.after;
  }

  void append(double number) {
    if (encoding_ == Encoding::kBinary) {
      std::array<char, sizeof number> bytes{};
      std::memcpy(bytes.data(), &number, sizeof number);
      buffer_.append(bytes.data(), bytes.size());
      return;
    }
    constexpr std::size_t kLongest = 24;  // "-2.2250738585072014e-308"
    std::array<char, kLongest> text{};
    char* const end = std::to_chars(text.data(), text.data() + kLongest, number).ptr;
    buffer_.append(text.data(), end);
    buffer_ += ' ';
  }

  void flush() {
    file_.write_at(file_.size(), std::as_bytes(std::span(buffer_)));
    buffer_.clear();
  }

  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

  AtomicFile& file_;
  Header header_;
  Encoding encoding_;
  std::string buffer_;
  std::size_t count_ = 0;
};

// Calls `fail` where readers would not take a file of so few rows.
void require_enough(std::size_t rows, const TableSpec& spec,
                    const std::function<void(const std::string&)>& fail) {
  if (rows > 0 && rows >= spec.cell_count() / kMostCellsPerRow) return;
  fail(": only " + std::to_string(rows) + " of " + std::to_string(spec.cell_count()) +
       " cells hold a value; one in 100 is needed, a coarser grid may have it");
}

template <Encoding kEncoding>
void write_alta(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  const TableSpec& spec = producer.spec();
  const std::size_t columns = spec.column_count();
  const std::size_t channels = spec.channels.size();
  const AltaLayout layout(spec);
  RowWriter rows(file, header_of(spec, layout, kEncoding), kEncoding);
  const std::vector<std::uint8_t> counts = cells_with_values(spec);
  std::vector<double> of_cell(channels);
  const auto take = [&](std::size_t first_row, std::span<double> values) {
    const std::size_t first = first_row * columns;
    for (std::size_t k = 0; k < values.size() / channels; ++k) {
      if (counts[first + k] == 0) continue;
      for (std::size_t c = 0; c < channels; ++c) {
        of_cell[c] = values[(k / columns * channels + c) * columns + k % columns];
      }
      if (std::any_of(of_cell.begin(), of_cell.end(), [](double v) { return v < 0; })) continue;
      const std::array<double, 4> coordinates = layout.coordinates(first + k);
      rows.add(std::span(coordinates).first(layout.dimension()), of_cell);
    }
  };
  stream_rows(producer, options.workers, take);
  require_enough(rows.count(), spec,
                 [&](const std::string& text) { throw WorkError(file.name().string() + text); });
  rows.finish();
}

Samples alta_samples(Reflectance reflectance, bool isotropic) {
  if (!isotropic) return inout();
  // A table that is not reciprocal goes around once.
  if (reflectance == Reflectance::kPaper) return halfdiff3d(30, 30, 60, 360);
  return halfdiff3d(30, 30, 30);
}

void check_alta(const TableSpec& spec, const WriteOptions& /*none*/, const std::string& name) {
  if (!spec.has_grid() && !spec.has_pairs()) {
    throw InputError(name + ": ALTA holds grids and lists of pairs, not " + spec.description());
  }
  if (spec.has_grid() && !spec.grid().regular()) {
    throw InputError(name + ": " + spec.description() +
                     " is not allowed: ALTA's readers know regular axes only");
  }
  if (spec.cell_count() > std::numeric_limits<std::int32_t>::max()) {
    throw InputError(name + ": " + spec.description() + " is not allowed: ALTA counts up to " +
                     std::to_string(std::numeric_limits<std::int32_t>::max()) + " samples");
  }
  // Before the work, what can be told of a scene.
  if (spec.reach) {
    const std::vector<std::uint8_t> counts = cells_with_values(spec);
    require_enough(static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 1)), spec,
                   [&](const std::string& text) { throw InputError(name + text); });
  }
}

}  // namespace

Format alta_format() {
  return {.name = "ALTA",
          .ending = ".alta",
          .summary = "any grid or list of pairs as text, a line for each sample",
          .options = {},
          .default_samples = alta_samples,
          .colours = [](const WriteOptions&) { return Colours::kAny; },
          .keeps_description = true,
          .averages = "",
          .precision = [](const WriteOptions&) { return StoredPrecision{}; },
          .check = check_alta,
          .layout = own_samples,
          .write = write_alta<Encoding::kText>,
          .read = read_alta};
}

Format alta_binary_format() {
  Format format = alta_format();
  format.name = "ALTA binary";
  format.ending = ".dat";
  format.summary = "the same in binary";
  format.write = write_alta<Encoding::kBinary>;
  return format;
}

}  // namespace clothbrdf
