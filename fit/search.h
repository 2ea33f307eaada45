#pragma once

#include <vector>

#include "fit/misfit.h"
#include "fit/options.h"
#include "fit/parameter_set.h"
#include "fit/report.h"
#include "fit/solve.h"

namespace clothbrdf {

/// Where a search looks: so many distinct cos_theta_d and groups of cells (thinned()).
inline constexpr std::size_t kSearchedX = 16;
inline constexpr std::size_t kSearchedGroups = 400;

/// The layer counts of both yarns that are fitted.
struct LayerRange {
  int fewest = 0;
  int most = 8;
};

/// The range of a yarn: one count where it is fixed.
LayerRange layer_range(const ParameterSet& set, const FitOptions& options, std::size_t yarn);

/// The best fits for every pair of layer counts.
class LayerTable {
 public:
  LayerTable(LayerRange warp, LayerRange weft, bool tied);

  bool holds(int warp, int weft) const;
  Solution& at(int warp, int weft) { return fits_[index(warp, weft)]; }
  const Solution& at(int warp, int weft) const { return fits_[index(warp, weft)]; }

  /// The pairs of counts, those of the warp slowest.
  const std::vector<std::pair<int, int>>& pairs() const { return pairs_; }

  /// The pair with the lowest cost among those that were fitted.
  std::pair<int, int> best() const;

 private:
  std::size_t index(int warp, int weft) const;
  LayerRange warp_;
  LayerRange weft_;
  bool tied_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<Solution> fits_;  // cost infinite before they are fitted
};

/// What a search found on the thinned rows.
struct Search {
  LayerTable layers;
  int starts = 0;
  int starts_at_best = 0;
  std::vector<Optimum> optima;  ///< lowest cost first; chi2 is the cost here
};

/// A fit without a guess: from the estimate and from scattered starts, half of them around it (or
/// from the one that was asked for alone), with layer counts of their own, each the best of which
/// then looks for better counts beside its own; then every pair of counts, from its best neighbour.
/// The same result for any number of threads.
Search search(const Misfit& misfit, const ParameterSet& set, const FitOptions& options,
              const Material& estimate, Reflectance reflectance, Paths paths, Workers workers);

/// Every pair of counts that the table does not have, from the best outward, each from its best
/// neighbour and from the best of all. Counts into the workers' progress.
void fill_layers(const Misfit& misfit, const ParameterSet& set, LayerTable& table, Workers workers);

}  // namespace clothbrdf
