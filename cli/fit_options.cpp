#include "cli/fit_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "cli/options.h"
#include "fit/fit.h"
#include "formats/fit_file.h"
#include "formats/fit_names.h"
#include "formats/material_json.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Kind = ParameterWish::Kind;

std::optional<double> find_number(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

InputError not_allowed(const std::string& option, const std::string& text,
                       const std::string& allowed) {
  return InputError(option + ": '" + text + "' is not allowed: " + allowed);
}

/// The two texts of LO:HI; none without a colon.
std::optional<std::pair<std::string, std::string>> halves(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  return std::pair(text.substr(0, colon), text.substr(colon + 1));
}

const char* option_of(Kind kind) {
  switch (kind) {
    case Kind::kFix: return "--fix";
    case Kind::kFree: return "--free";
    case Kind::kStart: return "--start";
    case Kind::kTie: return "--tie";
  }
  return "";
}

const char* allowed_by(Kind kind) {
  switch (kind) {
    case Kind::kFix: return "NAME or NAME=VALUE, VALUE a number";
    case Kind::kFree: return "NAME or NAME=LO:HI, two numbers, LO below HI";
    case Kind::kStart: return "a material file or NAME=VALUE, VALUE a number";
    case Kind::kTie: return "NAME";
  }
  return "";
}

ParameterWish parse_wish(Kind kind, const std::string& text) {
  const std::size_t equals = text.find('=');
  ParameterWish wish{kind, text.substr(0, equals), {}, {}, {}};
  const InputError refusal = not_allowed(option_of(kind), text, allowed_by(kind));
  if (wish.name.empty()) throw refusal;
  if (equals == std::string::npos) return wish;
  const std::string value = text.substr(equals + 1);
  if (kind == Kind::kTie) throw refusal;
  if (kind == Kind::kFree) {
    const auto range = halves(value);
    if (!range) throw refusal;
    wish.lowest = find_number(range->first);
    wish.highest = find_number(range->second);
    if (!wish.lowest || !wish.highest || !(*wish.lowest < *wish.highest)) throw refusal;
  } else {
    wish.value = find_number(value);
    if (!wish.value) throw refusal;
  }
  return wish;
}

// A number never ends in .json.
bool names_file(const std::string& start) {
  return start.ends_with(".json") || start.find('=') == std::string::npos;
}

template <class T, std::size_t N>
T parse_choice(const std::string& option, const std::string& text, const ChoiceName<T> (&names)[N],
               bool or_both = false) {
  if (const std::optional<T> value = find_choice(names, text)) return *value;
  std::string known;
  for (const ChoiceName<T>& choice : names) {
    known += (known.empty() ? "" : ", ") + std::string(choice.name);
  }
  if (or_both) known += ", " + std::string(kBoth);
  throw not_allowed(option, text, known);
}

template <class T, std::size_t N>
std::vector<T> parse_choices(const std::string& option, const std::string& text,
                             const ChoiceName<T> (&names)[N]) {
  std::vector<T> values;
  if (text == kBoth) {
    for (const ChoiceName<T>& choice : names) values.push_back(choice.value);
  } else {
    values = {parse_choice(option, text, names, true)};
  }
  return values;
}

void parse_layers(const std::string& text, FitOptions& options) {
  const NumberRange range{0, kMostLayers, true};
  const auto counts = halves(text);
  if (!counts) throw not_allowed("--layers", text, "LO:HI, the fewest and the most layers");
  options.fewest_layers = static_cast<int>(parse_number("--layers", counts->first, range));
  options.most_layers = static_cast<int>(parse_number("--layers", counts->second, range));
  if (options.fewest_layers > options.most_layers) {
    throw not_allowed("--layers", text, "LO:HI, LO not above HI");
  }
}

void check_start(const FitOptions& options, std::size_t channels, const std::string& file) {
  if (options.start && options.start->channel_count() != channels) {
    throw InputError(
        file + ": /warp/absorption: " + std::to_string(options.start->channel_count()) +
        " values are not allowed: the table has " + std::to_string(channels) + " channels");
  }
}

// Its start's channels are checked once it is known which start counts.
FitOptions read_file(const FitFlags& flags, std::size_t channels) {
  if (!flags.options) return {};
  FitOptions options = read_fit_file(*flags.options);
  try {
    check_wishes(options, channels);
  } catch (const InputError& error) {  // names a parameter, but not the file
    throw InputError(*flags.options + ": /parameters: " + error.what());
  }
  return options;
}

void read_wishes(const FitFlags& flags, std::size_t channels, FitOptions& options) {
  std::optional<std::string> start;
  for (const auto& [kind, text] : flags.wishes) {
    if (kind != Kind::kStart || !names_file(text)) {
      options.wishes.push_back(parse_wish(kind, text));
    } else if (start) {
      throw InputError("--start: '" + text + "' is a second material; one is allowed");
    } else {
      start = text;
      options.start = read_material(text);
    }
  }
  const std::string source = start ? *start : flags.options ? *flags.options : "";
  check_start(options, channels, source);
  check_wishes(options, channels);
}

std::size_t total_count(const std::vector<Channel>& channels) {
  return static_cast<std::size_t>(std::count_if(channels.begin(), channels.end(),
                                                [](auto& c) { return c.part == Part::kTotal; }));
}

/// None where a channel is not named after its wavelength.
std::vector<double> wavelengths_of(const std::vector<Channel>& channels) {
  std::vector<double> wavelengths;
  for (const Channel& channel : channels) {
    const std::optional<double> wavelength = named_wavelength(channel.name);
    if (!wavelength) return {};
    wavelengths.push_back(*wavelength);
  }
  return wavelengths;
}

void add_wish_option(CLI::App& command, FitFlags& flags, Kind kind, const std::string& type,
                     const std::string& help) {
  // Called for each value as it comes: the order among all such options counts.
  command
      .add_option_function<std::string>(
          option_of(kind),
          [&flags, kind](const std::string& text) {
            flags.wishes.push_back({kind, text});
          },
          help + ", repeatable")
      ->trigger_on_parse()
      ->type_name(type);
}

}  // namespace

