#pragma once

#include <memory>
#include <vector>

#include "formats/tensor_file.h"
#include "formats/warp.h"
#include "table/table.h"

namespace clothbrdf {

/// What an RGL file says, and the rule that readers follow.
///
/// Table direction: to the eye, elevation theta_i and azimuth phi_i in the file's words. f_r times
/// the cosine of the light = values(u) ndf(u_m) / (4 sigma(u_i)), where u_m stands for the half
/// vector, u_i for the table direction, and u is where the file's densities take u_m; linear
/// between nodes in every axis, and clamped. Azimuths of isotropic files are counted from the table
/// direction's.
class RglTensors final : public Interpolant {
 public:
  /// Throws InputError where a field is missing, of the wrong shape, or no axis or density.
  explicit RglTensors(const TensorFile& file);

  bool interpolate(const Directions& directions, std::span<double> values) const override;
  std::string rule() const override;

  std::size_t channels() const { return channels_; }
  bool isotropic() const { return phi_i_.size() <= 2; }
  /// nm; empty: R, G and B.
  const std::vector<float>& wavelengths_nm() const { return wavelengths_nm_; }

  /// Nodes, [phi][theta][row][column].
  std::size_t node_count() const { return node_count_; }
  /// Light and eye of a node, as the readers place it; the light may be below the horizon.
  Directions node(std::size_t index) const;
  /// f_r of each channel at a node whose light is above the horizon.
  void node_values(std::size_t index, const Directions& node, std::span<double> values) const;

 private:
  struct Grid2d {
    std::vector<float> values;
    std::size_t rows;
    std::size_t columns;
  };
  static Grid2d read_grid(const TensorFile& file, const std::string& name);
  void read_axes(const TensorFile& file);
  Warp read_warp(const TensorFile& file) const;
  void read_values(const TensorFile& file);
  Directions folded(const Directions& directions) const;
  /// What values are to be multiplied by.
  double scale(RglPoint u_m, const Directions& directions) const;
  RglPoint half_vector_point(const Directions& directions) const;

  std::vector<float> phi_i_;
  std::vector<float> theta_i_;
  int symmetry_ = 1;  // parts of the circle that are one: 1, 2 (turned) or 4 (mirrored)
  bool scaled_ = true;
  Grid2d ndf_;
  Grid2d sigma_;
  Warp warp_;
  std::vector<float> wavelengths_nm_;
  std::size_t channels_ = 0;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  std::size_t node_count_ = 0;
  std::vector<float> values_;  // [phi][theta][channel][row][column]
};

}  // namespace clothbrdf
