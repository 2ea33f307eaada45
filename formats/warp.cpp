#include "formats/warp.h"

#include <algorithm>
#include <cmath>

namespace clothbrdf {

struct WarpCell {
  std::size_t index;
  double rest;
};

namespace {

WarpCell cell_of(double at, std::size_t nodes) {
  const double scaled = std::clamp(at, 0.0, 1.0) * static_cast<double>(nodes - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(scaled), nodes - 2);
  return {index, scaled - static_cast<double>(index)};
}

// Where the integral of a density that is linear from v0 (at 0) to v1 (at 1) reaches `area`.
double invert_linear(double area, double v0, double v1) {
  // The readers' own limit, below which the root would cancel.
  constexpr double kConstant = 1e-4;
  if (std::abs(v0 - v1) < kConstant * (v0 + v1)) return v0 + v1 > 0 ? 2 * area / (v0 + v1) : 0;
  if (v0 == v1) return 0;
  return (v0 - std::sqrt(std::max(0.0, v0 * v0 - 2 * area * (v0 - v1)))) / (v0 - v1);
}

// The last of 0 ... count - 2 whose sum is not above `at`; sums ascend from 0.
template <class Sum>
std::size_t find_interval(std::size_t count, double at, const Sum& sum) {
  std::size_t low = 0;
  std::size_t high = count - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (sum(middle) <= at ? low : high) = middle;
  }
  return low;
}

double lerp(double a, double b, double t) { return (1 - t) * a + t * b; }

}  // namespace

Bracket bracket(std::span<const float> nodes, double at) {
  if (nodes.size() < 2) return {0, 0.0};
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), at,
                                      [](double a, float node) { return a < double{node}; });
  const auto index = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      above - nodes.begin() - 1, 0, static_cast<std::ptrdiff_t>(nodes.size()) - 2));
  const double low = double{nodes[index]};
  const double high = double{nodes[index + 1]};
  return {index, std::clamp((at - low) / (high - low), 0.0, 1.0)};
}

SliceBlend blend_slices(std::span<const float> phi_i, std::span<const float> theta_i, double phi,
                        double theta) {
  const Bracket p = bracket(phi_i, phi);
  const Bracket t = bracket(theta_i, theta);
  SliceBlend blend;
  for (std::size_t side = 0; side < 4; ++side) {
    const std::size_t p_side = side / 2;
    const std::size_t t_side = side % 2;
    const double weight = (p_side == 1 ? p.upper_share : 1 - p.upper_share) *
                          (t_side == 1 ? t.upper_share : 1 - t.upper_share);
    if (weight == 0) continue;
    blend.shares[blend.count++] = {(p.lower + p_side) * theta_i.size() + t.lower + t_side, weight};
  }
  return blend;
}

SliceBlend only_slice(std::size_t slice) {
  SliceBlend blend;
  blend.shares[0] = {slice, 1.0};
  blend.count = 1;
  return blend;
}

double bilinear(std::span<const float> values, std::size_t rows, std::size_t columns, RglPoint at) {
  const WarpCell x = cell_of(at.x, columns);
  const WarpCell y = cell_of(at.y, rows);
  const float* const lower = values.data() + y.index * columns + x.index;
  const float* const upper = lower + columns;
  return lerp(lerp(double{lower[0]}, double{lower[1]}, x.rest),
              lerp(double{upper[0]}, double{upper[1]}, x.rest), y.rest);
}

// The patch of a point: blended densities at its left and right edge, of the row blended at the
// point, and the masses of the rows above and below.
struct Warp::Patch {
  WarpCell x;
  WarpCell y;
  double left;
  double right;
};

