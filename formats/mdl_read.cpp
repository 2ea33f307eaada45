#include "formats/mdl_read.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/file_bytes.h"
#include "formats/format_colours.h"
#include "formats/json_text.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr std::string_view kTransmission = "MBSDF_DATA_TRANSMISSION=";

// What is left of a file, from the front.
class Cursor {
 public:
  Cursor(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  bool at_end() const { return bytes_.empty(); }

  // Without its newline.
  std::string_view line() {
    const std::size_t end = bytes_.find('\n');
    if (end == std::string_view::npos) fail("the file is cut off: a line has no end");
    const std::string_view text = bytes_.substr(0, end);
    bytes_.remove_prefix(end + 1);
    return text;
  }

  MdlSizes sizes() {
    MdlSizes sizes;
    if (bytes_.size() < sizeof sizes) fail("the file is cut off before its sizes");
    std::memcpy(&sizes, bytes_.data(), sizeof sizes);
    bytes_.remove_prefix(sizeof sizes);
    if (sizes.type > 1) {
      fail("type " + std::to_string(sizes.type) + " of data; 0 and 1 are allowed");
    }
    if (sizes.theta == 0 || sizes.phi == 0) {
      fail(std::to_string(sizes.theta) + " x " + std::to_string(sizes.theta) + " x " +
           std::to_string(sizes.phi) + " nodes; at least one is needed each way");
    }
    return sizes;
  }

  // The numbers of a block, none where there are too few bytes for them.
  std::string_view numbers(const MdlSizes& sizes) {
    const std::size_t of_node = sizeof(float) * (sizes.type == 1 ? 3 : 1);
    // Divisions: a product of sizes that a file claims may wrap around.
    if (bytes_.size() / of_node / sizes.theta / sizes.theta < sizes.phi) {
      fail("the file is too short for " + std::to_string(sizes.theta) + " x " +
           std::to_string(sizes.theta) + " x " + std::to_string(sizes.phi) + " nodes");
    }
    const std::size_t count = sizes.node_count() * of_node;
    const std::string_view numbers = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return numbers;
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

 private:
  std::string_view bytes_;
  std::string name_;
};

// The lower node, clamped, and the share of the next one.
struct NodePair {
  std::size_t lower;
  std::size_t upper;
  double upper_share;
};

NodePair node_pair(double share_of_range, std::uint32_t size) {
  const double at = std::clamp(share_of_range * size - 0.5, 0.0, size - 1.0);
  const auto lower = static_cast<std::size_t>(at);
  return {lower, std::min(lower + 1, std::size_t{size} - 1), at - std::floor(at)};
}

class MdlInterpolant final : public Interpolant {
 public:
  MdlInterpolant(const MdlSizes& sizes, std::vector<float> values)
      : sizes_(sizes), values_(std::move(values)) {}

  bool interpolate(const Directions& d, std::span<double> values) const override {
    const NodePair i = node_pair(elevation(d.wi), sizes_.theta);
    const NodePair o = node_pair(elevation(d.wo), sizes_.theta);
    const NodePair phi = node_pair(azimuth_between(d), sizes_.phi);
    std::fill(values.begin(), values.end(), 0.0);
    bool known = true;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const bool upper_i = (corner & 4U) != 0;
      const bool upper_o = (corner & 2U) != 0;
      const bool upper_phi = (corner & 1U) != 0;
      const double weight = (upper_i ? i.upper_share : 1 - i.upper_share) *
                            (upper_o ? o.upper_share : 1 - o.upper_share) *
                            (upper_phi ? phi.upper_share : 1 - phi.upper_share);
      if (weight == 0) continue;
      const std::size_t node =
          ((upper_i ? i.upper : i.lower) * sizes_.theta + (upper_o ? o.upper : o.lower)) *
              sizes_.phi +
          (upper_phi ? phi.upper : phi.lower);
      for (std::size_t c = 0; c < values.size(); ++c) {
        const double value = values_[node * values.size() + c];
        known = known && std::isfinite(value);
        values[c] += weight * value;
      }
    }
    if (!known) std::fill(values.begin(), values.end(), 0.0);
    return known;
  }
  std::string rule() const override {
    return "linear in theta_i, theta_o and phi, constant beyond the outermost nodes";
  }

 private:
  // Shares of the ranges.
  static double elevation(const Vector3<double>& v) {
    return std::atan2(std::hypot(v[0], v[1]), v[2]) * (2 / std::numbers::pi);
  }
  static double azimuth_between(const Directions& d) {
    const double along = d.wi[0] * d.wo[0] + d.wi[1] * d.wo[1];
    const double across = d.wi[0] * d.wo[1] - d.wi[1] * d.wo[0];
    return std::atan2(std::abs(across), along) / std::numbers::pi;
  }

  MdlSizes sizes_;
  std::vector<float> values_;
};

// What readers make of f(i, o) and f(o, i); says whether they differed.
bool take_mean_of_orders(const MdlSizes& sizes, std::vector<float>& values) {
  const std::size_t row = values.size() / sizes.theta / sizes.theta;
  bool differed = false;
  for (std::size_t i = 0; i < sizes.theta; ++i) {
    for (std::size_t o = i + 1; o < sizes.theta; ++o) {
      for (std::size_t k = 0; k < row; ++k) {
        float& a = values[(i * sizes.theta + o) * row + k];
        float& b = values[(o * sizes.theta + i) * row + k];
        differed = differed || a != b;
        a = b = static_cast<float>((double{a} + double{b}) / 2);
      }
    }
  }
  return differed;
}

// Lines key="value" up to the line before the data, which is returned.
std::string_view read_keys(Cursor& cursor, std::string& note) {
  while (true) {
    const std::string_view line = cursor.line();
    if (line == "MBSDF_DATA=" || line == "MBSDF_DATA_REFLECTION=" || line == kTransmission) {
      return line;
    }
    const std::size_t equals = line.find("=\"");
    if (equals == std::string_view::npos || equals == 0 || !line.ends_with('"') ||
        line.size() < equals + 3) {
      cursor.fail("'" + one_line(line) + "' is no line of the header: key=\"value\" is allowed");
    }
    add_note(note, one_line(line, 200));
  }
}

}  // namespace

