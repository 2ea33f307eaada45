#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "table/table.h"

namespace clothbrdf {

/// f_r of scattered samples: that of the nearest valid one. Two pairs are as far apart as the
/// angles between their lights and between their eyes, added in squares; of isotropic samples once
/// the lights have the same azimuth and the eyes are on the same side of them.
class NearestSample final : public Interpolant {
 public:
  /// Farther than this, a list of samples says nothing, degrees.
  static constexpr double kFarthestDeg = 10;

  /// Copies what it needs. The spec has pairs; values[pair][channel].
  NearestSample(const TableSpec& spec, std::span<const double> values,
                std::span<const std::uint8_t> valid);
  ~NearestSample() override;

  bool interpolate(const Directions& directions, std::span<double> values) const override;
  bool complete() const override { return false; }
  std::string rule() const override;

 private:
  struct Index;
  std::unique_ptr<const Index> index_;
};

}  // namespace clothbrdf
