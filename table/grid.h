#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/directions.h"
#include "table/axis.h"

namespace clothbrdf {

/// What the axes of a grid mean.
enum class GridKind {
  kHalfDifference3d,  ///< theta_h, theta_d, phi_d: the mean over phi_h
  kHalfDifference4d,  ///< theta_h, phi_h, theta_d, phi_d
  kInOut,             ///< theta_i, phi_i, theta_o, phi_o
};

/// What of a cell is meant.
enum class CellPart {
  kNode,  ///< where its value is taken
  kAny,   ///< any part of it
};

/// Light and eye as unit vectors of the cloth frame.
struct Directions {
  Vector3<double> wi;
  Vector3<double> wo;

  bool above_horizon() const { return wi[2] > 0 && wo[2] > 0; }
};

/// The pair that a half vector and the light around it stand for, wd in the frame whose pole is the
/// half vector.
Directions from_half_difference(const SinCos<double>& theta_h, const SinCos<double>& phi_h,
                                const Vector3<double>& wd);

/// A regular set of cells over pairs of directions. Cells are counted with the last axis fastest. A
/// row is a run of cells that share all but the last two axes: one half vector, or one direction to
/// the light.
///
/// Half/difference angles are Rusinkiewicz's: theta_h, phi_h of the half vector; theta_d, phi_d of
/// the direction to the light around it, phi_d = 0 where that leans away from the normal (MERL's
/// convention).
struct Grid {
  GridKind kind = GridKind::kHalfDifference3d;
  std::vector<Axis> axes;

  std::size_t cell_count() const;
  std::size_t column_count() const;  ///< cells of a row
  std::size_t row_count() const { return cell_count() / column_count(); }

  /// Index on each axis; 0 beyond the last one.
  std::array<int, 4> indices(std::size_t cell) const;

  /// The pair of directions at the node of a cell (phi_h = 0 where the grid has none); below the
  /// horizon in some.
  Directions directions(std::size_t cell) const;

  /// Whether the cell's node is above the horizon.
  bool node_above_horizon(std::size_t cell) const;

  /// Whether any part of the cell is.
  bool any_above_horizon(std::size_t cell) const;

  /// The same for all cells: 1 or 0 each.
  std::vector<std::uint8_t> above_horizon(CellPart part) const;

  /// The angles of a pair of unit vectors on each axis, degrees; 0 beyond the last one. phi_d
  /// beyond an axis that ends at 180 degrees is folded by reciprocity.
  std::array<double, 4> angles(const Vector3<double>& wi, const Vector3<double>& wo) const;

  /// The cell that holds a pair of unit vectors; none outside the grid. phi_h is read with the
  /// axis's period.
  std::optional<std::size_t> cell_of(const Vector3<double>& wi, const Vector3<double>& wo) const;

  /// The size of a cell, dwi dwo (= 4 cos theta_d dwh dwd), sr^2; its part below the horizon too.
  double measure(std::size_t cell) const;

  /// Where the node of a cell is, for messages: "theta_h 0.25 theta_d 1 phi_d 90", in degrees.
  std::string place(std::size_t cell) const;

  /// Whether an axis of half/difference angles holds f(wi, wo) and f(wo, wi) in one cell: phi_d
  /// repeats itself after 180 degrees.
  bool folds_orders() const;

  /// Whether all axes are as --grid makes them: no listed nodes, none mirrored.
  bool regular() const;

  /// Kind and sizes, for instance "halfdiff3d:90x90x180".
  std::string sizes() const;

  /// As --grid takes it, the same as sizes(); irregular grids add "at chosen nodes".
  std::string description() const;

  bool operator==(const Grid&) const = default;
};

/// MERL's layout by default. phi_d_range_deg is 180 (reciprocal) or 360.
Grid halfdiff3d(int theta_h = 90, int theta_d = 90, int phi_d = 180, double phi_d_range_deg = 180);

/// phi_h covers [0, 180): a cloth looks the same turned by half a turn (model.md section 8.5).
Grid halfdiff4d(int theta_h = 45, int phi_h = 36, int theta_d = 45, int phi_d = 45,
                double phi_d_range_deg = 180);

/// Nodes at theta = 90 k / size and phi = 360 k / size degrees; UTIA's by default.
Grid inout(int theta_i = 6, int phi_i = 48, int theta_o = 6, int phi_o = 48);

/// Reads a description as --grid takes it: a kind and, after a colon, the sizes of its axes. Throws
/// InputError.
Grid parse_grid(const std::string& text, double phi_d_range_deg = 180);

/// Most cells along one axis; data-schemas/table.schema.json says the same.
inline constexpr int kMaxAxisSize = 1000000;

/// Most cells of a grid: what a 64-bit file offset holds of 12 double channels, and far beyond any
/// disk here.
inline constexpr double kMaxCells = 1e15;

}  // namespace clothbrdf
