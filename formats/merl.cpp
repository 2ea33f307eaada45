#include "formats/merl.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "support/errors.h"

namespace clothbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::array<std::int32_t, 3> kSizes = {90, 90, 180};
constexpr std::uint64_t kHeaderBytes = sizeof kSizes;
constexpr std::uint64_t kMerlCells = 90ULL * 90 * 180;
constexpr std::uint64_t kMerlBytes = kHeaderBytes + 3 * kMerlCells * sizeof(double);

// Stored value = f_r * kStored.
constexpr std::array<double, 3> kStored = {1500.0, 1500.0 / 1.15, 1500.0 / 1.66};

// Both conventions are folded to 180 degrees.
Samples merl_samples(Reflectance /*either*/, bool /*always isotropic*/) { return halfdiff3d(); }

void check_merl(const TableSpec& spec, const WriteOptions& /*none*/, const std::string& name) {
  if (!spec.has_grid() || spec.grid() != halfdiff3d()) {
    throw InputError(name + ": the grid " + spec.description() + " is not allowed: MERL holds " +
                     halfdiff3d().description() + " only");
  }
}

void write_merl(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  const TableSpec& spec = producer.spec();
  file.reserve(kMerlBytes);
  file.write_at(0, std::as_bytes(std::span(kSizes)));
  const std::size_t columns = spec.column_count();
  // values[row][channel][column]: the rows of one channel lie one after the other in the file.
  const auto row_of = [&](std::span<double> values, std::size_t row, std::size_t channel) {
    return values.subspan((row * 3 + channel) * columns, columns);
  };
  const auto scale = [&](std::size_t, std::span<double> values) {
    for (std::size_t row = 0; row < values.size() / spec.row_values(); ++row) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (double& value : row_of(values, row, c)) value *= kStored[c];
      }
    }
  };
  const auto write = [&](std::size_t first_row, std::span<double> values) {
    std::vector<std::span<const std::byte>> rows(values.size() / spec.row_values());
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t row = 0; row < rows.size(); ++row)
        rows[row] = std::as_bytes(row_of(values, row, c));
      file.write_at(kHeaderBytes + (c * kMerlCells + first_row * columns) * sizeof(double), rows);
    }
  };
  stream_rows(producer, options.workers, write, scale);
}

Table read_merl(const std::filesystem::path& path) {
  require_readable(path);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto bytes = static_cast<std::uint64_t>(in.tellg());
  if (bytes < kHeaderBytes) {
    throw InputError(path.string() + ": " + std::to_string(bytes) +
                     " bytes are too few for a MERL header");
  }
  std::array<std::int32_t, 3> sizes{};
  in.seekg(0);
  in.read(reinterpret_cast<char*>(sizes.data()), sizeof sizes);
  if (sizes != kSizes) {
    throw InputError(path.string() + ": header says " + std::to_string(sizes[0]) + " x " +
                     std::to_string(sizes[1]) + " x " + std::to_string(sizes[2]) +
                     " cells; a MERL file has 90 x 90 x 180");
  }
  if (bytes != kMerlBytes) {
    throw InputError(path.string() + ": " + std::to_string(bytes) + " bytes; a MERL file has " +
                     std::to_string(kMerlBytes));
  }
  TableSpec spec{halfdiff3d(), rgb_channels(), {}, {}};
  std::vector<double> values(3 * kMerlCells);
  std::vector<std::uint8_t> valid = spec.grid().above_horizon(CellPart::kAny);
  const std::vector<std::uint8_t> nodes = spec.grid().above_horizon(CellPart::kNode);
  std::vector<std::uint8_t> all_zero(kMerlCells, 1);
  std::vector<double> plane(kMerlCells);
  const std::size_t columns = spec.column_count();
  for (std::size_t c = 0; c < 3; ++c) {
    in.read(reinterpret_cast<char*>(plane.data()),
            static_cast<std::streamsize>(kMerlCells * sizeof(double)));
    if (!in) throw InputError(path.string() + ": cannot read channel " + rgb_channels()[c].name);
    for (std::size_t cell = 0; cell < kMerlCells; ++cell) {
      values[(cell / columns * 3 + c) * columns + cell % columns] = plane[cell] / kStored[c];
      if (plane[cell] != 0) all_zero[cell] = 0;
    }
  }
  // Point values are 0 where the cell's centre is below the horizon: nothing was said of them.
  for (std::size_t cell = 0; cell < kMerlCells; ++cell) {
    if (all_zero[cell] != 0 && nodes[cell] == 0) valid[cell] = 0;
  }
  mask_not_measured(spec, values, valid);
  return {std::move(spec), std::move(values), std::move(valid)};
}

}  // namespace

Format merl_format() {
  return {.name = "MERL",
          .ending = ".binary",
          .summary = "isotropic 90x90x180 table of doubles; the mean over phi_h",
          .options = {},
          .default_samples = merl_samples,
          .colours = [](const WriteOptions&) { return Colours::kRgb; },
          .keeps_description = false,
          .averages = "",
          .precision = [](const WriteOptions&) { return StoredPrecision{}; },
          .reader = Reader::kNearest,
          .check = check_merl,
          .layout = own_samples,
          .write = write_merl,
          .read = read_merl};
}

}  // namespace clothbrdf
