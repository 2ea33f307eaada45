#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fit/options.h"
#include "fit/report.h"
#include "table/table.h"

namespace clothbrdf {

// The options of fit and identify that say how to fit, from text to values.

/// --fix, --free, --start or --tie, as given.
struct WishText {
  ParameterWish::Kind kind;
  std::string text;
};

struct FitFlags {
  std::vector<WishText> wishes;  ///< in the order of the command line: later ones win
  std::optional<std::string> options;
  std::optional<std::string> layers;
  std::optional<std::string> paths;
  std::optional<std::string> reflectance;
  std::optional<std::string> noise;
  std::optional<std::string> weighting;
  std::optional<std::string> loss;
  std::optional<std::string> starts;
  std::optional<std::string> seed;

  /// The files that they read.
  std::vector<std::string> inputs() const;
};

/// Adds --fix, --free, --tie, --layers, --noise, --weighting and --seed. `flags` must live as long
/// as the command.
void add_parameter_options(CLI::App& command, FitFlags& flags);

/// Adds --reflectance and --paths.
void add_convention_options(CLI::App& command, FitFlags& flags);

/// Adds the others: --options, --start, --loss and --starts.
void add_solver_options(CLI::App& command, FitFlags& flags);

/// The options: those of the fit file, then those of the command line. Throws InputError that names
/// the option or the file, what was given and what is allowed, also where a name is that of no
/// parameter of a table with these channels.
FitOptions read_fit_options(const FitFlags& flags, const std::vector<Channel>& channels);

/// Reads a table of any format, without the components of f_r.
Table read_totals(const std::string& file);

/// Gives the materials of a fit the wavelengths that the table's channels are named after, "550nm",
/// where they have none: a material file needs them.
void add_wavelengths(const std::vector<Channel>& channels, FitReport& report);

}  // namespace clothbrdf
