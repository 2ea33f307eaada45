#pragma once

#include <functional>
#include <span>

#include "model/directions.h"
#include "support/progress.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// A source of the values of a table: the model's kernels, or a table in memory. Writers take one,
/// so that a table need never be whole in memory. All members may be called from several threads at
/// once.
class Producer {
 public:
  virtual ~Producer() = default;
  virtual const TableSpec& spec() const = 0;

  /// Values of whole rows from first_row on, as many as fit: values[row][channel][column]. The same
  /// bits however rows are grouped.
  virtual void fill_rows(std::size_t first_row, std::span<double> values) const = 0;

  /// Values at any pairs of unit vectors: values[pair][channel]; 0 on or below the horizon. Of an
  /// isotropic spec the means over rotations of the cloth.
  virtual void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const = 0;
};

/// The same for many pairs, shared out to the workers. Throws Cancelled.
void fill_all_pairs(const Producer& producer, Workers workers, std::span<const Directions> pairs,
                    std::span<double> values);

/// Is given whole rows, values[row][channel][column], and may change them.
using RowFunction = std::function<void(std::size_t first_row, std::span<double> values)>;

/// All rows of a producer, computed and prepared in blocks by the workers while earlier blocks are
/// taken, in order. Memory: a few blocks of about a megabyte, or of one row where that is more.
/// What a function throws ends the work. Counts cells into the workers' progress, in a phase that
/// the caller begins; throws Cancelled.
void stream_rows(const Producer& producer, Workers workers, const RowFunction& take,
                 const RowFunction& prepare = {});

}  // namespace clothbrdf
