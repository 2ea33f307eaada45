#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "formats/direction_rule.h"

namespace clothbrdf {

// Internal to formats/.

/// One patch of a Klems basis: directions between two elevations and two azimuths, degrees.
struct KlemsPatch {
  double theta_low;
  double theta_high;
  double phi_low;
  double phi_high;

  /// Means over the patch, each direction weighted with its projected solid angle: `nodes` along
  /// theta and along phi.
  DirectionRule rule(std::size_t nodes) const;
  std::array<KlemsPatch, 4> quarters() const;
  double measure() const;  ///< projected solid angle, sr
};

/// The directions of a hemisphere in bands of theta, cut into patches whose first is centred at phi
/// = 0 (Klems 1994). Patches are counted by bands from the normal, by phi within a band.
class KlemsBasis {
 public:
  struct Band {
    double theta_high;  ///< degrees; begins where the last one ends
    std::size_t patches;
  };

  /// LBNL/Klems Full, 145 patches.
  static const KlemsBasis& full();
  /// By its name in files, in any case: LBNL/Klems Full, Half or Quarter; null for others.
  static const KlemsBasis* find(std::string_view name);

  std::string_view name() const { return name_; }
  std::span<const Band> bands() const { return bands_; }
  std::size_t size() const;  ///< patches
  KlemsPatch patch(std::size_t index) const;
  /// The patch that holds a direction above the horizon: a border of theta belongs to the upper
  /// band, one of phi to the next patch.
  std::size_t index_of(const Vector3<double>& direction) const;

 private:
  KlemsBasis(std::string_view name, std::span<const Band> bands) : name_(name), bands_(bands) {}
  static const std::array<KlemsBasis, 3>& all();

  std::string_view name_;
  std::span<const Band> bands_;
};

}  // namespace clothbrdf
