#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "formats/format.h"
#include "support/errors.h"
#include "table/compare.h"
#include "table/resample.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct ConvertOptions {
  std::string in;
  std::string out;
  std::optional<std::string> grid;
  std::optional<std::string> threads;
  bool half = false;
  bool compress = false;
  bool json = false;
};

bool holds_components(const TableSpec& spec) {
  return std::any_of(spec.channels.begin(), spec.channels.end(),
                     [](const Channel& channel) { return channel.part != Part::kTotal; });
}

/// What the target can hold of a source.
struct Target {
  const Format* format;
  WriteOptions write;
  Grid grid;
  bool components;
};

/// The source's own grid and all channels where the format takes them; else its default grid, and
/// totals alone. Throws InputError where it takes none of them.
Target choose_target(const ConvertOptions& options, const TableSpec& source,
                     const Workers& workers) {
  const Format& format = format_for(options.out);
  const WriteOptions write{.half = options.half, .compress = options.compress, .workers = workers};
  const bool paper =
      source.provenance.material && source.provenance.material->reflectance == Reflectance::kPaper;
  const Grid standard = std::get<Grid>(format.default_samples(
      paper ? Reflectance::kPaper : Reflectance::kMicrofacet, source.isotropic()));
  std::vector<Grid> grids = {source.grid(), standard};
  if (options.grid) grids = {parse_grid(*options.grid, standard.axes.back().highest_deg)};
  for (const Grid& grid : grids) {
    for (const bool components : {true, false}) {
      TableSpec spec = source;
      spec.samples = grid;
      if (!components) {
        std::erase_if(spec.channels, [](const Channel& c) { return c.part != Part::kTotal; });
      }
      try {
        check_output(format, spec, write, options.out);
        return {&format, write, grid, components && holds_components(source)};
      } catch (const InputError&) {
        if (!components && &grid == &grids.back()) throw;
      }
    }
  }
  throw std::logic_error("the last choice returns or throws");
}

std::vector<std::string> what_is_lost(const Table& source, const Target& target) {
  const TableSpec& spec = source.spec();
  std::vector<std::string> lost;
  if (averages_rotations(spec.grid(), target.grid)) {
    lost.emplace_back("anisotropy: the mean over rotations of the cloth");
  }
  const auto& material = spec.provenance.material;
  const bool reciprocal = material && material->reflectance == Reflectance::kMicrofacet;
  if (averages_orders(spec.grid(), target.grid) && !reciprocal) {
    lost.emplace_back("the order of the directions: the mean of f(wi,wo) and f(wo,wi)");
  }
  if (spec.grid() != target.grid) {
    lost.push_back("the nodes: resampled from " + spec.description() + " to " +
                   target.grid.description() + ", linear between nodes");
    if (spec.cells.average) lost.emplace_back("the averages over cells: values at nodes");
  }
  if (holds_components(spec) && !target.components) {
    lost.emplace_back("the components: totals only");
  }
  const auto [rounding, step] = target.format->precision(target.write);
  if (rounding > source.precision().relative) {
    std::ostringstream text;
    text << "digits: rounded by up to " << std::setprecision(2) << rounding
         << " of the value, or by " << step / 2 << " where that is more";
    lost.push_back(text.str());
  }
  if (!target.format->keeps_description && !spec.provenance.program.empty()) {
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

std::size_t not_measured(const Table& table) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
    count += !table.valid(cell) && table.spec().grid().node_above_horizon(cell) ? 1U : 0U;
  }
  return count;
}

void report(const ConvertOptions& options, const Target& target, const Table& table,
            std::uint64_t bytes, const std::vector<std::string>& lost,
            const std::optional<ChannelDifference>& error) {
  const TableSpec& spec = table.spec();
  if (options.json) {
    Json json = {{"file", options.out},
                 {"from", options.in},
                 {"format", target.format->name},
                 {"grid", spec.description()},
                 {"cells", spec.cell_count()},
                 {"channels", spec.channels.size()},
                 {"bytes", bytes},
                 {"lost", lost}};
    if (error) json["error"] = {{"rms", error->rms}, {"p99", error->p99}, {"max", error->max}};
    std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
    return;
  }
  std::cout << options.out << ": " << target.format->name << ' ' << spec.description() << ", "
            << with_commas(spec.cell_count()) << " cells of " << spec.channels.size()
            << " channels, " << with_commas(bytes) << " bytes, from " << options.in << '\n';
  for (const std::string& what : lost) std::cout << "  lost: " << what << '\n';
  if (error) {
    std::cout << std::setprecision(3) << "  error at the old nodes: rms " << error->rms << ", p99 "
              << error->p99 << ", max " << error->max << '\n';
  }
  if (lost.empty()) std::cout << "  lost: nothing\n";
}

void convert(const ConvertOptions& options) {
  const int threads = threads_of(options.threads);
  format_for(options.out);  // before a large table is read
  Table table = read_table(options.in);
  ProgressBar bar;
  const Workers workers{threads, &bar.progress()};
  const Target target = choose_target(options, table.spec(), workers);
  AtomicFile file(options.out);
  std::vector<std::string> lost = what_is_lost(table, target);
  if (holds_components(table.spec()) && !target.components) table = without_components(table);
  std::optional<ChannelDifference> error;
  if (target.grid != table.spec().grid()) {
    Table resampled = resample(table, target.grid, workers);
    error = worst_of(compare(table, resampled, workers));
    if (const std::size_t count = not_measured(resampled); count > 0) {
      lost.push_back(with_commas(count) +
                     " cells, which have no cell to be interpolated from: they hold " +
                     (table.spec().provenance.material ? "0" : "-1, the mark of such cells"));
    }
    table = std::move(resampled);
  }
  bar.progress().begin(options.out, table.spec().cell_count(), "cells");
  write_table(*target.format, table, file, target.write);
  const std::uint64_t bytes = file.size();
  file.commit();
  bar.clear();
  report(options, target, table, bytes, lost, error);
}

}  // namespace

void add_convert_command(CLI::App& program) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand(
      "convert",
      "Writes a table in another format or on another grid, and says what is lost. The grid stays "
      "where the format can hold it.\n"
      "Example: clothbrdf convert silk.exr silk.binary");
  command->add_option("IN", options->in, "table to read (" + table_endings() + ")")
      ->required()
      ->type_name("FILE");
  command->add_option("OUT", options->out, "table to write; the format follows the ending")
      ->required()
      ->type_name("FILE");
  add_text_option(*command, "--grid", options->grid, "GRID",
                  "halfdiff3d[:THxTDxPD], halfdiff4d[:THxPHxTDxPD] or inout[:TIxPIxTOxPO]");
  command->add_flag("--half", options->half,
                    "16-bit floats (EXR); a value that does not fit is an error");
  command->add_flag("--compress", options->compress, "compress without loss (EXR)");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "say what was written as one JSON object");
  command->callback([options] { convert(*options); });
}

}  // namespace clothbrdf
