#include "cli/sweep_option.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/options.h"
#include "formats/fit_names.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr double kMostSteps = 100;
// Log-spaced values need a lowest one; less absorbs nothing that a table shows.
constexpr double kLeastAbsorption = 1e-9;
constexpr double kMostAbsorption = 1e6;

InputError refusal(const std::string& text) {
  return InputError("--sweep: '" + text +
                    "' is not allowed: absorption=LO:HI:N,noise=LO:HI:N, LO below HI");
}

std::vector<double> log_spaced(double low, double high, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / (count - 1)));
  }
  values.back() = high;
  return values;
}

std::vector<double> parse_range(const std::string& text, const std::string& range, double lowest,
                                double highest) {
  std::istringstream parts(range);
  std::vector<std::string> fields;
  for (std::string field; std::getline(parts, field, ':');) fields.push_back(field);
  if (fields.size() != 3 || range.ends_with(':')) throw refusal(text);
  const double low = parse_number("--sweep", fields[0], {lowest, highest, false});
  const double high = parse_number("--sweep", fields[1], {lowest, highest, false});
  const double count = parse_number("--sweep", fields[2], {2, kMostSteps, true});
  if (!(low < high)) throw refusal(text);
  return log_spaced(low, high, static_cast<int>(count));
}

}  // namespace

Sweep parse_sweep(const std::string& text) {
  if (text.ends_with(',')) throw refusal(text);
  Sweep sweep;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) throw refusal(text);
    const std::string name = part.substr(0, equals);
    const std::string range = part.substr(equals + 1);
    if (name == "absorption" && sweep.absorptions.empty()) {
      sweep.absorptions = parse_range(text, range, kLeastAbsorption, kMostAbsorption);
    } else if (name == "noise" && sweep.noises.empty()) {
      sweep.noises = parse_range(text, range, kLeastNoise, kMostNoise);
    } else {
      throw refusal(text);
    }
  }
  if (sweep.absorptions.empty() || sweep.noises.empty()) throw refusal(text);
  return sweep;
}

std::string sweep_csv(const std::vector<SweepCell>& cells) {
  std::string text = "absorption,noise,told_layers\n";
  for (const SweepCell& cell : cells) {
    text += number_text(cell.absorption) + "," + number_text(cell.noise) + "," +
            std::to_string(cell.told_layers) + "\n";
  }
  return text;
}

std::string sweep_json(const std::vector<SweepCell>& cells) {
  nlohmann::ordered_json json = {{"cells", nlohmann::ordered_json::array()}};
  for (const SweepCell& cell : cells) {
    json["cells"].push_back({{"absorption", cell.absorption},
                             {"noise", cell.noise},
                             {"told_layers", cell.told_layers}});
  }
  return json.dump() + "\n";
}

}  // namespace clothbrdf
