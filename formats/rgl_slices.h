#pragma once

#include <span>
#include <vector>

#include "formats/rgl_distribution.h"
#include "formats/rgl_layout.h"
#include "table/producer.h"

namespace clothbrdf {

/// The slices of one azimuth of the eye.
struct RglColumn {
  std::vector<float> densities;  ///< of half vectors, [theta][row][column]
  std::vector<float> luminance;  ///< for sampling, [theta][row][column]
  std::vector<float> values;     ///< [theta][channel][row][column]
};

/// Computes the slices of a file.
class RglSlices {
 public:
  /// Keeps references to the producer and the layout.
  RglSlices(const Producer& producer, const RglLayout& layout, Workers workers);

  const RglDistribution& distribution() const { return distribution_; }

  /// All slices of an azimuth, by the workers. Values are prefiltered (rgl_prefilter.h) along all
  /// axes but the eye's azimuth. Throws Cancelled.
  RglColumn column(std::size_t phi) const;

 private:
  struct Nodes;
  Nodes place_nodes(std::size_t phi, std::size_t theta, std::span<float> densities) const;
  void fill_slice(std::size_t phi, std::size_t theta, RglColumn& column) const;
  void fill_luminance(const Nodes& nodes, std::span<const double> f, std::span<float> wanted) const;

  const Producer& producer_;
  const RglLayout& layout_;
  Workers workers_;
  std::vector<double> luminance_weights_;  // of each channel
  RglDistribution distribution_;
};

}  // namespace clothbrdf
