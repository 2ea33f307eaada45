#include "cli/conversion.h"

#include <algorithm>
#include <iomanip>
#include <span>
#include <sstream>
#include <utility>

#include "cli/options.h"
#include "formats/format_colours.h"
#include "support/errors.h"
#include "table/resample.h"

namespace clothbrdf {
namespace {

bool holds_components(const TableSpec& spec) {
  return std::any_of(spec.channels.begin(), spec.channels.end(),
                     [](const Channel& channel) { return channel.part != Part::kTotal; });
}

// The samples to try, those that lose least first.
std::vector<Samples> candidates(const TableSpec& source, const Format& format,
                                const ConversionWish& wish) {
  const auto& material = source.provenance.material;
  // Whether f(wi, wo) is f(wo, wi) is not known of a table that holds both.
  const bool both_orders = !source.has_grid() || !source.grid().folds_orders();
  const Reflectance reflectance = material      ? material->reflectance
                                  : both_orders ? Reflectance::kPaper
                                                : Reflectance::kMicrofacet;
  const bool isotropic = wish.isotropic || source.isotropic();
  const Samples standard = format.default_samples(reflectance, isotropic);
  if (wish.grid) {
    const bool once_around = reflectance == Reflectance::kPaper && format.keeps_description;
    return {parse_grid(*wish.grid, once_around ? 360 : 180)};
  }
  std::vector<Samples> samples;
  if (!wish.isotropic || source.isotropic()) samples.push_back(source.samples);
  samples.emplace_back(AnyPairs{isotropic});
  samples.emplace_back(AnyPairs{true});
  samples.push_back(standard);
  return samples;
}

std::vector<std::string> what_is_lost(const Table& source, const Conversion& conversion,
                                      const WriteOptions& options) {
  const TableSpec& from = source.spec();
  const TableSpec& to = conversion.spec;
  const Format& format = *conversion.format;
  std::vector<std::string> lost;
  if (!from.provenance.note.empty()) lost.push_back("before: " + from.provenance.note);
  if (averages_rotations(from, to)) {
    lost.emplace_back(from.reach
                          ? "anisotropy: the mean over those rotations of the cloth that the "
                            "scene reaches"
                          : "anisotropy: the mean over rotations of the cloth");
  }
  const auto& material = from.provenance.material;
  const bool reciprocal = material && material->reflectance == Reflectance::kMicrofacet;
  if (averages_orders(from, to) && !reciprocal) {
    lost.emplace_back("the order of the directions: the mean of f(wi,wo) and f(wo,wi)");
  }
  if (!format.averages.empty()) lost.emplace_back(std::string(format.averages));
  if (from.samples != to.samples) {
    const std::string target =
        to.has_grid() ? to.description() : format.layout(to, options).description;
    lost.push_back("the nodes: resampled from " + from.description() + " to " + target + ", " +
                   source.interpolation());
    if (from.cells.average) lost.emplace_back("the averages over cells: values at nodes");
  }
  if (holds_components(from) && !holds_components(to)) {
    lost.emplace_back("the components: totals only");
  }
  if (const std::string colours = colours_note(from, to); !colours.empty()) {
    lost.push_back(colours);
  }
  const StoredPrecision stored = format.precision(options);
  if (stored.relative > source.precision().relative) {
    std::ostringstream text;
    text << "digits: rounded by up to " << std::setprecision(2) << stored.relative
         << " of the value, or by " << stored.step / 2 << " where that is more";
    lost.push_back(text.str());
  }
  if (from.reach && (!to.has_grid() || (!format.keeps_description && from.samples == to.samples))) {
    lost.emplace_back(
        "the scene: no longer told apart are cells that it does not reach, which hold 0");
  }
  if (!format.keeps_description && !from.provenance.program.empty()) {
    lost.emplace_back("the description: material, effects and cells");
  }
  return lost;
}

/// The largest differences of any channel.
ChannelDifference worst_of(const Comparison& comparison) {
  ChannelDifference worst;
  for (const ChannelDifference& d : comparison.channels) {
    worst.rms = std::max(worst.rms, d.rms);
    worst.p99 = std::max(worst.p99, d.p99);
    worst.max = std::max(worst.max, d.max);
  }
  return worst;
}

// How far a file is from its source, in the file's colours, at random pairs.
Comparison compare_with_file(const Table& written, const Table& source, const Format& format,
                             const WriteOptions& options) {
  const Table there = resample(source, compared_pairs(written.spec().isotropic()), options.workers);
  const std::unique_ptr<Producer> coloured = in_colours_of(format, there, options);
  if (!coloured) return compare(there, written, options.workers);
  const Table mixed = collect(*coloured, options.workers);
  std::vector<std::uint8_t> valid(mixed.spec().cell_count());
  for (std::size_t cell = 0; cell < valid.size(); ++cell) valid[cell] = there.valid(cell) ? 1 : 0;
  const std::span<const double> values = mixed.values();
  return compare({mixed.spec(), {values.begin(), values.end()}, valid}, written, options.workers);
}

std::size_t not_measured(const Table& table) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
    count += !table.valid(cell) && table.spec().node_above_horizon(cell) ? 1U : 0U;
  }
  return count;
}

}  // namespace

