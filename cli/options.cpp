#include "cli/options.h"

#include <charconv>
#include <cmath>
#include <span>
#include <sstream>

#include "model/parameters.h"
#include "support/errors.h"
#include "support/threads.h"

namespace clothbrdf {

Effects parse_effects(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  if (words.empty()) words.emplace_back();
  std::string problem;
  const std::optional<Effects> effects = effects_from_words(words, problem);
  if (!effects) throw InputError("--effects: " + problem);
  return *effects;
}

void add_effects_option(CLI::App& command, std::optional<std::string>& value,
                        const std::string& of) {
  add_text_option(
      command, "--effects", value, "LIST",
      "parts of the model" + (of.empty() ? of : " " + of) +
          ", joined by ',': specular, internal[:LAYERS], diffuse (naming any turns the unnamed "
          "ones "
          "off); interreflection:EVENTS; no-NAME leaves out one of near_side, interreflection, "
          "scatter, colour, second_yarn, anisotropy, shadowing; no-fresnel_angle=COSINE; all where "
          "left out");
}

CellRule parse_cells(const std::string& text) {
  if (text == "point") return {};
  CellRule rule{.average = true};
  if (text == "average") return rule;
  const std::string prefix = "average:";
  const char* end = text.data() + text.size();
  if (text.starts_with(prefix)) {
    const auto [next, error] = std::from_chars(text.data() + prefix.size(), end, rule.tolerance);
    if (error == std::errc() && next == end && rule.tolerance >= kTightestAverage &&
        rule.tolerance <= 1)
      return rule;
  }
  throw InputError(
      "--cells: '" + text +
      "' is not allowed: point, average or average:REL, REL the relative tolerance from 1e-6 to 1");
}

double parse_number(const std::string& option, const std::string& text, const NumberRange& range) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next != end || !(number >= range.lowest && number <= range.highest) ||
      (range.whole && number != std::floor(number))) {
    throw InputError(option + ": '" + text + "' is not allowed: a " +
                     (range.whole ? "whole " : "") + "number from " + number_text(range.lowest) +
                     " to " + number_text(range.highest));
  }
  return number;
}

int parse_threads(const std::string& text) {
  constexpr double kMost = 1024;
  return static_cast<int>(parse_number("--threads", text, {1, kMost, true}));
}

void add_text_option(CLI::App& command, const std::string& name, std::optional<std::string>& value,
                     const std::string& type, const std::string& help) {
  command
      .add_option_function<std::string>(
          name, [&value](const std::string& text) { value = text; }, help)
      ->type_name(type);
}

void add_threads_option(CLI::App& command, std::optional<std::string>& value) {
  add_text_option(command, "--threads", value, "N", "1 to 1024; all processors where left out");
}

int threads_of(const std::optional<std::string>& value) {
  return value ? parse_threads(*value) : default_threads();
}

SheetDirection parse_direction(const std::string& option, const std::string& text) {
  const char* const end = text.data() + text.size();
  SheetDirection direction;
  const auto [comma, error] = std::from_chars(text.data(), end, direction.theta_deg);
  if (error == std::errc() && comma != end && *comma == ',') {
    const auto [next, second_error] = std::from_chars(comma + 1, end, direction.phi_deg);
    if (second_error == std::errc() && next == end && direction.theta_deg >= 0 &&
        direction.theta_deg < 90 && std::isfinite(direction.phi_deg))
      return direction;
  }
  throw InputError(option + ": '" + text +
                   "' is not allowed: THETA,PHI in degrees, THETA from 0 to below 90");
}

std::string table_endings() {
  std::string known;
  for (const Format& format : formats()) {
    known += (known.empty() ? "" : ", ") + std::string(format.ending) + " (" +
             std::string(format.name) + ")";
  }
  return known;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  const auto canonical = [&](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  };
  return a == b || canonical(a) == canonical(b);
}

std::string with_commas(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

Table read_table(const std::string& file) { return format_for(file).read(file); }

void write_text(const std::string& text, AtomicFile& file) {
  file.write_at(0, std::as_bytes(std::span(text)));
}

std::string effects_text(const Effects& effects) {
  std::string text;
  for (const std::string& word : effect_words(effects)) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace clothbrdf
