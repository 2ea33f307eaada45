#include "formats/exr.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/exr_header.h"
#include "formats/exr_stream.h"
#include "formats/json_text.h"
#include "formats/table_metadata.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr const char* kAttribute = "clothbrdf";
constexpr std::string_view kExrOptions[] = {"--half", "--compress"};

// A file that remembers how far it was read: nothing may follow a table's last line.
class CountingIStream final : public Imf::IStream {
 public:
  explicit CountingIStream(const std::filesystem::path& path)
      : Imf::IStream(path.c_str()), in_(path, std::ios::binary) {}
  bool read(char bytes[], int count) override {
    if (!in_.read(bytes, count)) throw Iex::InputExc("the file is cut off");
    farthest_ = std::max(farthest_, tellg());
    return in_.peek() != std::ifstream::traits_type::eof();
  }
  std::uint64_t tellg() override { return static_cast<std::uint64_t>(in_.tellg()); }
  void seekg(std::uint64_t position) override {
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(position));
  }
  void clear() override { in_.clear(); }
  std::uint64_t farthest() const { return farthest_; }

 private:
  std::ifstream in_;
  std::uint64_t farthest_ = 0;
};

struct PictureSize {
  std::size_t width;
  std::size_t height;
  std::size_t lines_per_row;  // scan lines of one row of the table
};

PictureSize picture_size(const TableSpec& spec) {
  const Grid& grid = spec.grid();
  const std::size_t width = grid.kind == GridKind::kHalfDifference3d
                                ? static_cast<std::size_t>(grid.axes.back().size)
                                : grid.column_count();
  const std::size_t lines = grid.column_count() / width;
  return {width, grid.row_count() * lines, lines};
}

// Stored samples of one row of the table, in the type of the file.
template <class Sample>
class RowBuffer {
 public:
  RowBuffer(const TableSpec& spec, const PictureSize& size, Imf::PixelType type)
      : spec_(spec), size_(size), type_(type), samples_(spec.row_values()) {}

  std::vector<Sample>& samples() { return samples_; }

  // OpenEXR addresses sample (x, y) as base + x * xStride + y * yStride.
  Imf::FrameBuffer frame(std::size_t first_line) {
    Imf::FrameBuffer frame;
    const std::size_t line_bytes = size_.width * sizeof(Sample);
    for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
      char* base = reinterpret_cast<char*>(samples_.data() + c * spec_.column_count());
      frame.insert(full_name(spec_.channels[c]),
                   Imf::Slice(type_, base - first_line * line_bytes, sizeof(Sample), line_bytes));
    }
    return frame;
  }

 private:
  const TableSpec& spec_;
  PictureSize size_;
  Imf::PixelType type_;
  std::vector<Sample> samples_;
};

[[noreturn]] void refuse_value(const TableSpec& spec, const std::string& name, std::size_t row,
                               std::size_t at, double value, double largest) {
  const std::size_t cell = row * spec.column_count() + at % spec.column_count();
  throw WorkError(name + ": " + full_name(spec.channels[at / spec.column_count()]) + " is " +
                  number_text(value) + " at " + spec.grid().place(cell) +
                  ", beyond the largest stored value " + number_text(largest) +
                  (largest < 1e5 ? "; leave out --half to store 32-bit floats" : ""));
}

// Without a branch for each value.
bool all_fit(std::span<const double> values, double largest) {
  std::size_t beyond = 0;
  for (const double value : values) beyond += std::abs(value) > largest ? 1U : 0U;
  return beyond == 0;
}

StoredPrecision exr_precision(const WriteOptions& options) {
  return options.half ? StoredPrecision{0x1p-11, 0x1p-24, HALF_MAX, 2}
                      : StoredPrecision{0x1p-24, 0x1p-149, std::numeric_limits<float>::max(), 4};
}

template <class Sample>
void write_lines(const Producer& producer, Imf::OutputFile& out, Imf::PixelType type,
                 const std::string& name, Workers workers) {
  const TableSpec& spec = producer.spec();
  const PictureSize size = picture_size(spec);
  const double largest = exr_precision({.half = type == Imf::HALF}).largest;
  RowBuffer<Sample> buffer(spec, size, type);
  const auto check = [&](std::size_t row, std::span<double> values) {
    if (all_fit(values, largest)) return;
    const auto at =
        std::find_if(values.begin(), values.end(), [&](double v) { return std::abs(v) > largest; });
    const auto index = static_cast<std::size_t>(at - values.begin());
    refuse_value(spec, name, row + index / spec.row_values(), index % spec.row_values(), *at,
                 largest);
  };
  const auto write = [&](std::size_t row, std::span<double> values) {
    for (; !values.empty(); ++row, values = values.subspan(spec.row_values())) {
      const std::span<const double> of_row = values.first(spec.row_values());
      std::transform(of_row.begin(), of_row.end(), buffer.samples().begin(),
                     [](double v) { return Sample(static_cast<float>(v)); });
      out.setFrameBuffer(buffer.frame(row * size.lines_per_row));
      out.writePixels(static_cast<int>(size.lines_per_row));
    }
  };
  stream_rows(producer, workers, write, check);
}

Samples exr_samples(Reflectance reflectance, bool isotropic) {
  return parse_grid(isotropic ? "halfdiff3d" : "halfdiff4d",
                    reflectance == Reflectance::kPaper ? 360 : 180);
}

