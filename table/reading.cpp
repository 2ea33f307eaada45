#include "table/reading.h"

namespace clothbrdf {
namespace {

// The cells of a table as pairs: each pair is answered by the cell that holds it.
class NearestCells final : public Producer {
 public:
  explicit NearestCells(const Table& table) : table_(table) {}
  const TableSpec& spec() const override { return table_.spec(); }
  void fill_rows(std::size_t first_row, std::span<double> values) const override {
    table_.fill_rows(first_row, values);
  }
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override {
    const std::size_t channels = spec().channels.size();
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto cell = spec().grid().cell_of(pairs[p].wi, pairs[p].wo);
      for (std::size_t c = 0; c < channels; ++c) {
        values[p * channels + c] = cell ? table_.value(*cell, c) : 0;
      }
    }
  }

 private:
  const Table& table_;
};

}  // namespace

std::string reader_name(const Table& table, Reader reader) {
  if (reader == Reader::kNearest) return "nearest";
  return table.interpolant() ? table.interpolation() : "linear";
}

std::vector<double> read_pairs(const Table& table, Reader reader, std::span<const Directions> pairs,
                               const Workers& workers) {
  std::vector<double> values(pairs.size() * table.spec().channels.size());
  if (reader == Reader::kNearest && table.spec().has_grid()) {
    fill_all_pairs(NearestCells(table), workers, pairs, values);
  } else {
    fill_all_pairs(table, workers, pairs, values);
  }
  return values;
}

}  // namespace clothbrdf
