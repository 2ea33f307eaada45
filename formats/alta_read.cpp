#include "formats/alta_read.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/alta_layout.h"
#include "formats/alta_parametrisation.h"
#include "formats/alta_rows.h"
#include "formats/file_bytes.h"
#include "formats/format_colours.h"
#include "formats/json_text.h"
#include "formats/table_metadata.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

std::span<const double> row_of(const AltaRows& rows, std::size_t row) {
  const std::size_t columns = rows.inputs + rows.outputs;
  return std::span(rows.numbers).subspan(row * columns, columns);
}

[[noreturn]] void fail_sample(const std::string& name, std::size_t row, const std::string& what) {
  throw InputError(name + ": sample " + std::to_string(row + 1) + " " + what);
}

// The channels of a file that does not name them.
std::vector<Channel> channels_of(const AltaRows& rows, const std::string& name, std::string& note) {
  const std::string& output = rows.required("PARAM_OUT", name);
  const auto fail = [&](const std::string& what) {
    throw InputError(name + ": #PARAM_OUT: " + what);
  };
  if (output == "INV_STERADIAN_COSINE_FACTOR") {
    fail("INV_STERADIAN_COSINE_FACTOR is not read: which cosine it holds is not defined");
  }
  if (output == "ENERGY" || output == "XYZ_COLOR") {
    fail(output + " is not read: its scale is not defined");
  }
  if (output != "RGB_COLOR" && output != "INV_STERADIAN") {
    fail("'" + one_line(output) + "' is not allowed; RGB_COLOR and INV_STERADIAN are");
  }
  if (rows.outputs == 1 && output == "INV_STERADIAN") return {{kMono, Part::kTotal, 0}};
  if (rows.outputs != 3) {
    fail(output + " with " + std::to_string(rows.outputs) +
         " values is not allowed: 3, or 1 of INV_STERADIAN");
  }
  if (output == "INV_STERADIAN") add_note(note, "three values without names: taken as R, G and B");
  return rgb_channels();
}

// The spec of a file without our description, but for its samples.
TableSpec foreign_spec(const AltaRows& rows, const std::string& name) {
  std::string note;
  TableSpec spec{{}, channels_of(rows, name, note), {}, {}};
  spec.provenance.note = std::move(note);
  return spec;
}

Table list_of(AltaRows rows, TableSpec spec, const std::string& name) {
  const AltaParametrisation& in = alta_parametrisation(rows.required("PARAM_IN", name), name);
  if (rows.inputs != in.dimension) {
    throw InputError(name + ": #DIM says " + std::to_string(rows.inputs) + " coordinates; " +
                     std::string(in.name) + " has " + std::to_string(in.dimension));
  }
  add_note(spec.provenance.note, in.assumed);
  if (rows.has_intervals) add_note(spec.provenance.note, "intervals of confidence were left out");
  PairList list{{}, in.isotropic};
  list.pairs.reserve(rows.count());
  std::vector<double> values;
  values.reserve(rows.count() * rows.outputs);
  for (std::size_t row = 0; row < rows.count(); ++row) {
    const std::span<const double> numbers = row_of(rows, row);
    const std::span<const double> coordinates = numbers.first(rows.inputs);
    std::optional<DirectionPair> pair;
    if (std::all_of(coordinates.begin(), coordinates.end(),
                    [](double x) { return std::isfinite(x); })) {
      pair = in.pair(coordinates);
    }
    if (!pair) fail_sample(name, row, "is no pair of directions in " + std::string(in.name));
    list.pairs.push_back(*pair);
    values.insert(values.end(), numbers.begin() + static_cast<std::ptrdiff_t>(rows.inputs),
                  numbers.end());
  }
  rows = {};
  spec.samples = std::move(list);
  std::vector<std::uint8_t> valid(spec.cell_count());
  for (std::size_t cell = 0; cell < valid.size(); ++cell) {
    valid[cell] = spec.node_above_horizon(cell) ? 1 : 0;
  }
  mask_not_measured(spec, values, valid);
  return {std::move(spec), std::move(values), std::move(valid)};
}

void require_same(const std::string& name, const std::string& key, const std::string& found,
                  std::string_view described) {
  if (found == described) return;
  throw InputError(name + ": #" + key + " is '" + one_line(found) + "'; by #CLOTHBRDF it must be " +
                   std::string(described));
}

void check_description(const AltaRows& rows, const TableSpec& spec, const std::string& name) {
  const AltaLayout layout(spec);
  require_same(name, "PARAM_IN", rows.required("PARAM_IN", name), layout.parametrisation());
  require_same(name, "PARAM_OUT", rows.required("PARAM_OUT", name), layout.output());
  require_same(name, "DIM", std::to_string(rows.inputs) + " " + std::to_string(rows.outputs),
               std::to_string(layout.dimension()) + " " + std::to_string(spec.channels.size()));
}

Table grid_of(const AltaRows& rows, TableSpec spec, const std::string& name) {
  const AltaLayout layout(spec);
  const std::size_t cells = spec.cell_count();
  if (cells / kMostCellsPerRow > rows.count()) {
    throw InputError(name + ": " + std::to_string(rows.count()) + " samples are too few for " +
                     spec.description());
  }
  const std::size_t columns = spec.column_count();
  std::vector<double> values(cells * rows.outputs);
  std::vector<std::uint8_t> valid(cells);
  const auto value_of = [&](std::size_t cell, std::size_t c) -> double& {
    return values[(cell / columns * rows.outputs + c) * columns + cell % columns];
  };
  for (std::size_t row = 0; row < rows.count(); ++row) {
    const std::span<const double> numbers = row_of(rows, row);
    const auto cell = layout.cell_at(numbers.first(rows.inputs));
    if (!cell) fail_sample(name, row, "is not at a node of " + spec.description());
    if (!layout.holds(*cell)) fail_sample(name, row, "is below the horizon");
    if (valid[*cell] != 0) fail_sample(name, row, "is there twice");
    valid[*cell] = 1;
    for (std::size_t c = 0; c < rows.outputs; ++c) value_of(*cell, c) = numbers[rows.inputs + c];
  }
  const std::vector<std::uint8_t> counts = cells_with_values(spec);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (valid[cell] != 0 || counts[cell] == 0) continue;
    // All is known of a cloth that was computed; a scene's table may have been resampled since.
    if (spec.provenance.material && !spec.reach) {
      throw InputError(name + ": the sample at " + spec.place(cell) + " is missing");
    }
    for (std::size_t c = 0; c < rows.outputs; ++c) value_of(cell, c) = kNotMeasured;
  }
  mask_not_measured(spec, values, valid);
  return {std::move(spec), std::move(values), std::move(valid)};
}

}  // namespace

Table read_alta(const std::filesystem::path& path) {
  const std::string name = path.string();
  AltaRows rows = parse_alta(file_bytes(path), name);
  const auto description = rows.keys.find("CLOTHBRDF");
  if (description == rows.keys.end()) {
    TableSpec spec = foreign_spec(rows, name);
    return list_of(std::move(rows), std::move(spec), name);
  }
  TableSpec spec = parse_table_metadata(description->second, name + ": #CLOTHBRDF");
  check_description(rows, spec, name);
  if (spec.has_grid()) return grid_of(rows, std::move(spec), name);
  return list_of(std::move(rows), std::move(spec), name);
}

}  // namespace clothbrdf