void check_exr(const TableSpec& spec, const WriteOptions& /*all are allowed*/,
               const std::string& name) {
  if (!spec.has_grid()) {
    throw InputError(name + ": EXR holds grids, not " + spec.description() +
                     "; give --grid to resample");
  }
  const PictureSize size = picture_size(spec);
  // OpenEXR counts pixels and bytes of a line in 32-bit integers.
  constexpr std::size_t kMostBytes = std::numeric_limits<int>::max();
  const std::size_t line_bytes = size.width * spec.channels.size() * sizeof(float);
  if (line_bytes > kMostBytes || size.height > kMostBytes / 2) {
    throw InputError(name + ": the grid " + spec.grid().description() +
                     " is not allowed: its picture has " + std::to_string(size.width) + " x " +
                     std::to_string(size.height) +
                     " pixels; EXR holds lines of 2 GiB and 2^30 lines");
  }
}

void write_exr(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  const TableSpec& spec = producer.spec();
  const std::string name = file.name().string();
  const PictureSize size = picture_size(spec);
  try {
    Imf::Header header(static_cast<int>(size.width), static_cast<int>(size.height));
    header.compression() = options.compress ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
    header.insert(kAttribute, Imf::StringAttribute(table_metadata(spec)));
    const Imf::PixelType type = options.half ? Imf::HALF : Imf::FLOAT;
    for (const Channel& channel : spec.channels)
      header.channels().insert(full_name(channel), Imf::Channel(type));
    if (!options.compress) {
      file.reserve(spec.cell_count() * spec.channels.size() *
                   (options.half ? sizeof(half) : sizeof(float)));
    }
    AtomicOStream stream(file);
    {
      Imf::OutputFile out(stream, header);
      if (options.half) {
        write_lines<half>(producer, out, type, name, options.workers);
      } else {
        write_lines<float>(producer, out, type, name, options.workers);
      }
    }
    stream.finish();
  } catch (const Iex::BaseExc& error) {
    throw WorkError(name + ": cannot write: " + error.what());
  }
}

// The spec of a file, once its header agrees with its description.
TableSpec read_spec(const Imf::InputFile& in, const std::string& name) {
  const Imf::Header& header = in.header();
  const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(kAttribute);
  if (attribute == nullptr) {
    throw InputError(name + ": no attribute '" + kAttribute +
                     "': this EXR picture is not a table of this program");
  }
  TableSpec spec = parse_table_metadata(attribute->value(), name + ": attribute 'clothbrdf'");
  const PictureSize size = picture_size(spec);
  const Imath::Box2i& window = header.dataWindow();
  if (window.min != Imath::V2i(0, 0) || static_cast<std::size_t>(window.max.x) + 1 != size.width ||
      static_cast<std::size_t>(window.max.y) + 1 != size.height) {
    throw InputError(name + ": the picture is not of the size of its grid " +
                     spec.grid().description());
  }
  std::size_t found = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
      throw InputError(name + ": channel " + one_line(c.name()) + " is subsampled");
    }
    ++found;
  }
  for (const Channel& channel : spec.channels) {
    if (header.channels().findChannel(full_name(channel)) == nullptr) {
      throw InputError(name + ": channel " + full_name(channel) + " is missing");
    }
  }
  if (found != spec.channels.size()) {
    throw InputError(name + ": " + std::to_string(found) + " channels; its description names " +
                     std::to_string(spec.channels.size()));
  }
  if (!in.isComplete()) throw InputError(name + ": the file is cut off");
  return spec;
}

Table read_exr(const std::filesystem::path& path) {
  const std::string name = path.string();
  require_readable(path);
  require_honest_exr_header(path);
  try {
    CountingIStream stream(path);
    Imf::InputFile in(stream);
    TableSpec spec = read_spec(in, name);
    const PictureSize size = picture_size(spec);
    // What the file cannot hold uncompressed is set aside as it is read.
    std::vector<double> values;
    values.reserve(std::min<std::size_t>(spec.cell_count() * spec.channels.size(),
                                         std::filesystem::file_size(path)));
    RowBuffer<float> buffer(spec, size, Imf::FLOAT);
    for (std::size_t row = 0; row < spec.row_count(); ++row) {
      const auto line = static_cast<int>(row * size.lines_per_row);
      in.setFrameBuffer(buffer.frame(row * size.lines_per_row));
      in.readPixels(line, line + static_cast<int>(size.lines_per_row) - 1);
      values.insert(values.end(), buffer.samples().begin(), buffer.samples().end());
    }
    if (stream.farthest() != std::filesystem::file_size(path)) {
      throw InputError(name + ": bytes follow the end of the picture");
    }
    std::vector<std::uint8_t> valid = cells_with_values(spec);
    const bool half = in.header().channels().begin().channel().type == Imf::HALF;
    mask_not_measured(spec, values, valid);
    return {std::move(spec), std::move(values), std::move(valid), exr_precision({.half = half})};
  } catch (const Iex::BaseExc& error) {
    throw InputError(name + ": cannot read: " + one_line(error.what(), 200));
  }
}

}  // namespace

Format exr_format() {
  return {.name = "EXR",
          .ending = ".exr",
          .summary = "any grid as a picture of floats, with a description that rebuilds the table",
          .options = kExrOptions,
          .default_samples = exr_samples,
          .colours = [](const WriteOptions&) { return Colours::kAny; },
          .keeps_description = true,
          .keeps_listed_nodes = true,
          .averages = "",
          .precision = exr_precision,
          .check = check_exr,
          .layout = own_samples,
          .write = write_exr,
          .read = read_exr};
}

}  // namespace clothbrdf
