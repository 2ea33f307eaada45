#include "cost/prediction.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "table/stencil.h"

namespace clothbrdf {
namespace {

double rounded(double value, StoredPrecision stored) {
  constexpr double kDouble = 0x1p-53;
  if (stored.relative <= kDouble || value == 0) return value;
  const double step =
      std::max(stored.step, 2 * stored.relative * std::exp2(std::floor(std::log2(value))));
  return step * std::nearbyint(value / step);
}

Stencil nearest_cell(const Grid& grid, const Directions& pair) {
  Stencil stencil;
  if (const auto cell = grid.cell_of(pair.wi, pair.wo)) {
    stencil.cells[0] = *cell;
    stencil.weights[0] = 1;
    stencil.count = 1;
  }
  return stencil;
}

}  // namespace

PointCells::PointCells(const Producer& model, Grid grid, Reader reader, StoredPrecision stored)
    : model_(model), grid_(std::move(grid)), reader_(reader), stored_(stored) {
  for (std::size_t a = 0; a < grid_.axes.size(); ++a) {
    for (int k = 0; k < grid_.axes[a].size; ++k) {
      nodes_[a].push_back(sincosd(grid_.axes[a].node_deg(k)));
    }
  }
}

// Grid::directions, without the trigonometry.
Directions PointCells::node(std::size_t cell) const {
  const std::array<int, 4> index = grid_.indices(cell);
  const auto at = [&](std::size_t a) -> const SinCos<double>& {
    return nodes_[a][static_cast<std::size_t>(index[a])];
  };
  const auto vector = [](const SinCos<double>& theta, const SinCos<double>& phi) {
    return Vector3<double>{theta.sin * phi.cos, theta.sin * phi.sin, theta.cos};
  };
  switch (grid_.kind) {
    case GridKind::kInOut: return {vector(at(0), at(1)), vector(at(2), at(3))};
    case GridKind::kHalfDifference3d:
      return from_half_difference(at(0), {0, 1}, vector(at(1), at(2)));
    case GridKind::kHalfDifference4d: break;
  }
  return from_half_difference(at(0), at(1), vector(at(2), at(3)));
}

void PointCells::fill_rows(std::size_t /*first_row*/, std::span<double> /*values*/) const {
  throw std::logic_error("cells that are not stored have no rows");
}

void PointCells::fill_pairs(std::span<const Directions> pairs, std::span<double> values) const {
  const std::size_t channels = spec().channels.size();
  std::vector<Directions> nodes;
  std::vector<double> weights;
  std::vector<std::size_t> end;
  for (const Directions& pair : pairs) {
    const Stencil around =
        reader_ == Reader::kNearest ? nearest_cell(grid_, pair) : linear_stencil(grid_, pair);
    const std::size_t first = nodes.size();
    double total = 0;
    for (std::size_t k = 0; k < around.count; ++k) {
      const Directions pair_at = node(around.cells[k]);
      if (!pair_at.above_horizon()) continue;
      nodes.push_back(pair_at);
      weights.push_back(around.weights[k]);
      total += around.weights[k];
    }
    for (std::size_t k = first; k < nodes.size(); ++k) weights[k] /= total;
    end.push_back(nodes.size());
  }
  std::vector<double> at_nodes(nodes.size() * channels);
  model_.fill_pairs(nodes, at_nodes);
  std::fill(values.begin(), values.end(), 0.0);
  std::size_t next = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (; next < end[p]; ++next) {
      for (std::size_t c = 0; c < channels; ++c) {
        values[p * channels + c] += weights[next] * rounded(at_nodes[next * channels + c], stored_);
      }
    }
  }
}

Exact exact_values(const Producer& model, std::size_t pairs, std::uint64_t seed,
                   const Workers& workers) {
  Exact exact{sampled_pairs(pairs, seed), {}};
  exact.values.resize(exact.sampled.pairs.size() * model.spec().channels.size());
  fill_all_pairs(model, workers, exact.sampled.pairs, exact.values);
  return exact;
}

TableError error_of(const Producer& read, const Exact& exact, const Workers& workers) {
  std::vector<double> values(exact.values.size());
  fill_all_pairs(read, workers, exact.sampled.pairs, values);
  return table_error(exact.sampled, exact.values, values);
}

TableError error_of(const Table& table, Reader reader, const Exact& exact, const Workers& workers) {
  return table_error(exact.sampled, exact.values,
                     read_pairs(table, reader, exact.sampled.pairs, workers));
}

}  // namespace clothbrdf
