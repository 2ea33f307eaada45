#include "formats/utia.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/errors.h"

namespace clothbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::size_t kThetas = 6;
constexpr std::size_t kPhis = 48;
constexpr std::size_t kColumns = kThetas * kPhis;
constexpr std::size_t kUtiaCells = kColumns * kColumns;
constexpr std::size_t kUtiaBytes = 3 * kUtiaCells * sizeof(double);

// f_r = kWhite * d(stored / kCodes), d with its straight part up to kStraight.
constexpr double kWhite = 100;
constexpr double kCodes = 140;
constexpr double kStraight = 0.0375;

double decode(double stored) {
  const double code = stored / kCodes;
  return kWhite * (code > kStraight ? std::pow((code + 0.055) / 1.055, 2.4) : code / 12.92);
}

// Readers in single precision round codes by 6e-8: those nearer to the bend than this could fall on
// its other side.
constexpr double kBendRounding = 1e-6;
constexpr double kBelowBend = kCodes * kStraight * (1 - kBendRounding);
constexpr double kAboveBend = kCodes * kStraight * (1 + kBendRounding);

double encode(double f_r) {
  const double light = f_r / kWhite;
  const double straight = kCodes * 12.92 * light;
  if (!(straight > kBelowBend)) return straight;
  const double power = kCodes * (1.055 * std::pow(light, 1 / 2.4) - 0.055);
  if (!(power < kAboveBend)) return power;
  // No code stands for what lies between the two parts of the curve.
  return f_r - decode(kBelowBend) < decode(kAboveBend) - f_r ? kBelowBend : kAboveBend;
}

using Function = double (*)(double);

double same(double value) { return value; }

// The two nodes around an angle and the share of the upper one; below 0 or above 1 where a line is
// continued.
struct Between {
  std::array<std::size_t, 2> node;
  double upper_share;
};

Between between_thetas(double theta_deg) {
  const double at = theta_deg / 15;
  const std::size_t lower = std::min(static_cast<std::size_t>(at), kThetas - 2);
  return {{lower, lower + 1}, at - static_cast<double>(lower)};
}

Between between_phis(const Vector3<double>& v) {
  double at = std::atan2(v[1], v[0]) / (2 * std::numbers::pi) * kPhis;
  if (at < 0) at += kPhis;
  const auto lower = static_cast<std::size_t>(at);
  return {{lower % kPhis, (lower + 1) % kPhis}, at - static_cast<double>(lower)};
}

double theta_deg(const Vector3<double>& v) {
  return std::atan2(std::hypot(v[0], v[1]), v[2]) * (180 / std::numbers::pi);
}

class UtiaInterpolant final : public Interpolant {
 public:
  UtiaInterpolant(std::vector<double> stored, Function decode)
      : stored_(std::move(stored)), decode_(decode) {}

  bool interpolate(const Directions& d, std::span<double> values) const override {
    const std::array<Between, 4> axes = {between_thetas(theta_deg(d.wi)), between_phis(d.wi),
                                         between_thetas(theta_deg(d.wo)), between_phis(d.wo)};
    std::fill(values.begin(), values.end(), 0.0);
    for (std::size_t corner = 0; corner < 16; ++corner) {
      double weight = 1;
      std::array<std::size_t, 4> node{};
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const std::size_t side = corner >> a & 1U;
        weight *= side == 1 ? axes[a].upper_share : 1 - axes[a].upper_share;
        node[a] = axes[a].node[side];
      }
      // A node that is not asked for must not matter, be it no number.
      if (weight == 0) continue;
      const std::size_t cell = ((node[0] * kPhis + node[1]) * kThetas + node[2]) * kPhis + node[3];
      for (std::size_t c = 0; c < values.size(); ++c) {
        values[c] += weight * stored_[c * kUtiaCells + cell];
      }
    }
    bool known = true;
    for (double& value : values) {
      value = decode_(value);
      known = known && std::isfinite(value);
      if (value < 0) value = 0;
    }
    if (!known) std::fill(values.begin(), values.end(), 0.0);
    return known;
  }
  std::string rule() const override {
    return decode_ == same
               ? "linear in theta and phi, beyond 75 degrees along the line from 60 to 75"
               : "linear in theta and phi of the sRGB codes, beyond 75 degrees along the line from "
                 "60 to 75";
  }

 private:
  std::vector<double> stored_;  // planes, as in the file
  Function decode_;
};

