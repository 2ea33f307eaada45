#pragma once

#include <span>
#include <vector>

#include "model/reflectance.h"

namespace clothbrdf {

/// The lobes of a yarn's internal light, replaced by few: the density of lobe j = 1, 2 ... of the
/// yarn at any half vector is, to a relative tolerance,
///
///     sum_k share(j, k) * density of lobes[k]
///
/// Densities depend on j only through the directionality q that is left, smoothly; the few lobes
/// lie at Chebyshev-Lobatto points in the logarithm of the narrower axis, from the first internal
/// lobe to the last (model.md 8.3). Shares can be negative. Where a yarn has no more lobes than
/// would be needed, they are kept as they are.
struct FewLobes {
  std::vector<Lobe<double>> lobes;
  std::vector<double> shares;  ///< [j - 1][k]
  double error = 0;            ///< largest relative error of a density seen, over j and h

  /// The weights of the few lobes that stand for the weights W_E of lobes j = 1, 2 ...
  void collapse(std::span<const double> weights, std::span<double> few) const;
};

/// Most lobes of a yarn after collapsing, at any tolerance down to 1e-14 (model.md 8.3).
inline constexpr std::size_t kMostFewLobes = 40;

/// The fewest lobes for a tolerance; kMostFewLobes, with the error that is left, where more would
/// be needed.
FewLobes few_lobes(const PreparedYarn<double>& yarn, Reflectance reflectance, double tolerance);

}  // namespace clothbrdf
