#pragma once

#include <atomic>

#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// A table at other samples, a grid or a list of pairs, by Table::interpolate; the same table where
/// the samples are equal. Cells are valid where the node is above the horizon and the source says
/// something there; the others hold 0 below the horizon and, above it, 0 in a table of a known
/// material that has no reach, else kNotMeasured.
///
/// - Isotropic samples of an anisotropic source hold the mean over rotations of the cloth, as many
///   as the source has azimuths (rotation_count).
/// - A target whose phi_d ends at 180 degrees holds the mean of f(wi, wo) and f(wo, wi), where the
///   source tells them apart; so does any target where the material promises that they are equal,
///   for nodes of the source that are no mirror images of each other.
///
/// Begins a phase of the workers' progress for each pass.
Table resample(const Table& source, const Samples& samples, const Workers& workers);

/// How many rotations of the cloth its mean is taken over.
int rotation_count(const TableSpec& source);

/// Whether a target holds the mean over rotations of an anisotropic source.
bool averages_rotations(const TableSpec& source, const TableSpec& target);

/// Whether the target is the mean of both orders of the directions.
bool averages_orders(const TableSpec& source, const TableSpec& target);

/// A table as a source of any pairs of directions: what a format with nodes of its own is written
/// from. Keeps a reference to the table.
class TablePairs final : public Producer {
 public:
  /// Isotropic: the mean over rotation_count() rotations, where the table itself is not isotropic.
  TablePairs(const Table& table, bool isotropic);
  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t first_row, std::span<double> values) const override;  ///< has none
  /// 0 where the table says nothing, which unanswered() counts.
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override;

  /// Pairs above the horizon so far of which the table says nothing.
  std::size_t unanswered() const { return unanswered_; }

 private:
  const Table& table_;
  TableSpec spec_;
  int rotations_;
  mutable std::atomic<std::size_t> unanswered_ = 0;
};

}  // namespace clothbrdf
