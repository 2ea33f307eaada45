#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/progress.h"
#include "table/albedo.h"
#include "table/table.h"

namespace clothbrdf {

/// A value of a table and where it stands.
struct TableValue {
  std::size_t cell = 0;
  std::size_t channel = 0;
  double value = 0;
};

/// Values that should not be there.
struct Flaw {
  std::size_t count = 0;
  TableValue worst;  ///< the most negative one; the first that is not finite or not zero
};

/// How far f(wi, wo) is from f(wo, wi).
struct ReciprocityCheck {
  bool by_construction = false;  ///< the grid stores one value for both orders
  bool promised = false;         ///< by the convention of the table's material
  std::size_t compared = 0;      ///< pairs of cells whose nodes are each other's mirror image
  double worst = 0;              ///< largest |a - b| / max(|a|, |b|)
  double allowed = 0;            ///< that the stored precision and the cells' tolerance explain
  TableValue here;               ///< where it is the largest
  double mirrored = 0;           ///< the value in the mirror cell
};

/// What a look into a table, ours or measured, finds.
struct TableCheck {
  std::size_t cells = 0;
  std::size_t below_horizon = 0;  ///< wholly
  std::size_t valid = 0;
  std::size_t masked = 0;       ///< above the horizon and in reach, marked as not valid
  std::size_t not_reached = 0;  ///< above the horizon, not for the table's scene
  Flaw not_finite;
  Flaw negative;        ///< in cells above the horizon: by their node or, of averages, by any part
  Flaw below_not_zero;  ///< in cells wholly below it, other than negative marks: a note
  ReciprocityCheck reciprocity;
  std::vector<Albedo> albedo;  ///< by theta_i; none of a table for a scene, which lacks directions

  /// The largest up to kHighestTheta; none where `albedo` has none.
  std::optional<Albedo> largest_albedo() const;
  bool reciprocity_broken() const;
};

/// An albedo above this, up to kHighestTheta, is a problem. Beyond, it is a note: tables are coarse
/// there, and lobes of different width can add up to more than 1 (docs/model.md).
inline constexpr double kHighestAlbedo = 1.01;

TableCheck check_table(const Table& table, const Workers& workers);

}  // namespace clothbrdf
