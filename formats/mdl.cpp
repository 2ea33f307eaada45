#include "formats/mdl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "formats/mdl_read.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::string_view kMdlOptions[] = {"--size"};

// The SDK counts nodes in 32 bits: n * n * 2 n must stay below 2^32.
constexpr std::uint64_t kLargestSize = 1289;
constexpr std::uint64_t kUsualSize = 45;
constexpr std::uint64_t kSmallestSize = 2;

std::uint64_t node_count(std::uint64_t n) { return n * n * 2 * n; }

// Escaped as the specification has it.
std::string quoted_line(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' ? "\\n" : std::string(1, c);
  }
  return result + "\"";
}

std::string header_text(const TableSpec& spec) {
  std::string text = kMdlMagic;
  if (!spec.provenance.program.empty()) {
    text += "program=" + quoted_line(spec.provenance.program) + "\n";
  }
  text += "values=\"f_r, mean over rotations and both orders of the directions\"\n";
  return text + kMdlReflection;
}

std::uint64_t file_bytes(const TableSpec& spec, std::uint64_t n) {
  return header_text(spec).size() + 3 * sizeof(std::uint32_t) + node_count(n) * 3 * sizeof(float);
}

// n_theta; n_phi is twice as much.
std::uint64_t size_for(const TableSpec& spec, const WriteOptions& options) {
  if (!options.bytes) return kUsualSize;
  std::uint64_t n = kSmallestSize;
  while (n < kLargestSize && file_bytes(spec, n + 1) <= *options.bytes) ++n;
  return n;
}

// The producer answers any pairs whatever --isotropic says: there is nothing else to hold.
Samples mdl_samples(Reflectance /*either*/, bool /*always isotropic*/) { return AnyPairs{true}; }

void check_mdl(const TableSpec& spec, const WriteOptions& options, const std::string& name) {
  if (spec.has_grid() || spec.has_pairs()) {
    throw InputError(name + ": " + spec.description() +
                     " is not allowed: MDL has nodes of its own; leave out --grid");
  }
  if (!spec.isotropic()) {
    throw InputError(name + ": MDL holds isotropic tables only");
  }
  if (options.bytes && *options.bytes < file_bytes(spec, kSmallestSize)) {
    throw InputError(name + ": --size: " + std::to_string(*options.bytes) +
                     " bytes are not allowed: the smallest MDL file has " +
                     std::to_string(file_bytes(spec, kSmallestSize)));
  }
}

Layout mdl_layout(const TableSpec& spec, const WriteOptions& options) {
  const std::uint64_t n = size_for(spec, options);
  return {std::to_string(n) + "x" + std::to_string(n) + "x" + std::to_string(2 * n), node_count(n)};
}

// The four pairs that a node stands for: both orders, and their mirror images.
constexpr std::size_t kPairsOfNode = 4;

std::array<Directions, kPairsOfNode> pairs_of_node(const DirectionPair& pair) {
  const Vector3<double> i = direction(pair.theta_i, 0.0);
  const Vector3<double> o = direction(pair.theta_o, 0.0);
  const auto at = [&](const Vector3<double>& v) { return turned(v, sincosd(pair.phi_o)); };
  return {Directions{i, at(o)}, Directions{at(i), o}, Directions{o, at(i)}, Directions{at(o), i}};
}

float as_float(double value, const std::string& channel, const DirectionPair& pair,
               const std::string& name) {
  if (std::abs(value) <= std::numeric_limits<float>::max() || !std::isfinite(value)) {
    return static_cast<float>(value);
  }
  throw WorkError(name + ": " + channel + " is " + number_text(value) + " at theta_i " +
                  number_text(pair.theta_i) + " theta_o " + number_text(pair.theta_o) + " phi " +
                  number_text(pair.phi_o) + ", beyond the largest 32-bit float");
}

// theta_i and theta_o of two rows of nodes, which hold the same values.
struct RowPair {
  std::size_t i;
  std::size_t o;
};

void write_mdl(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  constexpr std::size_t kNodesOfBlock = 32768;
  const TableSpec& spec = producer.spec();
  const std::size_t channels = spec.channels.size();
  const auto n = static_cast<std::uint32_t>(size_for(spec, options));
  const MdlSizes sizes = {1, n, 2 * n};
  file.reserve(file_bytes(spec, n));
  const std::string header = header_text(spec);
  file.write_at(0, std::as_bytes(std::span(header)));
  file.write_at(header.size(), std::as_bytes(std::span(&sizes, 1)));

  const std::size_t rows_of_block = std::max<std::size_t>(1, kNodesOfBlock / sizes.phi);
  std::vector<RowPair> rows;
  std::vector<Directions> pairs;
  std::vector<double> values;
  std::vector<float> stored(sizes.phi * channels);
  const auto first_node = [&](std::size_t i, std::size_t o) { return (i * n + o) * sizes.phi; };
  const auto write_row = [&](std::size_t i, std::size_t o) {
    file.write_at(header.size() + sizeof sizes + first_node(i, o) * channels * sizeof(float),
                  std::as_bytes(std::span(stored)));
  };
  const auto write_rows = [&] {
    pairs.clear();
    for (const RowPair& row : rows) {
      for (std::size_t phi = 0; phi < sizes.phi; ++phi) {
        const auto of_node = pairs_of_node(sizes.pair(first_node(row.i, row.o) + phi));
        pairs.insert(pairs.end(), of_node.begin(), of_node.end());
      }
    }
    values.resize(pairs.size() * channels);
    fill_all_pairs(producer, options.workers, pairs, values);
    std::span<const double> left = values;
    for (const RowPair& row : rows) {
      for (std::size_t k = 0; k < stored.size(); ++k) {
        const std::size_t phi = k / channels;
        const std::size_t c = k % channels;
        const std::span<const double> node = left.subspan(phi * kPairsOfNode * channels + c);
        double sum = 0;
        for (std::size_t p = 0; p < kPairsOfNode; ++p) sum += node[p * channels];
        stored[k] = as_float(sum / kPairsOfNode, spec.channels[c].name,
                             sizes.pair(first_node(row.i, row.o) + phi), file.name().string());
      }
      left = left.subspan(sizes.phi * kPairsOfNode * channels);
      write_row(row.i, row.o);
      if (row.i != row.o) write_row(row.o, row.i);
      options.workers.advance(row.i == row.o ? sizes.phi : std::size_t{2} * sizes.phi);
    }
    rows.clear();
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t o = i; o < n; ++o) {
      rows.push_back({i, o});
      if (rows.size() == rows_of_block) write_rows();
    }
  }
  write_rows();
}

}  // namespace

Format mdl_format() {
  return {.name = "MDL",
          .ending = ".mbsdf",
          .summary = "isotropic table of NVIDIA's MDL, floats; the mean over phi_h",
          .options = kMdlOptions,
          .default_samples = mdl_samples,
          .colours = [](const WriteOptions&) { return Colours::kRgb; },
          .keeps_description = false,
          .averages = "",
          .precision =
              [](const WriteOptions&) {
                return StoredPrecision{0x1p-24, 0x1p-149, std::numeric_limits<float>::max(), 4};
              },
          .check = check_mdl,
          .layout = mdl_layout,
          .write = write_mdl,
          .read = read_mdl};
}

}  // namespace clothbrdf
