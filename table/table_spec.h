#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/directions.h"
#include "model/effects.h"
#include "model/material.h"
#include "table/grid.h"

namespace clothbrdf {

/// Which part of f_r a channel holds.
enum class Part { kTotal, kSpecular, kInternal, kDiffuse };

/// One channel of a table, for instance {"R", kTotal, 0}.
struct Channel {
  std::string name;  ///< R, G, B or, of a spectral material, the wavelength as "550nm"
  Part part = Part::kTotal;
  std::size_t colour;  ///< index of the material's absorption value

  bool operator==(const Channel&) const = default;
};

/// Averages are never asked for more closely than this: the adaptive rules would take hours.
inline constexpr double kTightestAverage = 1e-6;

/// What the value of a cell is: f_r at its node or, with `average`, the mean of f_r over its part
/// above the horizon.
struct CellRule {
  bool average = false;
  double tolerance = 1e-3;  ///< of averages: relative, for each cell

  bool operator==(const CellRule&) const = default;
};

/// Where the values come from.
struct Provenance {
  std::optional<Material> material;
  Effects effects;
  std::string program;  ///< "clothbrdf 0.1.0"; empty for measured data

  bool operator==(const Provenance&) const = default;
};

/// All of a table but its values. Values are f_r in 1/sr, without the cosine.
struct TableSpec {
  std::variant<Grid, std::vector<DirectionPair>> samples;
  std::vector<Channel> channels;
  CellRule cells;
  Provenance provenance;

  bool has_grid() const { return std::holds_alternative<Grid>(samples); }
  const Grid& grid() const { return std::get<Grid>(samples); }
  const std::vector<DirectionPair>& pairs() const {
    return std::get<std::vector<DirectionPair>>(samples);
  }

  std::size_t row_count() const { return has_grid() ? grid().row_count() : pairs().size(); }
  std::size_t column_count() const { return has_grid() ? grid().column_count() : 1; }
  std::size_t cell_count() const { return row_count() * column_count(); }
  /// Values of a row: column_count for each channel.
  std::size_t row_values() const { return column_count() * channels.size(); }

  bool operator==(const TableSpec&) const = default;
};

/// The channels of a material's table: its totals and, where asked, the three components after
/// them.
std::vector<Channel> material_channels(const Material& material, bool with_components);

/// The wavelength that a channel is named after, nm; none for other names.
std::optional<double> named_wavelength(const std::string& channel_name);

/// Name of a channel in files: "R", "specular.R".
std::string full_name(const Channel& channel);

}  // namespace clothbrdf
