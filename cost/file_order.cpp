#include "cost/file_order.h"

#include <algorithm>
#include <cmath>

#include "formats/format_colours.h"
#include "support/errors.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {

TableSpec computed_spec(const FileOrder& order, const FileSetting& setting) {
  TableSpec spec = material_spec(order.material, order.effects, setting.samples, setting.cells,
                                 order.with_components);
  if (spec.has_grid()) spec.reach = order.reach;
  return spec;
}

void check_setting(const FileOrder& order, const FileSetting& setting) {
  const TableSpec computed = computed_spec(order, setting);
  check_output(*order.format, in_colours_of(*order.format, computed, setting.options),
               setting.options, order.name);
  check_producible(computed);
}

bool is_allowed(const FileOrder& order, const FileSetting& setting) {
  try {
    check_setting(order, setting);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

Precision kernel_precision(const FileOrder& order, const FileSetting& setting) {
  const bool single = order.format->precision(setting.options).relative >= 0x1p-24;
  return single ? Precision::kSingle : Precision::kDouble;
}

bool values_fit(const FileOrder& order, const FileSetting& setting, const Workers& workers) {
  const double largest = order.format->precision(setting.options).largest;
  const auto producer = make_producer(computed_spec(order, setting), workers.threads,
                                      kernel_precision(order, setting));
  bool fit = true;
  stream_rows(*producer, workers.threads, [&](std::size_t, std::span<double> values) {
    fit = fit && std::all_of(values.begin(), values.end(),
                             [&](double value) { return std::abs(value) <= largest; });
  });
  return fit;
}

void write_setting(const FileOrder& order, const FileSetting& setting, AtomicFile& file,
                   const Workers& workers, const std::optional<MeasuredError>& error) {
  WriteOptions options = setting.options;
  options.workers = workers;
  TableSpec spec = computed_spec(order, setting);
  spec.provenance.error = error;
  if (workers.progress != nullptr) {
    const Layout layout =
        order.format->layout(in_colours_of(*order.format, spec, options), options);
    workers.progress->begin(std::filesystem::path(order.name).filename().string(), layout.cells,
                            "cells");
  }
  const auto producer = make_producer(spec, workers, kernel_precision(order, setting));
  const auto coloured = in_colours_of(*order.format, *producer, options);
  write_table(*order.format, coloured ? *coloured : *producer, file, options);
  workers.check();
}

Table written_and_read(const FileOrder& order, const FileSetting& setting, const Workers& workers) {
  AtomicFile scratch(order.name);
  write_setting(order, setting, scratch, workers);
  return order.format->read(scratch.readable());
}

PairModel::PairModel(const FileOrder& order, bool isotropic, const Workers& workers) {
  const FileSetting any{AnyPairs{isotropic}, {}, order.options};
  computed_ = make_producer(computed_spec(order, any), workers);
  coloured_ = in_colours_of(*order.format, *computed_, order.options);
}

}  // namespace clothbrdf
