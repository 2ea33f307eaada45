#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "table/producer.h"
#include "table/spectrum.h"

namespace clothbrdf {

/// Another producer's values with other channels, each a weighted sum of some of the source's.
///
/// A value below 0 in any of those, the mark of a cell that was not measured, makes all mixed
/// channels kNotMeasured. Other sums below 0, of colours that the new channels cannot show, become
/// 0: readers take a negative value for the mark, or reflect negative light.
class MixedChannels final : public Producer {
 public:
  /// Channel names[c] is the sum over s of weights[c][s] times the producer's channel sources[s];
  /// no one absorption value is its colour (kNoColour). Keeps a reference to the producer. Throws
  /// std::invalid_argument where sizes do not match.
  MixedChannels(const Producer& producer, const std::vector<std::string>& names,
                std::vector<std::size_t> sources, ChannelMatrix weights);

  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t first_row, std::span<double> values) const override;
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override;

 private:
  void mix(std::span<const double> from, std::size_t columns, std::span<double> to) const;

  const Producer& producer_;
  std::vector<std::size_t> sources_;
  ChannelMatrix weights_;
  TableSpec spec_;
};

/// Whether the totals are R, G and B, in any order.
bool has_rgb(const TableSpec& spec);

/// Whether the totals are all named after wavelengths, no two the same; at least one.
bool has_wavelengths(const TableSpec& spec);

/// R, G and B by rgb_weights, from totals named after wavelengths; components are left out. Throws
/// std::invalid_argument for others (has_wavelengths). Keeps a reference to the producer.
std::unique_ptr<Producer> to_rgb(const Producer& producer);

/// The spectrum by spectral_basis, from the totals R, G and B; components are left out. Throws
/// std::invalid_argument for others (has_rgb). Keeps a reference to the producer.
std::unique_ptr<Producer> to_spectrum(const Producer& producer);

}  // namespace clothbrdf
