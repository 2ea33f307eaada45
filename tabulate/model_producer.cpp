#include "tabulate/model_producer.h"

#include <string>
#include <utility>

#include "model/parameters.h"
#include "support/errors.h"
#include "support/version.h"
#include "tabulate/halfdiff_average.h"
#include "tabulate/halfdiff_points.h"
#include "tabulate/inout_average.h"
#include "tabulate/inout_points.h"

namespace clothbrdf {
namespace {

// Below, lobes magnify the rounding of directions in floats beyond the accuracy of a file.
constexpr double kNarrow = 0.01;

class ModelProducer final : public Producer {
 public:
  ModelProducer(const TableSpec& spec, Workers workers, Precision precision)
      : spec_(spec), model_(*spec.provenance.material, spec.provenance.effects) {
    if (!spec_.has_grid()) return;
    if (spec_.grid().kind == GridKind::kInOut) {
      if (spec_.cells.average) {
        kernel_ = std::make_unique<InOutAverage>(spec_, model_, workers);
      } else {
        const bool single = precision == Precision::kSingle && narrowest_axis(model_) >= kNarrow;
        kernel_ = std::make_unique<InOutPoints>(
            spec_, model_, single ? Precision::kSingle : Precision::kDouble, workers);
      }
    } else if (spec_.cells.average) {
      kernel_ = std::make_unique<HalfDifferenceAverage>(spec_, model_, workers);
    } else {
      kernel_ = std::make_unique<HalfDifferencePoints>(spec_, model_, workers);
    }
  }

  const TableSpec& spec() const override { return spec_; }

  void fill_rows(std::size_t first_row, std::span<double> values) const override {
    if (kernel_) {
      kernel_->fill_rows(first_row, values);
    } else {
      fill_pairs(std::span(spec_.pairs()).subspan(first_row, values.size() / spec_.row_values()),
                 values);
    }
  }

  void fill_pairs(std::span<const DirectionPair> pairs, std::span<double> values) const override {
    std::size_t next = 0;
    for (const DirectionPair& pair : pairs) {
      const Components f = model_.evaluate(pair_geometry(pair, model_.material().rotation_deg));
      for (const Channel& channel : spec_.channels) values[next++] = channel_value(f, channel);
    }
  }

 private:
  TableSpec spec_;
  ClothModel<double> model_;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace

TableSpec material_spec(const Material& material, const Effects& effects, const Grid& grid,
                        const CellRule& cells, bool with_components) {
  return {grid,
          material_channels(material, with_components),
          cells,
          {material, effects, std::string("clothbrdf ") + kVersion}};
}

void check_producible(const TableSpec& spec) {
  if (!spec.provenance.material) throw InputError("the table names no material to compute it from");
  check_material(*spec.provenance.material);
  for (const Channel& channel : spec.channels) {
    if (channel.colour >= spec.provenance.material->channel_count()) {
      throw InputError("channel " + full_name(channel) + " is not one of the material's");
    }
  }
  if (spec.cells.average) {
    if (!spec.has_grid()) throw InputError("averages need cells: a list of pairs has none");
    if (spec.provenance.material->reflectance == Reflectance::kPaper) {
      throw InputError(
          "--cells average: not for a material of reflectance 'paper', where the mean over cells "
          "at the horizon diverges; use --cells point");
    }
    if (spec.grid().kind != GridKind::kInOut && spec.grid().axes.back().highest_deg > 180) {
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
