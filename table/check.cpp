#include "table/check.h"

#include <algorithm>
#include <cmath>

#include "table/reached_cells.h"

namespace clothbrdf {
namespace {

// Node angles of two axes are the same direction.
constexpr double kSameAngle = 1e-9;
// What sums of many terms in double may differ by, in the order in which they are added.
constexpr double kArithmetic = 1e-12;

std::optional<std::size_t> node_at(const Axis& axis, double angle_deg) {
  const std::optional<int> k = axis.cell_of(angle_deg);
  if (!k) return std::nullopt;
  const double off = std::remainder(axis.node_deg(*k) - axis.folded_deg(angle_deg),
                                    axis.periodic ? axis.period_deg() : 1e6);
  if (std::abs(off) > kSameAngle) return std::nullopt;
  return static_cast<std::size_t>(*k);
}

// The cell that holds the other order of the directions at a cell's node; none where the grid has
// no node there.
std::optional<std::size_t> mirror_cell(const Grid& grid, std::size_t cell) {
  const std::array<int, 4> index = grid.indices(cell);
  const std::size_t last = grid.axes.size() - 1;
  std::array<std::optional<std::size_t>, 4> mirror;
  for (std::size_t a = 0; a <= last; ++a) {
    if (grid.kind == GridKind::kInOut) {
      const std::size_t other = (a + 2) % 4;
      mirror[a] = node_at(grid.axes[a], grid.axes[other].node_deg(index[other]));
    } else {
      const double turn = a == last ? 180 : 0;
      mirror[a] = node_at(grid.axes[a], grid.axes[a].node_deg(index[a]) + turn);
    }
  }
  std::size_t mirrored = 0;
  for (std::size_t a = 0; a <= last; ++a) {
    if (!mirror[a]) return std::nullopt;
    mirrored = mirrored * static_cast<std::size_t>(grid.axes[a].size) + *mirror[a];
  }
  return mirrored;
}

ReciprocityCheck check_reciprocity(const Table& table) {
  const TableSpec& spec = table.spec();
  ReciprocityCheck result;
  result.by_construction = spec.has_grid() && spec.grid().folds_orders();
  const std::optional<Material>& material = spec.provenance.material;
  result.promised = material && material->reflectance == Reflectance::kMicrofacet;
  result.allowed = 4 * table.precision().relative + kArithmetic;
  if (spec.cells.average) result.allowed += 2 * spec.cells.tolerance;
  if (result.by_construction || !spec.has_grid()) return result;
  const Grid& grid = spec.grid();
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    const std::optional<std::size_t> mirror = mirror_cell(grid, cell);
    if (!mirror || *mirror <= cell || !table.valid(cell) || !table.valid(*mirror)) continue;
    if (!table.finite(cell) || !table.finite(*mirror)) continue;
    ++result.compared;
    for (std::size_t c = 0; c < spec.channels.size(); ++c) {
      const double a = table.value(cell, c);
      const double b = table.value(*mirror, c);
      // The smallest numbers that a file holds are a step apart.
      if (std::abs(a - b) <= table.precision().step) continue;
      const double off = std::abs(a - b) / std::max(std::abs(a), std::abs(b));
      if (off > result.worst) {
        result.worst = off;
        result.here = {cell, c, a};
        result.mirrored = b;
      }
    }
  }
  return result;
}

void count(Flaw& flaw, const TableValue& found, bool worse) {
  if (flaw.count++ == 0 || worse) flaw.worst = found;
}

void check_values(const Table& table, TableCheck& check) {
  const TableSpec& spec = table.spec();
  std::vector<std::uint8_t> reached(spec.cell_count(), 1);
  if (spec.reach) ReachedCells(spec.grid(), *spec.reach).restrict(reached);
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    const bool above = spec.node_above_horizon(cell);
    const bool below = spec.has_grid() ? !spec.grid().any_above_horizon(cell) : !above;
    check.below_horizon += below;
    check.valid += table.valid(cell) ? 1U : 0U;
    check.masked += above && reached[cell] != 0 && !table.valid(cell);
    check.not_reached += above && reached[cell] == 0;
    for (std::size_t c = 0; c < spec.channels.size(); ++c) {
      const TableValue found{cell, c, table.value(cell, c)};
      if (!std::isfinite(found.value)) {
        count(check.not_finite, found, false);
      } else if (below) {
        if (found.value > 0) count(check.below_not_zero, found, false);
      } else if (found.value < 0 && (spec.cells.average || above) &&
                 (!spec.reach || table.valid(cell))) {
        count(check.negative, found, found.value < check.negative.worst.value);
      }
    }
  }
}

}  // namespace

std::optional<Albedo> TableCheck::largest_albedo() const {
  std::optional<Albedo> largest;
  for (const Albedo& a : albedo) {
    if (a.theta_i_deg <= kHighestTheta && (!largest || a.value > largest->value)) largest = a;
  }
  return largest;
}

bool TableCheck::reciprocity_broken() const {
  return reciprocity.promised && reciprocity.worst > reciprocity.allowed;
}

TableCheck check_table(const Table& table, const Workers& workers) {
  TableCheck check;
  check.cells = table.spec().cell_count();
  check_values(table, check);
  check.reciprocity = check_reciprocity(table);
  if (!table.spec().reach) check.albedo = albedo_by_theta(table, workers);
  return check;
}

}  // namespace clothbrdf
