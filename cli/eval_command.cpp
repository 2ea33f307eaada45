#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/options.h"
#include "formats/material_json.h"
#include "formats/plan_json.h"
#include "model/reflectance.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

struct EvalOptions {
  std::string material;
  std::string pairs = "-";
  std::optional<std::string> effects;
  std::optional<std::string> plan;
};

// 17 significant digits: reads back to the same bits.
void append_number(std::string& out, double value) {
  char buffer[40];
  out.append(
      buffer,
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17).ptr);
}

void append_array(std::string& out, const char* key, const std::vector<double>& values) {
  out.append("\"").append(key).append("\":[");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    append_number(out, values[i]);
  }
  out += ']';
}

std::string json_line(const DirectionPair& pair, const Components& f) {
  std::vector<double> total;
  for (std::size_t c = 0; c < f.specular.size(); ++c) total.push_back(f.total(c));
  std::string out = "{";
  append_array(out, "wi", {pair.theta_i, pair.phi_i});
  append_array(out += ',', "wo", {pair.theta_o, pair.phi_o});
  out += ",\"f_r\":{";
  append_array(out, "specular", f.specular);
  append_array(out += ',', "internal", f.internal);
  append_array(out += ',', "diffuse", f.diffuse);
  append_array(out += ',', "total", total);
  return out += "}}\n";
}

// As messages show what was given, however long it is.
std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  return "'" + std::string(text.substr(0, kLongest)) + (text.size() > kLongest ? "..." : "") + "'";
}

// A line of four angles; none for an empty line or a comment.
std::optional<DirectionPair> parse_pair(const std::string& line, const std::string& where) {
  const auto fail = [&](const std::string& what) {
    return InputError(where + ": " + what + "; a pair is 'theta_i phi_i theta_o phi_o' in degrees");
  };
  double angles[4];
  std::size_t count = 0;
  const char* at = line.data();
  const char* const end = at + line.size();
  while (true) {
    while (at != end && std::isspace(static_cast<unsigned char>(*at)) != 0) ++at;
    if (at == end || (*at == '#' && count == 0)) break;
    if (count == 4) throw fail("more than four values");
    const char* stop = std::find_if(at, end, [](unsigned char c) { return std::isspace(c) != 0; });
    const std::string_view word(at, stop);
    // from_chars takes no plus sign.
    const char* const digits = word.starts_with('+') && !word.starts_with("+-") ? at + 1 : at;
    const auto [next, error] = std::from_chars(digits, stop, angles[count]);
    if (error != std::errc() || next != stop || !std::isfinite(angles[count])) {
      throw fail(quoted(word) + " is not a finite number");
    }
    if (count % 2 == 0 && (angles[count] < 0 || angles[count] > 180)) {
      throw fail(std::string(count == 0 ? "theta_i " : "theta_o ") + quoted(word) +
                 " is not allowed: 0 to 180");
    }
    at = stop;
    ++count;
  }
  if (count == 0) return std::nullopt;
  if (count < 4) throw fail("only " + std::to_string(count) + (count == 1 ? " value" : " values"));
  return DirectionPair{angles[0], angles[1], angles[2], angles[3]};
}

Effects planned_effects(const EvalOptions& options, const Material& material) {
  const Plan plan = read_plan(*options.plan);
  std::string names;
  for (const MaterialPlan& known : plan.materials) {
    if (known.material == material) return known.effects;
    const std::string& name = known.material.name;
    names += (names.empty() ? "" : ", ") + (name.empty() ? "one without a name" : name);
  }
  throw InputError(options.material + ": is no material of " + *options.plan +
                   ", which plans: " + names);
}

Effects effects_of(const EvalOptions& options, const Material& material) {
  if (options.plan && options.effects) {
    throw InputError("--effects: not with --plan, which has its own");
  }
  if (options.plan) return planned_effects(options, material);
  return options.effects ? parse_effects(*options.effects) : Effects{};
}

void eval(const EvalOptions& options) {
  const Material material = read_material(options.material);
  const ClothModel<double> model(material, effects_of(options, material));
  std::ifstream file;
  const bool standard_input = options.pairs == "-";
  if (!standard_input) {
    if (std::filesystem::is_directory(options.pairs))
      throw InputError(options.pairs + ": is a directory; a file of pairs is needed");
    file.open(options.pairs);
    if (!file) throw InputError(options.pairs + ": cannot be read: " + std::strerror(errno));
  } else if (::isatty(STDIN_FILENO) != 0) {
    std::cerr
        << "Reading pairs 'theta_i phi_i theta_o phi_o' in degrees, one a line; Ctrl-D ends.\n";
  }
  std::istream& in = standard_input ? std::cin : file;
  // Whoever types or pipes line by line gets each answer before the next line is awaited.
  in.tie(&std::cout);
  const std::string name = standard_input ? "standard input" : options.pairs;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::optional<DirectionPair> pair =
        parse_pair(line, name + ": line " + std::to_string(number));
    if (!pair) continue;
    std::cout << json_line(*pair, model.evaluate(pair_geometry(*pair, material.rotation_deg)));
    if (!std::cout) throw WorkError("cannot write to standard output");
  }
  if (in.bad()) throw WorkError(name + ": cannot read");
}

}  // namespace

void add_eval_command(CLI::App& program) {
  const auto options = std::make_shared<EvalOptions>();
  CLI::App* command = program.add_subcommand(
      "eval",
      "Exact f_r (1/sr, without the cosine), component by component, as one JSON object a line.\n"
      "Example: echo '30 0 45 180' | clothbrdf eval materials/silk.json");
  command->add_option("MATERIAL", options->material, "material file (JSON)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--pairs", options->pairs,
                   "file of direction pairs, 'theta_i phi_i theta_o phi_o' in degrees, one a line; "
                   "'#' starts a "
                   "comment line; - is standard input, the default")
      ->type_name("FILE");
  add_effects_option(*command, options->effects);
  add_text_option(*command, "--plan", options->plan, "PLAN",
                  "just what this plan of a scene (clothbrdf plan) keeps of the material");
  command->add_flag("--json")->description(
      "the output is always JSON; accepted so that all commands take it");
  command->callback([options] { eval(*options); });
}

}  // namespace clothbrdf
