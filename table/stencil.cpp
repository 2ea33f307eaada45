#include "table/stencil.h"

#include <algorithm>
#include <cmath>

namespace clothbrdf {

Stencil linear_stencil(const Grid& grid, const Directions& directions) {
  const std::vector<Axis>& axes = grid.axes;
  std::array<double, 4> angle = grid.angles(directions.wi, directions.wo);
  // One azimuth of the light stands for any: the eye's is seen from it.
  if (grid.kind == GridKind::kInOut && axes[1].size == 1) angle[3] -= angle[1];
  Stencil stencil;
  stencil.cells[0] = 0;
  stencil.weights[0] = 1;
  stencil.count = 1;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto size = static_cast<std::size_t>(axes[a].size);
    double at = axes[a].coordinate(angle[a]);
    if (!axes[a].periodic) at = std::clamp(at, 0.0, axes[a].size - 1.0);
    const double lower = std::floor(at);
    const double share = at - lower;
    const int k = static_cast<int>(lower);
    const auto wrapped = [&](int index) {
      const int n = axes[a].size;
      return static_cast<std::size_t>(axes[a].periodic ? ((index % n) + n) % n
                                                       : std::min(index, n - 1));
    };
    const std::size_t low = wrapped(k);
    const std::size_t high = wrapped(k + 1);
    const std::size_t before = stencil.count;
    for (std::size_t s = 0; s < before; ++s) {
      const std::size_t cell = stencil.cells[s] * size;
      const double weight = stencil.weights[s];
      stencil.cells[s] = cell + low;
      stencil.weights[s] = weight * (1 - share);
      if (share > 0) {
        stencil.cells[stencil.count] = cell + high;
        stencil.weights[stencil.count++] = weight * share;
      }
    }
  }
  return stencil;
}

}  // namespace clothbrdf
