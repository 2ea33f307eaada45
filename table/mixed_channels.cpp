#include "table/mixed_channels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "table/table.h"

namespace clothbrdf {
namespace {

constexpr const char* kRgbNames[] = {"R", "G", "B"};

// Pairs and rows are mixed in pieces of about so many source values, which stay in the cache.
constexpr std::size_t kPieceValues = 8192;

std::vector<std::size_t> totals(const TableSpec& spec) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < spec.channels.size(); ++c) {
    if (spec.channels[c].part == Part::kTotal) found.push_back(c);
  }
  return found;
}

// Indices of R, G and B; none where the totals are others.
std::optional<std::vector<std::size_t>> rgb_sources(const TableSpec& spec) {
  const std::vector<std::size_t> all = totals(spec);
  std::vector<std::size_t> found;
  for (const char* name : kRgbNames) {
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](std::size_t c) { return spec.channels[c].name == name; });
    if (at == all.end()) return std::nullopt;
    found.push_back(*at);
  }
  if (all.size() != found.size()) return std::nullopt;
  return found;
}

struct Wavelength {
  double nm;
  std::size_t channel;
};

// Ascending, whatever the order of the channels; none where the totals are others.
std::optional<std::vector<Wavelength>> wavelength_sources(const TableSpec& spec) {
  std::vector<Wavelength> found;
  for (const std::size_t c : totals(spec)) {
    const std::optional<double> nm = named_wavelength(spec.channels[c].name);
    if (!nm || !std::isfinite(*nm)) return std::nullopt;
    found.push_back({*nm, c});
  }
  if (found.empty()) return std::nullopt;
  std::sort(found.begin(), found.end(),
            [](const Wavelength& a, const Wavelength& b) { return a.nm < b.nm; });
  const auto same =
      std::adjacent_find(found.begin(), found.end(),
                         [](const Wavelength& a, const Wavelength& b) { return a.nm == b.nm; });
  if (same != found.end()) return std::nullopt;
  return found;
}

}  // namespace

MixedChannels::MixedChannels(const Producer& producer, const std::vector<std::string>& names,
                             std::vector<std::size_t> sources, ChannelMatrix weights)
    : producer_(producer),
      sources_(std::move(sources)),
      weights_(std::move(weights)),
      spec_(producer.spec()) {
  bool sizes_match = names.size() == weights_.size();
  for (const std::vector<double>& row : weights_) {
    sizes_match = sizes_match && row.size() == sources_.size();
  }
  for (const std::size_t source : sources_) {
    sizes_match = sizes_match && source < spec_.channels.size();
  }
  if (!sizes_match) throw std::invalid_argument("channel weights do not match the channels");
  spec_.channels.clear();
  for (const std::string& name : names) spec_.channels.push_back({name, Part::kTotal, kNoColour});
}

void MixedChannels::fill_rows(std::size_t first_row, std::span<double> values) const {
  const std::size_t row_values = producer_.spec().row_values();
  const std::size_t rows_of_piece = std::max<std::size_t>(1, kPieceValues / row_values);
  std::vector<double> from;
  while (!values.empty()) {
    const std::size_t rows = std::min(rows_of_piece, values.size() / spec_.row_values());
    from.resize(rows * row_values);
    producer_.fill_rows(first_row, from);
    mix(from, spec_.column_count(), values.first(rows * spec_.row_values()));
    first_row += rows;
    values = values.subspan(rows * spec_.row_values());
  }
}

void MixedChannels::fill_pairs(std::span<const Directions> pairs, std::span<double> values) const {
  const std::size_t channels = producer_.spec().channels.size();
  const std::size_t pairs_of_piece = std::max<std::size_t>(1, kPieceValues / channels);
  std::vector<double> from;
  while (!pairs.empty()) {
    const std::size_t count = std::min(pairs_of_piece, pairs.size());
    from.resize(count * channels);
    producer_.fill_pairs(pairs.first(count), from);
    mix(from, 1, values.first(count * weights_.size()));
    pairs = pairs.subspan(count);
    values = values.subspan(count * weights_.size());
  }
}

void MixedChannels::mix(std::span<const double> from, std::size_t columns,
                        std::span<double> to) const {
  const std::size_t from_size = producer_.spec().channels.size() * columns;
  const std::size_t to_size = weights_.size() * columns;
  for (std::size_t row = 0; row * from_size < from.size(); ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const double* const source = from.data() + row * from_size + column;
      double* const mixed = to.data() + row * to_size + column;
      bool measured = true;
      for (const std::size_t s : sources_) measured = measured && !(source[s * columns] < 0);
      for (std::size_t c = 0; c < weights_.size(); ++c) {
        double sum = 0;
        for (std::size_t s = 0; s < sources_.size(); ++s) {
          sum += weights_[c][s] * source[sources_[s] * columns];
        }
        // Not std::max, which makes 0 of what is not a number.
        mixed[c * columns] = !measured ? kNotMeasured : sum < 0 ? 0 : sum;
      }
    }
  }
}

bool has_rgb(const TableSpec& spec) { return rgb_sources(spec).has_value(); }

bool has_wavelengths(const TableSpec& spec) { return wavelength_sources(spec).has_value(); }

std::unique_ptr<Producer> to_rgb(const Producer& producer) {
  const auto wavelengths = wavelength_sources(producer.spec());
  if (!wavelengths) throw std::invalid_argument("RGB is made of channels named after wavelengths");
  std::vector<double> nm;
  std::vector<std::size_t> sources;
  for (const Wavelength& wavelength : *wavelengths) {
    nm.push_back(wavelength.nm);
    sources.push_back(wavelength.channel);
  }
  return std::make_unique<MixedChannels>(
      producer, std::vector<std::string>(std::begin(kRgbNames), std::end(kRgbNames)),
      std::move(sources), rgb_weights(nm));
}

std::unique_ptr<Producer> to_spectrum(const Producer& producer) {
  auto sources = rgb_sources(producer.spec());
  if (!sources) throw std::invalid_argument("a spectrum is made of channels R, G and B");
  std::vector<std::string> names;
  for (const double nm : spectrum_wavelengths_nm()) names.push_back(wavelength_name(nm));
  return std::make_unique<MixedChannels>(producer, names, *std::move(sources), spectral_basis());
}

}  // namespace clothbrdf