DirectionPair MdlSizes::pair(std::size_t node) const {
  const auto middle = [](std::size_t k, std::uint32_t size, double range_deg) {
    return range_deg * (static_cast<double>(k) + 0.5) / size;
  };
  return {middle(node / phi / theta, theta, 90), 0, middle(node / phi % theta, theta, 90),
          middle(node % phi, phi, 180)};
}

Table read_mdl(const std::filesystem::path& path) {
  const std::string bytes = file_bytes(path);
  Cursor cursor(bytes, path.string());
  if (!bytes.starts_with(kMdlMagic)) {
    cursor.fail("the first line is not 'NVIDIA ARC MBSDF V1': this is no MDL file");
  }
  cursor.line();
  std::string note;
  if (read_keys(cursor, note) == kTransmission) {
    cursor.fail("holds transmission only; reflection is needed");
  }
  const MdlSizes sizes = cursor.sizes();
  const std::string_view numbers = cursor.numbers(sizes);
  if (!cursor.at_end()) {
    if (cursor.line() != kTransmission) cursor.fail("bytes follow the last number");
    cursor.numbers(cursor.sizes());
    if (!cursor.at_end()) cursor.fail("bytes follow the last number");
    add_note(note, "its block of transmission was left out");
  }
  std::vector<float> stored(numbers.size() / sizeof(float));
  std::memcpy(stored.data(), numbers.data(), numbers.size());
  if (take_mean_of_orders(sizes, stored)) {
    add_note(note, "values of both orders of the directions differ: their mean was taken");
  }
  PairList list{{}, true};
  list.pairs.reserve(sizes.node_count());
  for (std::size_t node = 0; node < sizes.node_count(); ++node) {
    list.pairs.push_back(sizes.pair(node));
  }
  TableSpec spec{std::move(list), rgb_channels(), {}, {}};
  if (sizes.type == 0) spec.channels = {{kMono, Part::kTotal, 0}};
  spec.provenance.note = std::move(note);
  std::vector<double> values(stored.begin(), stored.end());
  std::vector<std::uint8_t> valid(sizes.node_count(), 1);
  auto interpolant = std::make_shared<MdlInterpolant>(sizes, std::move(stored));
  return {std::move(spec), std::move(values), std::move(valid),
          StoredPrecision{0x1p-24, 0x1p-149, std::numeric_limits<float>::max(), 4},
          std::move(interpolant)};
}

}  // namespace clothbrdf
