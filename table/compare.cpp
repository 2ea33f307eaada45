#include "table/compare.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "support/errors.h"
#include "table/resample.h"
#include "table/sampled_error.h"

namespace clothbrdf {
namespace {

// Cells that a symmetry makes equal differ by roundings; the first of them is named.
constexpr double kCellTie = 1e-9;

struct SharedChannel {
  std::size_t a;
  std::size_t b;
};

struct SharedCell {
  std::size_t cell;
  double size;    // dwi dwo
  double weight;  // (cos theta_i cos theta_o)^2 at its node; 0 where that is below the horizon
};

// All pairs of a list count the same.
SharedCell shared_cell(const TableSpec& spec, std::size_t cell) {
  const Directions node = spec.directions(cell);
  const double cosines = std::max(0.0, node.wi[2]) * std::max(0.0, node.wo[2]);
  return {cell, spec.has_grid() ? spec.grid().measure(cell) : 1, cosines * cosines};
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
    relative.push_back(
        {off == 0 ? 0 : std::abs(off) / (std::abs(of_a) + kRelativeFloor * mean), size});
    if (relative.back().difference > d.max * (1 + kCellTie)) {
      d.max = relative.back().difference;
      d.worst_cell = cell;
    }
  }
  d.place = a.spec().place(d.worst_cell);
  d.a = a.value(d.worst_cell, channel.a);
  d.b = b.value(d.worst_cell, channel.b);
  d.rms = squares == 0 ? 0 : std::sqrt(squares / all_squares);
  d.p99 = percentile(relative, kPercentile);
  return d;
}

}  // namespace

PairList compared_pairs(bool isotropic) {
  std::mt19937_64 engine(1);
  const auto share = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  const double lowest_cosine = sincosd(kComparedTheta).cos;
  const auto theta_deg = [&] {
    return std::acos(1 - share() * (1 - lowest_cosine)) * (180 / std::numbers::pi);
  };
  PairList list{{}, isotropic};
  list.pairs.reserve(kComparedPairs);
  while (list.pairs.size() < kComparedPairs) {
    const double theta_i = theta_deg();
    const double phi_i = 360 * share();
    const double theta_o = theta_deg();
    list.pairs.push_back({theta_i, phi_i, theta_o, 360 * share()});
  }
  return list;
}

Comparison compare(const Table& first, const Table& second, const Workers& workers) {
  const std::vector<SharedChannel> shared = shared_channels(first.spec(), second.spec());
  if (shared.empty()) throw InputError("the tables have no channel in common");
  Comparison comparison;
  std::optional<Table> random;
  if (first.spec().has_grid()) {
    comparison.samples = "the nodes of " + first.spec().description();
  } else if (first.complete()) {
    random = resample(first, compared_pairs(first.spec().isotropic()), workers);
    comparison.samples = "random pairs";
  } else {
    comparison.samples = "the samples of the first table";
  }
  const Table& a = random ? *random : first;
  std::optional<Table> resampled;
  if (second.spec().samples != a.spec().samples) {
    resampled = resample(second, a.spec().samples, workers);
  }
  const Table& b = resampled ? *resampled : second;
  std::vector<SharedCell> cells;
  for (std::size_t cell = 0; cell < a.spec().cell_count(); ++cell) {
    if (!a.valid(cell)) continue;
    if (a.finite(cell) && b.valid(cell) && b.finite(cell)) {
      cells.push_back(shared_cell(a.spec(), cell));
    } else {
      ++comparison.only_a;
    }
  }
  if (cells.empty()) throw InputError("the tables have no valid cell in common");
  comparison.cells = cells.size();
  for (const SharedChannel& channel : shared) {
    comparison.channels.push_back(difference(a, b, channel, cells));
  }
  return comparison;
}

}  // namespace clothbrdf
