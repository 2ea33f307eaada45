#include "tabulate/model_producer.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "model/parameters.h"
#include "support/errors.h"
#include "support/version.h"
#include "tabulate/halfdiff_average.h"
#include "tabulate/halfdiff_points.h"
#include "tabulate/inout_average.h"
#include "tabulate/inout_points.h"
#include "tabulate/pair_evaluator.h"

namespace clothbrdf {
namespace {

class ModelProducer final : public Producer {
 public:
  ModelProducer(const TableSpec& spec, Workers workers, Precision precision)
      : spec_(spec), model_(*spec.provenance.material, spec.provenance.effects) {
    if (spec_.reach) reached_.emplace(spec_.grid(), *spec_.reach);
    if (!spec_.has_grid()) {
      pairs_ = std::make_unique<PairEvaluator>(spec_, model_, precision, workers);
    } else if (spec_.grid().kind == GridKind::kInOut) {
      if (spec_.cells.average) {
        kernel_ = std::make_unique<InOutAverage>(spec_, model_, workers);
      } else {
        const bool single = precision == Precision::kSingle && floats_do(model_);
        kernel_ = std::make_unique<InOutPoints>(
            spec_, model_, single ? Precision::kSingle : Precision::kDouble, workers);
      }
    } else if (spec_.cells.average) {
      kernel_ = std::make_unique<HalfDifferenceAverage>(spec_, model_, workers);
    } else {
      kernel_ = std::make_unique<HalfDifferencePoints>(
          spec_, model_, reached_ ? reached_->columns() : all_columns(), workers);
    }
  }

  const TableSpec& spec() const override { return spec_; }

  void fill_rows(std::size_t first_row, std::span<double> values) const override {
    if (kernel_) {
      const std::size_t size = spec_.row_values();
      for (std::size_t at = 0; at < values.size(); at += size) {
        fill_row(first_row++, values.subspan(at, size));
      }
      return;
    }
    const std::size_t rows = values.size() / spec_.row_values();
    std::vector<Directions> pairs;
    pairs.reserve(rows);
    for (std::size_t row = first_row; row < first_row + rows; ++row) {
      pairs.push_back(spec_.directions(row));
    }
    pairs_->fill(pairs, values);
  }

  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override {
    if (!pairs_) throw std::logic_error("what was prepared for a grid answers rows only");
    pairs_->fill(pairs, values);
  }

 private:
  ColumnRange all_columns() const { return {0, spec_.column_count()}; }

  void fill_row(std::size_t row, std::span<double> values) const {
    if (!reached_) {
      const ColumnRange all = all_columns();
      kernel_->fill_row(row, {&all, 1}, values);
      return;
    }
    const std::span<const ColumnRange> columns = reached_->row(row);
    if (!columns.empty()) kernel_->fill_row(row, columns, values);
    const std::size_t count = spec_.column_count();
    for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
      double* const of_channel = values.data() + c * count;
      std::size_t from = 0;
      for (const ColumnRange& range : columns) {
        std::fill(of_channel + from, of_channel + range.begin, 0.0);
        from = range.end;
      }
      std::fill(of_channel + from, of_channel + count, 0.0);
    }
  }

  TableSpec spec_;
  ClothModel<double> model_;
  std::optional<ReachedCells> reached_;   // where the spec does not ask for all cells
  std::unique_ptr<Kernel> kernel_;        // of grids
  std::unique_ptr<PairEvaluator> pairs_;  // of all other samples
};

}  // namespace

TableSpec material_spec(const Material& material, const Effects& effects, const Samples& samples,
                        const CellRule& cells, bool with_components) {
  return {samples,
          material_channels(material, with_components),
          cells,
          {material, effects, std::string("clothbrdf ") + kVersion}};
}

void check_producible(const TableSpec& spec) {
  if (!spec.provenance.material) throw InputError("the table names no material to compute it from");
  check_material(*spec.provenance.material);
  if (spec.reach && !spec.has_grid()) throw InputError("a reach is for the cells of a grid");
  for (const Channel& channel : spec.channels) {
    if (channel.colour >= spec.provenance.material->channel_count()) {
      throw InputError("channel " + full_name(channel) + " is not one of the material's");
    }
  }
  if (spec.cells.average) {
    if (!spec.has_grid())
      throw InputError(
          "--cells average: not for files that choose their own nodes, nor for lists of pairs");
    if (spec.provenance.material->reflectance == Reflectance::kPaper) {
      throw InputError(
          "--cells average: not for a material of reflectance 'paper', where the mean over cells "
          "at the horizon diverges; use --cells point");
    }
    if (!spec.provenance.effects.shadowing) {
      throw InputError(
          "--cells average: not without shadowing, when f_r has no bound at grazing incidence; use "
          "--cells point");
    }
    if (spec.grid().kind != GridKind::kInOut && !spec.grid().folds_orders()) {
      throw InputError("averages of a reciprocal table are made for phi_d from 0 to 180 degrees");
    }
  }
}

std::unique_ptr<Producer> make_producer(const TableSpec& spec, Workers workers,
                                        Precision precision) {
  check_producible(spec);
  return std::make_unique<ModelProducer>(spec, workers, precision);
}

}  // namespace clothbrdf
