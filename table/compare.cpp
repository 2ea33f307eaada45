#include "table/compare.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "support/errors.h"
#include "table/resample.h"

namespace clothbrdf {
namespace {

constexpr double kPercentile = 0.99;
// Cells that a symmetry makes equal differ by roundings; the first of them is named.
constexpr double kTie = 1e-9;
constexpr double kFloor = 1e-3;  // share of the mean below which differences are not relative

struct SharedChannel {
  std::size_t a;
  std::size_t b;
};

struct SharedCell {
  std::size_t cell;
  double size;    // dwi dwo
  double weight;  // (cos theta_i cos theta_o)^2 at its node; 0 where that is below the horizon
};

SharedCell shared_cell(const Grid& grid, std::size_t cell) {
  const Directions node = grid.directions(cell);
  const double cosines = std::max(0.0, node.wi[2]) * std::max(0.0, node.wo[2]);
  return {cell, grid.measure(cell), cosines * cosines};
}

struct SizedDifference {
  double difference;
  double size;
};

// The difference that is not passed on a share of all directions.
double percentile(std::vector<SizedDifference>& differences, double share) {
  std::sort(differences.begin(), differences.end(),
            [](const auto& x, const auto& y) { return x.difference < y.difference; });
  double total = 0;
  for (const SizedDifference& d : differences) total += d.size;
  double sum = 0;
  for (const SizedDifference& d : differences) {
    sum += d.size;
    if (sum >= share * total) return d.difference;
  }
  return differences.back().difference;
}

std::vector<SharedChannel> shared_channels(const TableSpec& a, const TableSpec& b) {
  std::vector<SharedChannel> shared;
  for (std::size_t k = 0; k < a.channels.size(); ++k) {
    for (std::size_t m = 0; m < b.channels.size(); ++m) {
      if (full_name(a.channels[k]) == full_name(b.channels[m])) shared.push_back({k, m});
    }
  }
  return shared;
}

ChannelDifference difference(const Table& a, const Table& b, const SharedChannel& channel,
                             const std::vector<SharedCell>& cells) {
  double mean = 0;
  double all_sizes = 0;
  for (const SharedCell& shared : cells) {
    mean += shared.size * std::abs(a.value(shared.cell, channel.a));
    all_sizes += shared.size;
  }
  mean /= all_sizes;
  ChannelDifference d{.channel = full_name(a.spec().channels[channel.a])};
  d.worst_cell = cells.front().cell;
  double squares = 0;
  double all_squares = 0;
  std::vector<SizedDifference> relative;
  relative.reserve(cells.size());
  for (const auto& [cell, size, weight] : cells) {
    const double of_a = a.value(cell, channel.a);
    const double off = b.value(cell, channel.b) - of_a;
    squares += size * weight * off * off;
    all_squares += size * weight * of_a * of_a;
    // Where all of a is 0, so is what a difference could be relative to.
    relative.push_back({off == 0 ? 0 : std::abs(off) / (std::abs(of_a) + kFloor * mean), size});
    if (relative.back().difference > d.max * (1 + kTie)) {
      d.max = relative.back().difference;
      d.worst_cell = cell;
    }
  }
  d.a = a.value(d.worst_cell, channel.a);
  d.b = b.value(d.worst_cell, channel.b);
  d.rms = squares == 0 ? 0 : std::sqrt(squares / all_squares);
  d.p99 = percentile(relative, kPercentile);
  return d;
}

}  // namespace

Comparison compare(const Table& a, const Table& b, const Workers& workers) {
  const std::vector<SharedChannel> shared = shared_channels(a.spec(), b.spec());
  if (shared.empty()) throw InputError("the tables have no channel in common");
  std::optional<Table> resampled;
  if (b.spec().grid() != a.spec().grid()) resampled = resample(b, a.spec().grid(), workers);
  const Table& there = resampled ? *resampled : b;
  Comparison comparison;
  std::vector<SharedCell> cells;
  for (std::size_t cell = 0; cell < a.spec().cell_count(); ++cell) {
    if (!a.valid(cell)) continue;
    if (a.finite(cell) && there.valid(cell) && there.finite(cell)) {
      cells.push_back(shared_cell(a.spec().grid(), cell));
    } else {
      ++comparison.only_a;
    }
  }
  if (cells.empty()) throw InputError("the tables have no valid cell in common");
  comparison.cells = cells.size();
  for (const SharedChannel& channel : shared) {
    comparison.channels.push_back(difference(a, there, channel, cells));
  }
  return comparison;
}

}  // namespace clothbrdf