std::vector<std::string> FitFlags::inputs() const {
  std::vector<std::string> files;
  if (options) files.push_back(*options);
  for (const auto& [kind, text] : wishes) {
    if (kind == Kind::kStart && names_file(text)) files.push_back(text);
  }
  return files;
}

void add_parameter_options(CLI::App& command, FitFlags& flags) {
  add_wish_option(
      command, flags, Kind::kFix, "NAME[=VALUE]",
      "does not fit a parameter, warp.scatter, or all that a part of a name stands "
      "for, warp or absorption; at its start where no value is given. layers, and those "
      "that a yarn's name stands for, are 3 where there is no start");
  add_wish_option(command, flags, Kind::kFree, "NAME[=LO:HI]",
                  "fits it, between these values where they are given; of several wishes for one "
                  "parameter the last counts");
  add_wish_option(command, flags, Kind::kTie, "NAME",
                  "the weft's value is the warp's; weft stands for all of it, its layers too");
  add_text_option(command, "--layers", flags.layers, "LO:HI",
                  "layer counts to try, 0 to 64; 0:8 where left out");
  add_text_option(command, "--noise", flags.noise, "X",
                  "standard deviation of a value, in units of the weighting: 0.01 is 1 % of it");
  add_text_option(command, "--weighting", flags.weighting, "W",
                  "what one unit of misfit is: relative (a share of the value, the default), "
                  "absolute (1/sr) or logarithmic");
  add_text_option(command, "--seed", flags.seed, "N",
                  "of all random numbers; the same seed gives the same result; 1 where left out");
}

void add_convention_options(CLI::App& command, FitFlags& flags) {
  add_text_option(command, "--reflectance", flags.reflectance, "R",
                  "microfacet, paper or both (the default: each is fitted, the best reported)");
  add_text_option(command, "--paths", flags.paths, "P",
                  "all, single or both (the default: each is fitted, the best reported)");
}

void add_solver_options(CLI::App& command, FitFlags& flags) {
  add_text_option(command, "--options", flags.options, "FITFILE",
                  "fit file (JSON) that sets all of this; the command line goes before it");
  add_wish_option(command, flags, Kind::kStart, "FILE | NAME=VALUE",
                  "starts from a material file (.json), or one parameter from a value");
  add_text_option(command, "--loss", flags.loss, "L",
                  "how much outliers count: squared (the default), huber or cauchy");
  add_text_option(
      command, "--starts", flags.starts, "N",
      "scattered starts where no start is given, 1 to 10000; 24 where left out. Up to four "
      "times as many are made while the best fit does not match the data");
}

FitOptions read_fit_options(const FitFlags& flags, const std::vector<Channel>& channels) {
  const std::size_t count = total_count(channels);
  FitOptions options = read_file(flags, count);
  if (flags.layers) parse_layers(*flags.layers, options);
  if (flags.reflectance) {
    options.reflectances = parse_choices("--reflectance", *flags.reflectance, kReflectanceNames);
  }
  if (flags.paths) options.paths = parse_choices("--paths", *flags.paths, kPathsNames);
  if (flags.noise) {
    options.noise = parse_number("--noise", *flags.noise, {kLeastNoise, kMostNoise, false});
  }
  if (flags.weighting) {
    options.weighting = parse_choice("--weighting", *flags.weighting, kWeightingNames);
  }
  if (flags.loss) options.loss = parse_choice("--loss", *flags.loss, kLossNames);
  if (flags.starts) {
    options.starts =
        static_cast<int>(parse_number("--starts", *flags.starts, {1, kMostStarts, true}));
  }
  if (flags.seed) {
    options.seed =
        static_cast<std::uint64_t>(parse_number("--seed", *flags.seed, {0, kLargestSeed, true}));
  }
  read_wishes(flags, count, options);
  return options;
}

Table read_totals(const std::string& file) {
  Table table = read_table(file);
  const std::vector<Channel>& channels = table.spec().channels;
  return total_count(channels) == channels.size() ? table : without_components(table);
}

void add_wavelengths(const std::vector<Channel>& channels, FitReport& report) {
  const std::vector<double> wavelengths = wavelengths_of(channels);
  const auto add = [&](Material& material) {
    if (material.wavelengths_nm.empty()) material.wavelengths_nm = wavelengths;
  };
  add(report.material);
  for (Equivalent& equivalent : report.equivalents) add(equivalent.material);
}

}  // namespace clothbrdf
