#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/directions.h"
#include "model/effects.h"
#include "model/material.h"
#include "table/grid.h"
#include "table/reach.h"
#include "table/sampled_error.h"

namespace clothbrdf {

/// Which part of f_r a channel holds.
enum class Part { kTotal, kSpecular, kInternal, kDiffuse };

/// In the place of an absorption value's index: the channel is a sum over several of them.
inline constexpr std::size_t kNoColour = static_cast<std::size_t>(-1);

/// One channel of a table, for instance {"R", kTotal, 0}.
struct Channel {
  std::string name;  ///< R, G, B or, of a spectral material, the wavelength as "550nm"
  Part part = Part::kTotal;
  std::size_t colour;  ///< index of the material's absorption value, or kNoColour

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

/// How far a file is from what it was made of, as measured on what was written.
struct MeasuredError {
  TableError error;
  std::string reader;     ///< "nearest", "linear" or the rule of the format's own
  std::size_t pairs = 0;  ///< how many were compared
  bool of_mean = false;   ///< against the mean over rotations of the cloth, not the cloth itself

  bool operator==(const MeasuredError&) const = default;
};

/// Where the values come from.
struct Provenance {
  std::optional<Material> material;
  Effects effects;
  std::string program;    ///< "clothbrdf 0.1.0"; empty for measured data
  std::string note = {};  ///< for people: what a reader had to assume, or left out
  std::optional<MeasuredError> error = {};  ///< of the file; none once values were changed

  bool operator==(const Provenance&) const = default;
};

/// Adds to a note for people, after "; " where it has text; nothing where `more` is empty.
void add_note(std::string& note, std::string_view more);

/// Samples that lie on no grid: a cell, and a row, for each pair.
struct PairList {
  std::vector<DirectionPair> pairs;
  bool isotropic = false;  ///< values are means over rotations of the cloth

  bool operator==(const PairList&) const = default;
};

/// No samples of its own: what a format with nodes of its own is written from. Such a spec has no
/// cells, and its producer answers pairs.
struct AnyPairs {
  bool isotropic = false;  ///< values are means over rotations of the cloth

  bool operator==(const AnyPairs&) const = default;
};

using Samples = std::variant<Grid, PairList, AnyPairs>;

/// All of a table but its values. Values are f_r in 1/sr, without the cosine.
struct TableSpec {
  Samples samples;
  std::vector<Channel> channels;
  CellRule cells;
  Provenance provenance;
  /// Of a grid: the directions that its cells are for. Those that it does not reach, by
  /// ReachedCells, say nothing (tabulate writes 0); all count where it is left out.
  std::optional<Reach> reach = {};

  bool has_grid() const { return std::holds_alternative<Grid>(samples); }
  bool has_pairs() const { return std::holds_alternative<PairList>(samples); }
  const Grid& grid() const { return std::get<Grid>(samples); }
  const std::vector<DirectionPair>& pairs() const { return std::get<PairList>(samples).pairs; }

  /// Whether values are means over rotations of the cloth: no azimuth of a direction by itself
  /// counts.
  bool isotropic() const;

  std::size_t row_count() const;
  std::size_t column_count() const { return has_grid() ? grid().column_count() : 1; }
  std::size_t cell_count() const { return row_count() * column_count(); }

  /// Light and eye at a cell's node.
  Directions directions(std::size_t cell) const;
  /// Whether these are above the horizon.
  bool node_above_horizon(std::size_t cell) const;
  /// Where a cell's node is, for messages: "theta_h 0.25 theta_d 1 phi_d 90", in degrees.
  std::string place(std::size_t cell) const;
  /// "halfdiff3d:90x90x180", "8,192 pairs, isotropic".
  std::string description() const;

  /// Values of a row: column_count for each channel.
  std::size_t row_values() const { return column_count() * channels.size(); }

  bool operator==(const TableSpec&) const = default;
};

/// The channels of a material's table: its totals and, where asked, the three components after
/// them.
std::vector<Channel> material_channels(const Material& material, bool with_components);

/// R, G and B, totals only.
const std::vector<Channel>& rgb_channels();

/// The name of a wavelength's channel: "550nm"; "400_5nm" for 400.5, since picture formats read a
/// dot as the end of a layer's name.
std::string wavelength_name(double wavelength_nm);

/// The wavelength that a channel is named after, nm; none for other names.
std::optional<double> named_wavelength(const std::string& channel_name);

/// Name of a channel in files: "R", "specular.R".
std::string full_name(const Channel& channel);

}  // namespace clothbrdf
