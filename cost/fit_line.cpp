#include "cost/fit_line.h"

#include <cstddef>

namespace clothbrdf {

double fitted_slope(std::span<const double> x, std::span<const double> y) {
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean_x += x[k] / static_cast<double>(x.size());
    mean_y += y[k] / static_cast<double>(x.size());
  }
  double both = 0;
  double squares = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    both += (x[k] - mean_x) * (y[k] - mean_y);
    squares += (x[k] - mean_x) * (x[k] - mean_x);
  }
  return both / squares;
}

}  // namespace clothbrdf
