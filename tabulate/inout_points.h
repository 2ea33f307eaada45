#pragma once

#include <array>
#include <variant>
#include <vector>

#include "tabulate/batch.h"
#include "tabulate/kernel.h"

namespace clothbrdf {

/// f_r at the nodes of in/out grids, row by row through the batch evaluator of the wanted
/// precision.
class InOutPoints final : public Kernel {
 public:
  InOutPoints(const TableSpec& spec, const ClothModel<double>& model, Precision precision,
              Workers workers);
  void fill_row(std::size_t row, std::span<const ColumnRange> columns,
                std::span<double> values) const override;

 private:
  /// Outgoing directions of a row, one array a coordinate.
  template <class T>
  struct Side {
    Side(const TableSpec& spec, const ClothModel<double>& model, Workers workers);
    void fill_row(const Vector3<double>& wi, std::span<const ColumnRange> columns,
                  std::size_t channels, std::span<double> values) const;

    BatchEvaluator<T> evaluator;
    std::array<std::vector<T>, 3> wo;
  };

  const TableSpec& spec_;
  Workers workers_;
  std::variant<Side<float>, Side<double>> side_;
};

}  // namespace clothbrdf