Conversion plan_conversion(const Table& source, const ConversionWish& wish) {
  const Format& format = format_for(wish.out);
  const std::vector<Samples> all = candidates(source.spec(), format, wish);
  for (const Samples& samples : all) {
    for (const bool components : {true, false}) {
      Conversion conversion{&format, source.spec(), {}, {}};
      TableSpec& spec = conversion.spec;
      spec.samples = samples;
      if (!components) {
        std::erase_if(spec.channels, [](const Channel& c) { return c.part != Part::kTotal; });
        spec = in_colours_of(format, spec, wish.write);
      }
      try {
        check_output(format, spec, wish.write, wish.out);
      } catch (const InputError&) {
        if (!components && &samples == &all.back()) throw;
        continue;
      }
      if (std::holds_alternative<AnyPairs>(samples) && !source.complete()) {
        throw InputError(wish.out +
                         ": the source's scattered samples do not cover all directions, " +
                         std::string(format.name) + " does; a list of pairs (.alta) can hold them");
      }
      if (samples != source.spec().samples) spec.cells = {};
      if (!spec.has_grid()) spec.reach.reset();
      conversion.lost = what_is_lost(source, conversion, wish.write);
      return conversion;
    }
  }
  throw std::logic_error("the last choice returns or throws");
}

namespace {

// The same values under another description.
class Restated final : public Producer {
 public:
  Restated(const Producer& source, TableSpec spec) : source_(source), spec_(std::move(spec)) {}
  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t first_row, std::span<double> values) const override {
    source_.fill_rows(first_row, values);
  }
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override {
    source_.fill_pairs(pairs, values);
  }

 private:
  const Producer& source_;
  TableSpec spec_;
};

}  // namespace

std::optional<ChannelDifference> run_conversion(const Table& source, const ConversionWish& wish,
                                                Conversion& conversion, AtomicFile& file) {
  const Workers& workers = wish.write.workers;
  const TableSpec& target = conversion.spec;
  const auto write = [&](const Producer& values) {
    TableSpec spec = values.spec();
    spec.provenance.error.reset();
    const Restated restated(values, std::move(spec));
    const Producer& uncoloured = restated;
    const std::unique_ptr<Producer> coloured =
        in_colours_of(*conversion.format, uncoloured, wish.write);
    const Producer& producer = coloured ? *coloured : uncoloured;
    if (workers.progress != nullptr) {
      workers.progress->begin(wish.out, conversion.format->layout(target, wish.write).cells,
                              "cells");
    }
    write_table(*conversion.format, producer, file, wish.write);
  };
  std::optional<Table> totals;
  if (holds_components(source.spec()) && !holds_components(target)) {
    totals = without_components(source);
  }
  const Table& from = totals ? *totals : source;
  if (std::holds_alternative<AnyPairs>(target.samples)) {
    const TablePairs pairs(from, target.isotropic());
    write(pairs);
    if (pairs.unanswered() > 0) {
      conversion.lost.push_back("what was not measured: " + with_commas(pairs.unanswered()) +
                                " pairs, of which the source says nothing, hold 0");
    }
    conversion.compared_at = "at random pairs below 85 degrees, as the file is read";
    const ChannelDifference worst = worst_of(compare_with_file(
        conversion.format->read(file.readable()), from, *conversion.format, wish.write));
    file.commit();
    return worst;
  }
  if (target.samples == from.spec().samples) {
    write(from);
    file.commit();
    return std::nullopt;
  }
  const Table resampled = resample(from, target.samples, workers);
  if (const std::size_t count = not_measured(resampled); count > 0) {
    conversion.lost.push_back(with_commas(count) +
                              " cells, which have no cell to be interpolated from: they hold " +
                              (resampled.spec().provenance.material && !source.spec().reach
                                   ? "0"
                                   : "-1, the mark of such cells"));
  }
  conversion.compared_at = "at the old nodes";
  const ChannelDifference worst = worst_of(compare(from, resampled, workers));
  write(resampled);
  file.commit();
  return worst;
}

}  // namespace clothbrdf
