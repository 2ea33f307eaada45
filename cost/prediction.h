#pragma once

#include "table/reading.h"
#include "table/sampled_error.h"

namespace clothbrdf {

/// What a reader would find in a table of point cells on a grid, straight from the model: no value
/// of the table is computed but those around the pairs asked for. Answers pairs only.
class PointCells final : public Producer {
 public:
  /// `model` answers pairs; values are rounded as `stored` says. Keeps a reference to the model.
  PointCells(const Producer& model, Grid grid, Reader reader, StoredPrecision stored);
  const TableSpec& spec() const override { return model_.spec(); }
  void fill_rows(std::size_t first_row, std::span<double> values) const override;  ///< has none
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override;

 private:
  Directions node(std::size_t cell) const;

  const Producer& model_;
  Grid grid_;
  std::array<std::vector<SinCos<double>>, 4> nodes_;  // of each axis
  Reader reader_;
  StoredPrecision stored_;
};

/// The values that errors are measured against.
struct Exact {
  SampledPairs sampled;
  std::vector<double> values;  ///< [pair][channel]
};

/// Of a producer that answers pairs.
Exact exact_values(const Producer& model, std::size_t pairs, std::uint64_t seed,
                   const Workers& workers);

/// The error of what another producer says at those pairs.
TableError error_of(const Producer& read, const Exact& exact, const Workers& workers);

/// The error of a table in memory as its readers see it.
TableError error_of(const Table& table, Reader reader, const Exact& exact, const Workers& workers);

}  // namespace clothbrdf
