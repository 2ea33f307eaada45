#include "formats/rgl_prefilter.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace clothbrdf {

float prefiltered(float before, float value, float after, double h_before, double h_after) {
  constexpr double kMost = 0.05;
  if (before == 0 || value == 0 || after == 0) return value;
  const double slope_before = (double{value} - double{before}) / h_before;
  const double slope_after = (double{after} - double{value}) / h_after;
  const double second = 2 * (slope_after - slope_before) / (h_before + h_after);
  const double spacing = h_before * h_before - h_before * h_after + h_after * h_after;
  const double most = kMost * std::abs(double{value});
  return static_cast<float>(double{value} - std::clamp(spacing / 12 * second, -most, most));
}

void prefilter_slice(std::span<float> values, std::size_t side) {
  std::vector<float> line(side);
  for (std::size_t column = 0; column < side; ++column) {
    for (std::size_t row = 0; row < side; ++row) line[row] = values[row * side + column];
    for (std::size_t row = 0; row < side; ++row) {
      const float before = line[row == 0 ? side - 2 : row - 1];
      const float after = line[row == side - 1 ? 1 : row + 1];
      values[row * side + column] = prefiltered(before, line[row], after, 1, 1);
    }
  }
  for (std::size_t row = 0; row < side; ++row) {
    const std::span<float> of_row = values.subspan(row * side, side);
    std::copy(of_row.begin(), of_row.end(), line.begin());
    for (std::size_t column = 1; column + 1 < side; ++column) {
      of_row[column] = prefiltered(line[column - 1], line[column], line[column + 1], 1, 1);
    }
  }
}

void prefilter_between(std::span<float> values, std::span<const float> theta) {
  const std::size_t slice = values.size() / theta.size();
  for (std::size_t at = 0; at < slice; ++at) {
    float before = values[at];
    for (std::size_t k = 1; k + 1 < theta.size(); ++k) {
      float& value = values[k * slice + at];
      const float unchanged = value;
      value = prefiltered(before, value, values[(k + 1) * slice + at],
                          double{theta[k]} - double{theta[k - 1]},
                          double{theta[k + 1]} - double{theta[k]});
      before = unchanged;
    }
  }
}

}  // namespace clothbrdf
