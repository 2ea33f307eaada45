#pragma once

#include <span>
#include <vector>

#include "formats/rgl_layout.h"
#include "table/producer.h"

namespace clothbrdf {

/// The slices of one azimuth of the eye.
struct RglColumn {
  std::vector<float> densities;  ///< of half vectors, [theta][row][column]
  std::vector<float> luminance;  ///< [theta][row][column]
  std::vector<float> values;     ///< [theta][channel][row][column]
};

/// What a file holds beside nodes, made to suit readers' interpolation: any positive half-vector
/// distribution, projected area and densities give the right f_r at the nodes, so these are chosen
/// for what is left to interpolate.
class RglSlices {
 public:
  /// Estimates the half-vector distribution from the producer. Keeps references.
  RglSlices(const Producer& producer, const RglLayout& layout, Workers workers);

  /// D over half vectors, [phi][theta]: the mean of 4 f_r cos(theta_i) cos(theta_o) over the pairs
  /// of a half vector. It carries narrow lobes, which readers put back exactly.
  const std::vector<float>& ndf() const { return ndf_; }
  /// The projected area, [row][theta of the eye].
  const std::vector<float>& sigma() const { return sigma_; }

  /// All slices of an azimuth, by the workers; values are those at the nodes, prefiltered along all
  /// axes but the eye's azimuth. Throws Cancelled.
  RglColumn column(std::size_t phi) const;

 private:
  void fill_slice(std::size_t phi, std::size_t theta, RglColumn& column) const;

  const Producer& producer_;
  const RglLayout& layout_;
  Workers workers_;
  std::vector<double> luminance_weights_;  // of each channel
  std::vector<float> ndf_;
  std::vector<float> sigma_;
};

}  // namespace clothbrdf
