#pragma once

#include <vector>

#include "model/reflectance.h"
#include "table/interval.h"

namespace clothbrdf {

/// Consecutive lobes of a yarn's internal light, j from `first` to `last`, that are nearly the
/// same: bounds of a sum over them take their densities as one.
struct LobeGroup {
  std::size_t first;
  std::size_t last;
  LobeAxes<double> narrowest;  ///< of all of them, along and across each
  LobeAxes<double> widest;
  Interval norm;

  /// Of lobe_height per h_n and norm, at slopes of the half vector along and across the yarn.
  Interval density(const Interval& along, const Interval& across, const Interval& slope2) const;
  /// Of its mean over the azimuth of the half vector.
  Interval mean_density(const Interval& slope2) const;
};

/// The surface reflection's lobe, alone.
LobeGroup surface_group(const PreparedYarn<double>& yarn);
/// Groups of the other lobes: the first one alone, then as many as a b grows by no more than a
/// factor, above 1.
std::vector<LobeGroup> lobe_groups(const PreparedYarn<double>& yarn, double growth);

/// Which of a yarn's walks are meant.
struct Walks {
  enum class Kind {
    kAll,               ///< all that count
    kBeyond,            ///< those that reach layers beyond `kept`
    kInterreflections,  ///< those of three and more reflections and more than `kept` events
    kNearSides,         ///< those of one reflection at the near side of a deeper layer
  };
  Kind kind = Kind::kAll;
  int kept = 0;
};

/// Bounds of walks' weights: of each group of lobes, and of all together.
struct WalkBounds {
  std::vector<Interval> groups;
  Interval total;
};

/// For all incidence cosines of a range, within [0, 1]. Rests on these: a walk's weight is a
/// product of r (which falls with the cosine, for indices up to 3), t and passages (which rise with
/// it); the reflectance of a stack rises with r and with the passages; what gets through its first
/// interface and back falls with r where what lies below is given.
WalkBounds walk_bounds(const PreparedYarn<double>& yarn, double absorption, const Walks& walks,
                       const std::vector<LobeGroup>& groups, const Interval& cos_theta_d);

/// r, for all incidence cosines of a range.
Interval surface_bounds(double refractive_index, const Interval& cos_theta_d);

/// A sum of weights times densities, over groups: the weights within their bounds and their total,
/// the densities (of either sign) within theirs.
Interval sum_bounds(const WalkBounds& weights, const std::vector<Interval>& densities);

}  // namespace clothbrdf
