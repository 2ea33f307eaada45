#include "tabulate/inout_average.h"

#include <algorithm>
#include <cmath>

#include "model/degrees.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {}  // namespace

/// Arrays for the pairs of one call.
struct InOutAverage::Workspace {
  explicit Workspace(std::size_t channels) : f(channels) {}

  void resize(std::size_t count) {
    for (std::vector<double>& coordinate : directions) coordinate.resize(count);
    for (std::vector<double>& channel : f) channel.resize(count);
  }

  std::array<std::vector<double>, 6> directions;  // wi, wo
  std::vector<std::vector<double>> f;             // [channel][pair]
};

InOutAverage::InOutAverage(const TableSpec& spec, const ClothModel<double>& model, Workers workers)
    : spec_(spec),
      workers_(workers),
      narrowest_axis_(narrowest_axis(model)),
      evaluator_(model, spec.channels, workers) {}

// f of all channels, times the sines of the measure.
void InOutAverage::weighted(std::span<const Point4> points, Workspace& work,
                            std::span<double> values) const {
  workers_.check();  // here, as one cell can take minutes
  work.resize(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double theta = points[p][2 * side];
      const double phi = points[p][2 * side + 1];
      work.directions[3 * side][p] = std::sin(theta) * std::cos(phi);
      work.directions[3 * side + 1][p] = std::sin(theta) * std::sin(phi);
      work.directions[3 * side + 2][p] = std::cos(theta);
    }
  }
  const auto side = [&](std::size_t first) {
    return std::array<const double*, 3>{work.directions[first].data(),
                                        work.directions[first + 1].data(),
                                        work.directions[first + 2].data()};
  };
  std::vector<double*> to;
  for (std::vector<double>& channel : work.f) to.push_back(channel.data());
  evaluator_.evaluate({side(0), side(3), points.size()}, to);
  const std::size_t channels = work.f.size();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double sines = std::sin(points[p][0]) * std::sin(points[p][2]);
    for (std::size_t c = 0; c < channels; ++c) values[p * channels + c] = sines * work.f[c][p];
  }
}

// A part is coarse where it is wider than the lobes are there: their peak, at the normal, is as
// wide as the narrowest axis, and farther from it they change over angles like the half vector's
// own tilt. The azimuths' period must be resolved, too.
std::optional<std::size_t> InOutAverage::coarse_variable(const Box4& part) const {
  constexpr double kWidest = 0.8;
  std::array<double, 4> width{};
  std::array<double, 4> middle{};
  for (std::size_t a = 0; a < 4; ++a) {
    width[a] = part.high[a] - part.low[a];
    middle[a] = (part.high[a] + part.low[a]) / 2;
  }
  width[1] *= std::sin(part.high[0]);
  width[3] *= std::sin(part.high[2]);
  const Vector3<double> h = {
      std::sin(middle[0]) * std::cos(middle[1]) + std::sin(middle[2]) * std::cos(middle[3]),
      std::sin(middle[0]) * std::sin(middle[1]) + std::sin(middle[2]) * std::sin(middle[3]),
      std::cos(middle[0]) + std::cos(middle[2])};
  const double tilt = std::atan2(std::hypot(h[0], h[1]), h[2]);
  const auto widest = std::max_element(width.begin(), width.end());
  if (*widest <= std::min(kWidest, 2 * (tilt + narrowest_axis_))) return std::nullopt;
  return static_cast<std::size_t>(widest - width.begin());
}

void InOutAverage::fill_row(std::size_t row, std::span<const ColumnRange> columns,
                            std::span<double> values) const {
  Workspace work(spec_.channels.size());
  for (const ColumnRange& range : columns) {
    for (std::size_t column = range.begin; column < range.end; ++column) {
      const std::vector<double> means = cell_means(row * spec_.column_count() + column, work);
      for (std::size_t c = 0; c < means.size(); ++c) {
        values[c * spec_.column_count() + column] = means[c];
      }
    }
  }
}

std::vector<double> InOutAverage::cell_means(std::size_t cell, Workspace& work) const {
  const std::array<int, 4> index = spec_.grid().indices(cell);
  Box4 box{};
  double measure = 1;
  for (std::size_t a = 0; a < 4; ++a) {
    const Axis& axis = spec_.grid().axes[a];
    box.low[a] = axis.edge_deg(index[a]) * kRadian;
    box.high[a] = axis.edge_deg(index[a] + 1) * kRadian;
    const bool elevation = a % 2 == 0;
    measure *= elevation ? std::cos(box.low[a]) - std::cos(box.high[a]) : box.high[a] - box.low[a];
  }
  std::optional<std::vector<double>> integral = integrate4(
      [&](std::span<const Point4> points, std::span<double> f) { weighted(points, work, f); }, box,
      spec_.channels.size(), spec_.cells.tolerance,
      [&](const Box4& part) { return coarse_variable(part); });
  if (!integral) {
    throw WorkError("--cells average: the lobes are too narrow for cells of " +
                    spec_.grid().description() + " at a relative tolerance of " +
                    number_text(spec_.cells.tolerance) +
                    "; take a finer grid, a looser tolerance or --cells point");
  }
  for (double& mean : *integral) mean /= measure;
  return *std::move(integral);
}

}  // namespace clothbrdf
