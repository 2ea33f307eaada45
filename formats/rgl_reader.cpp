#include "formats/rgl_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/rgl_tensors.h"
#include "formats/square.h"
#include "formats/table_metadata.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

double degrees(double radians) { return radians * (180 / std::numbers::pi); }

DirectionPair angles_of(const Directions& d) {
  return {degrees(elevation(d.wi)), degrees(azimuth(d.wi)), degrees(elevation(d.wo)),
          degrees(azimuth(d.wo))};
}

std::vector<Channel> channels_of(const RglTensors& tensors) {
  if (tensors.wavelengths_nm().empty()) return rgb_channels();
  std::vector<Channel> channels;
  for (const float wavelength : tensors.wavelengths_nm()) {
    // The shortest number that is this float: 406.67, not 406.670013.
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), wavelength).ptr;
    double shortest = 0;
    std::from_chars(text.data(), end, shortest);
    channels.push_back({wavelength_name(shortest), Part::kTotal, channels.size()});
  }
  return channels;
}

// What a file of ours says of itself; nothing, of others.
std::optional<TableSpec> described(const TensorFile& file) {
  const std::string text = file.bytes(file.field("description"));
  const std::size_t line = text.find("\n{");
  if (line == std::string::npos || text.find(", by clothbrdf ") >= line) return std::nullopt;
  return parse_table_metadata(text.substr(line + 1), file.name() + ": field 'description'");
}

// Whether a file can have come from a table of these channels.
bool same_channels(std::span<const Channel> of_table, std::span<const Channel> of_file) {
  const auto same = [](const Channel& a, const Channel& b) {
    const std::optional<double> nm_a = named_wavelength(a.name);
    const std::optional<double> nm_b = named_wavelength(b.name);
    if (!nm_a || !nm_b) return a.part == b.part && a.name == b.name;
    return a.part == b.part && static_cast<float>(*nm_a) == static_cast<float>(*nm_b);
  };
  return std::equal(of_table.begin(), of_table.end(), of_file.begin(), of_file.end(), same);
}

// Packed bits, the first in the highest place; 1 where a node was measured.
std::vector<std::uint8_t> measured_nodes(const TensorFile& file, std::size_t count) {
  std::vector<std::uint8_t> measured(count, 1);
  const Tensor* field = file.find("valid");
  if (field == nullptr || field->type != TensorType::kUint8) return measured;
  if (field->count() != (count + 7) / 8) return measured;
  const std::string bits = file.bytes(*field);
  for (std::size_t k = 0; k < count; ++k) {
    const auto byte = static_cast<unsigned char>(bits[k / 8]);
    measured[k] = (byte >> (7 - k % 8)) & 1U;
  }
  return measured;
}

}  // namespace

Table read_rgl(const std::filesystem::path& path) {
  const TensorFile file(path);
  auto tensors = std::make_shared<const RglTensors>(file);
  const std::size_t nodes = tensors->node_count();
  const std::size_t channels = tensors->channels();
  PairList samples;
  samples.isotropic = tensors->isotropic();
  samples.pairs.reserve(nodes);
  std::vector<double> values(nodes * channels);
  std::vector<std::uint8_t> valid = measured_nodes(file, nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    const Directions node = tensors->node(k);
    samples.pairs.push_back(angles_of(node));
    if (!node.above_horizon()) {
      valid[k] = 0;
    } else if (valid[k] != 0) {
      tensors->node_values(k, node, std::span(values).subspan(k * channels, channels));
    }
  }
  TableSpec spec{std::move(samples), channels_of(*tensors), {}, {}};
  if (const std::optional<TableSpec> from = described(file)) {
    if (!same_channels(from->channels, spec.channels) || from->isotropic() != spec.isotropic()) {
      throw InputError(file.name() +
                       ": field 'description': its channels are not those of the values");
    }
    spec.channels = from->channels;
    spec.provenance = from->provenance;
  }
  constexpr StoredPrecision kFloats{0x1p-24, 0x1p-149};
  return {std::move(spec), std::move(values), std::move(valid), kFloats, std::move(tensors)};
}

}  // namespace clothbrdf