// No isotropic grid fits: check_utia refuses what stands for one here.
Samples utia_samples(Reflectance /*either*/, bool isotropic) {
  if (isotropic) return AnyPairs{true};
  return inout();
}

void check_utia(const TableSpec& spec, const WriteOptions& /*none*/, const std::string& name) {
  if (spec.has_grid() && spec.grid() == inout()) return;
  const std::string what = spec.isotropic() ? "an isotropic table" : spec.description();
  throw InputError(name + ": " + what + " is not allowed: UTIA holds the anisotropic grid " +
                   inout().description() + " only" +
                   (spec.isotropic() ? "; --grid inout asks for it" : ""));
}

template <Function kEncode>
void write_planes(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  file.reserve(kUtiaBytes);
  // values[row][channel][column]: the rows of one channel lie one after the other in the file.
  const auto prepare = [](std::size_t, std::span<double> values) {
    std::transform(values.begin(), values.end(), values.begin(), kEncode);
  };
  const auto write = [&](std::size_t first_row, std::span<double> values) {
    std::vector<std::span<const std::byte>> rows(values.size() / (3 * kColumns));
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t row = 0; row < rows.size(); ++row) {
        rows[row] = std::as_bytes(values.subspan((row * 3 + c) * kColumns, kColumns));
      }
      file.write_at((c * kUtiaCells + first_row * kColumns) * sizeof(double), rows);
    }
  };
  stream_rows(producer, options.workers, write, prepare);
}

std::vector<double> read_planes(const std::filesystem::path& path) {
  require_readable(path);
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  if (bytes != kUtiaBytes) {
    throw InputError(path.string() + ": " + std::to_string(bytes) + " bytes; a UTIA file has " +
                     std::to_string(kUtiaBytes));
  }
  std::vector<double> stored(3 * kUtiaCells);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(stored.data()), static_cast<std::streamsize>(kUtiaBytes));
  if (!in) throw InputError(path.string() + ": cannot be read");
  return stored;
}

Table table_of(std::vector<double> stored, Function decode, std::string note) {
  TableSpec spec{inout(), rgb_channels(), {}, {}};
  spec.provenance.note = std::move(note);
  std::vector<double> values(stored.size());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t cell = 0; cell < kUtiaCells; ++cell) {
      values[(cell / kColumns * 3 + c) * kColumns + cell % kColumns] =
          decode(stored[c * kUtiaCells + cell]);
    }
  }
  auto interpolant = std::make_shared<UtiaInterpolant>(std::move(stored), decode);
  return {std::move(spec), std::move(values), std::vector<std::uint8_t>(kUtiaCells, 1),
          StoredPrecision{}, std::move(interpolant)};
}

Table read_utia(const std::filesystem::path& path) {
  std::vector<double> stored = read_planes(path);
  const auto negative = std::count_if(stored.begin(), stored.end(), [](double v) { return v < 0; });
  for (double& v : stored) v = v < 0 ? 0 : v;
  return table_of(std::move(stored), decode,
                  negative == 0 ? "" : std::to_string(negative) + " negative codes: read as 0");
}

Table read_linear_utia(const std::filesystem::path& path) {
  return table_of(read_planes(path), same, "");
}

constexpr std::uint64_t kDigits14 = 100'000'000'000'000;

}  // namespace

Format utia_format() {
  return {.name = "UTIA",
          .ending = ".bin",
          .summary = "anisotropic 6x48x6x48 table of sRGB codes, as the UTIA database's",
          .options = {},
          .default_samples = utia_samples,
          .colours = [](const WriteOptions&) { return Colours::kRgb; },
          .keeps_description = false,
          .averages = "",
          .precision =
              [](const WriteOptions&) {
                return StoredPrecision{1.0 / kDigits14, 0};
              },
          .check = check_utia,
          .layout = own_samples,
          .write = write_planes<encode>,
          .read = read_utia};
}

Format linear_utia_format() {
  Format format = utia_format();
  format.name = "UTIA linear";
  format.ending = ".linear.bin";
  format.summary = "the same with plain f_r, as ALTA reads it";
  format.precision = [](const WriteOptions&) { return StoredPrecision{}; };
  format.write = write_planes<same>;
  format.read = read_linear_utia;
  return format;
}

}  // namespace clothbrdf
