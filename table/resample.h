#pragma once

#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// A table of a grid on the nodes of another grid, by Table::interpolate; the same table where the
/// grids are equal. Cells are valid where the node is above the horizon and valid cells of the
/// source lie around it; the others hold 0 below the horizon and, above it, 0 in a table of a known
/// material, else kNotMeasured.
///
/// - A target without phi_h holds the mean over rotations of the cloth, as many as the source has
///   azimuths.
/// - A target whose phi_d ends at 180 degrees holds the mean of f(wi, wo) and f(wo, wi), where the
///   source tells them apart; so does any target where the material promises that they are equal,
///   for nodes of the source that are no mirror images of each other.
///
/// Begins a phase of the workers' progress for each pass over a grid.
Table resample(const Table& source, const Grid& grid, const Workers& workers);

/// Whether the target is the mean over rotations of an anisotropic source.
bool averages_rotations(const Grid& source, const Grid& target);

/// Whether the target is the mean of both orders of the directions.
bool averages_orders(const Grid& source, const Grid& target);

}  // namespace clothbrdf