Warp::Warp(std::size_t rows, std::size_t columns, std::span<const float> densities)
    : rows_(rows),
      columns_(columns),
      density_(densities.begin(), densities.end()),
      row_sums_(densities.size()),
      marginal_(densities.size() / columns) {
  const std::size_t slice_size = rows * columns;
  for (std::size_t slice = 0; slice < densities.size() / slice_size; ++slice) {
    double* const density = density_.data() + slice * slice_size;
    double* const sums = row_sums_.data() + slice * slice_size;
    double* const marginal = marginal_.data() + slice * rows;
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 1; column < columns; ++column) {
        const std::size_t at = row * columns + column;
        sums[at] = sums[at - 1] + 0.5 * (density[at - 1] + density[at]);
      }
      if (row == 0) continue;
      const std::size_t last = row * columns + columns - 1;
      marginal[row] = marginal[row - 1] + 0.5 * (sums[last - columns] + sums[last]);
    }
    const double total = marginal[rows - 1];
    if (!(total > 0)) continue;
    for (std::size_t at = 0; at < slice_size; ++at) {
      density[at] /= total;
      sums[at] /= total;
    }
    for (std::size_t row = 0; row < rows; ++row) marginal[row] /= total;
  }
}

double Warp::blended(std::span<const double> of_slices, std::size_t per_slice, std::size_t at,
                     const SliceBlend& blend) const {
  double sum = 0;
  for (const SliceBlend::Share& share : blend.span()) {
    sum += share.weight * of_slices[share.slice * per_slice + at];
  }
  return sum;
}

Warp::Patch Warp::patch(RglPoint point, const SliceBlend& blend) const {
  Patch patch{cell_of(point.x, columns_), cell_of(point.y, rows_), 0, 0};
  const std::size_t at = patch.y.index * columns_ + patch.x.index;
  const auto row_blend = [&](std::size_t node) {
    return lerp(blended(density_, rows_ * columns_, node, blend),
                blended(density_, rows_ * columns_, node + columns_, blend), patch.y.rest);
  };
  patch.left = row_blend(at);
  patch.right = row_blend(at + 1);
  return patch;
}

RglPoint Warp::sample(RglPoint u, const SliceBlend& blend) const {
  const std::size_t slice_size = rows_ * columns_;
  const auto marginal = [&](std::size_t row) { return blended(marginal_, rows_, row, blend); };
  const std::size_t row = find_interval(rows_, u.y, marginal);
  const std::size_t first = row * columns_;
  const auto sum = [&](std::size_t at) { return blended(row_sums_, slice_size, at, blend); };
  const double r0 = sum(first + columns_ - 1);
  const double r1 = sum(first + 2 * columns_ - 1);
  const double y = std::clamp(invert_linear(u.y - marginal(row), r0, r1), 0.0, 1.0);

  const double target = u.x * lerp(r0, r1, y);
  const auto row_sum = [&](std::size_t column) {
    return lerp(sum(first + column), sum(first + columns_ + column), y);
  };
  const std::size_t column = find_interval(columns_, target, row_sum);
  const auto density = [&](std::size_t at) {
    return lerp(blended(density_, slice_size, first + at, blend),
                blended(density_, slice_size, first + columns_ + at, blend), y);
  };
  const double x = std::clamp(
      invert_linear(target - row_sum(column), density(column), density(column + 1)), 0.0, 1.0);
  return {(static_cast<double>(column) + x) / static_cast<double>(columns_ - 1),
          (static_cast<double>(row) + y) / static_cast<double>(rows_ - 1)};
}

RglPoint Warp::invert(RglPoint u_m, const SliceBlend& blend) const {
  const Patch p = patch(u_m, blend);
  const std::size_t first = p.y.index * columns_;
  const auto sum = [&](std::size_t at) {
    return blended(row_sums_, rows_ * columns_, first + at, blend);
  };
  const double r0 = sum(columns_ - 1);
  const double r1 = sum(2 * columns_ - 1);
  const double row_mass = lerp(r0, r1, p.y.rest);
  double x = p.x.rest * (p.left + 0.5 * p.x.rest * (p.right - p.left));
  x += lerp(sum(p.x.index), sum(columns_ + p.x.index), p.y.rest);
  const double y =
      p.y.rest * (r0 + 0.5 * p.y.rest * (r1 - r0)) + blended(marginal_, rows_, p.y.index, blend);
  return {row_mass > 0 ? x / row_mass : 0, y};
}

double Warp::density(RglPoint u_m, const SliceBlend& blend) const {
  const Patch p = patch(u_m, blend);
  return lerp(p.left, p.right, p.x.rest) * static_cast<double>((rows_ - 1) * (columns_ - 1));
}

}  // namespace clothbrdf
