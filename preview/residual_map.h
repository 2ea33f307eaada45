#pragma once

#include <optional>
#include <vector>

#include "preview/plot.h"
#include "support/image.h"
#include "table/grid.h"

namespace clothbrdf {

/// Where the map is in its plot; the scale's colours stand to its right.
inline constexpr Box kResidualFrame = {kPlotFrame.x, kPlotFrame.y, kPlotFrame.width - 104,
                                       kPlotFrame.height};

/// Where a fit lies beside its table: the mean of (table - fit) / fit over all values at the same
/// theta_h and theta_d (in/out grids: theta_i and theta_o).
class ResidualMap {
 public:
  explicit ResidualMap(const Grid& grid);

  /// Counts a value of a cell; those that are no measurement (negative, not finite), and cells
  /// where the fit is not above 0, are left out.
  void add(std::size_t cell, double table, double fit);

  /// The means, those of the last angle fastest; none where no value was counted.
  std::vector<std::optional<double>> means() const;

  /// What full red and full blue stand for: what 98 % of the means stay below, rounded up to 1, 2
  /// or 5 times a power of ten; from 0.001, so that rounding errors are not painted, to 1.
  double scale() const;

  /// A plot of kPlotWidth x kPlotHeight: white at 0, red where the table is higher, blue where it
  /// is lower, grey where there is nothing.
  Image draw() const;

 private:
  struct Sum {
    double sum = 0;
    std::size_t count = 0;
  };

  Grid grid_;
  std::size_t first_;   ///< the axis from left to right
  std::size_t second_;  ///< the axis upward
  std::vector<Sum> sums_;
};

}  // namespace clothbrdf
