#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/check_material.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "support/errors.h"
#include "table/check.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct CheckOptions {
  std::string file;
  std::optional<std::string> threads;
  bool json = false;
};

std::string where(const TableSpec& spec, const TableValue& at) {
  return full_name(spec.channels[at.channel]) + " at " + spec.place(at.cell);
}

std::string flaw_text(const TableSpec& spec, const Flaw& flaw, const char* which) {
  if (flaw.count == 0) return "none";
  return with_commas(flaw.count) + " values; " + which + " " + short_number(flaw.worst.value, 3) +
         " in " + where(spec, flaw.worst);
}

std::string reciprocity_text(const TableSpec& spec, const ReciprocityCheck& r) {
  if (r.by_construction) return "the grid stores one value for both orders of the directions";
  if (r.compared == 0) return "cannot be told: no cell's mirror image is a cell of the table";
  std::string text = "f(wi,wo) and f(wo,wi) differ by at most " + short_number(r.worst, 3);
  if (r.worst > 0) {
    text += " (" + short_number(r.here.value, 3) + " and " + short_number(r.mirrored, 3) + " in " +
            where(spec, r.here) + ")";
  }
  text += ", allowed " + short_number(r.allowed, 3);
  if (!r.promised) text += "; not promised by this table";
  return text;
}

std::string albedo_text(const TableSpec& spec, const Albedo& a) {
  const std::string of = a.of_eye ? "o " : "i ";
  return short_number(a.value, 3) + " at theta_" + of + short_number(a.theta_i_deg, 3) + " phi_" +
         of + short_number(a.phi_i_deg, 3) + " in " + full_name(spec.channels[a.channel]);
}

/// One line for each thing that is wrong.
std::vector<std::string> problems(const TableSpec& spec, const TableCheck& check) {
  std::vector<std::string> found;
  if (check.valid == 0) found.emplace_back("no cell is valid: nothing was measured");
  if (check.not_finite.count > 0) {
    found.push_back("not finite: " + flaw_text(spec, check.not_finite, "the first is"));
  }
  if (check.negative.count > 0) {
    found.push_back("negative: " + flaw_text(spec, check.negative, "the lowest is"));
  }
  if (check.reciprocity_broken()) {
    found.push_back("reciprocity: " + reciprocity_text(spec, check.reciprocity));
  }
  const std::optional<Albedo> largest = check.largest_albedo();
  if (largest && largest->value > kHighestAlbedo) {
    found.push_back("albedo: " + albedo_text(spec, *largest) + " is above " +
                    short_number(kHighestAlbedo, 3));
  }
  return found;
}

/// What is odd, but no fault of the table's.
std::vector<std::string> notes(const TableSpec& spec, const TableCheck& check) {
  std::vector<std::string> found;
  if (!spec.provenance.note.empty()) found.push_back(spec.provenance.note);
  if (check.not_reached > 0) {
    found.push_back(with_commas(check.not_reached) +
                    " cells above the horizon are not for the scene that the table was made for, "
                    "and do not count");
  }
  if (spec.reach) found.emplace_back("no albedo: a table for a scene lacks directions");
  if (check.masked > 0) {
    found.push_back(with_commas(check.masked) + " cells above the horizon are marked as not valid");
  }
  if (check.below_not_zero.count > 0) {
    found.push_back("cells below the horizon are not 0: " +
                    flaw_text(spec, check.below_not_zero, "the first is"));
  }
  const ReciprocityCheck& r = check.reciprocity;
  if (!r.promised && r.worst > r.allowed) {
    found.push_back("not reciprocal: " + reciprocity_text(spec, r));
  }
  for (const Albedo& a : check.albedo) {
    if (a.theta_i_deg > kHighestTheta && a.value > kHighestAlbedo) {
      found.push_back("albedo above 1 near grazing: " + albedo_text(spec, a));
    }
  }
  return found;
}

void print_text(const CheckOptions& options, const TableSpec& spec, const TableCheck& check) {
  const auto line = [](const char* name, const std::string& text) {
    std::cout << "  " << std::left << std::setw(18) << name << text << '\n';
  };
  std::cout << options.file << ": " << spec.description() << ", " << with_commas(check.cells)
            << " cells of " << spec.channels.size() << " channels\n";
  line("below the horizon", with_commas(check.below_horizon) + " cells");
  line("not finite", flaw_text(spec, check.not_finite, "the first is"));
  line("negative", flaw_text(spec, check.negative, "the lowest is"));
  line("reciprocity", reciprocity_text(spec, check.reciprocity));
  if (const std::optional<Albedo> largest = check.largest_albedo()) {
    line("largest albedo", albedo_text(spec, *largest));
  }
  if (!check.albedo.empty()) line("albedo", "theta_i  largest of channels and azimuths");
  for (const Albedo& a : check.albedo) {
    std::ostringstream row;
    row << std::right << std::setw(7) << a.theta_i_deg << "  " << std::left << std::setw(8)
        << short_number(a.value, 3) << full_name(spec.channels[a.channel])
        << (a.of_eye ? ", eye at phi_o " : ", phi_i ") << short_number(a.phi_i_deg, 3);
    line("", row.str());
  }
  for (const std::string& note : notes(spec, check)) line("note", note);
  const std::vector<std::string> wrong = problems(spec, check);
  for (const std::string& problem : wrong) line("WRONG", problem);
  if (wrong.empty()) line("result", "nothing wrong");
}

Json value_json(const TableSpec& spec, const TableValue& at) {
  return {{"value", at.value},
          {"channel", full_name(spec.channels[at.channel])},
          {"cell", at.cell},
          {"place", spec.place(at.cell)}};
}

Json flaw_json(const TableSpec& spec, const Flaw& flaw) {
  Json json = {{"count", flaw.count}};
  if (flaw.count > 0) json["worst"] = value_json(spec, flaw.worst);
  return json;
}

Json albedo_json(const TableSpec& spec, const Albedo& a) {
  Json json = {{"theta_i", a.theta_i_deg},
               {"phi_i", a.phi_i_deg},
               {"of", a.of_eye ? "eye" : "light"},
               {"channel", full_name(spec.channels[a.channel])},
               {"albedo", a.value}};
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    json["channels"][full_name(spec.channels[c])] = a.channels[c];
  }
  return json;
}

void print_json(const CheckOptions& options, const TableSpec& spec, const TableCheck& check) {
  Json json = {{"file", options.file},
               {"grid", spec.description()},
               {"cells", check.cells},
               {"below_horizon", check.below_horizon},
               {"masked", check.masked},
               {"not_reached", check.not_reached},
               {"not_finite", flaw_json(spec, check.not_finite)},
               {"negative", flaw_json(spec, check.negative)},
               {"below_horizon_not_zero", flaw_json(spec, check.below_not_zero)}};
  const ReciprocityCheck& r = check.reciprocity;
  json["reciprocity"] = {{"by_construction", r.by_construction},
                         {"promised", r.promised},
                         {"compared", r.compared},
                         {"worst", r.worst},
                         {"allowed", r.allowed}};
  if (r.worst > 0) {
    json["reciprocity"]["here"] = value_json(spec, r.here);
    json["reciprocity"]["mirrored"] = r.mirrored;
  }
  json["albedo"] = Json::array();
  for (const Albedo& a : check.albedo) json["albedo"].push_back(albedo_json(spec, a));
  if (const std::optional<Albedo> largest = check.largest_albedo()) {
    json["largest_albedo"] = albedo_json(spec, *largest);
  }
  json["notes"] = notes(spec, check);
  json["problems"] = problems(spec, check);
  std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void check(const CheckOptions& options) {
  const int threads = threads_of(options.threads);
  if (std::filesystem::path(options.file).extension() == ".json") {
    check_material(options.file, threads, options.json);
    return;
  }
  const Table table = read_table(options.file);
  ProgressBar bar;
  const TableCheck result = check_table(table, {threads, &bar.progress()});
  bar.clear();
  if (options.json) {
    print_json(options, table.spec(), result);
  } else {
    print_text(options, table.spec(), result);
  }
  const std::vector<std::string> wrong = problems(table.spec(), result);
  if (wrong.empty()) return;
  throw WorkError(options.file + ": " + wrong.front() +
                  (wrong.size() > 1 ? " (and " + std::to_string(wrong.size() - 1) + " more)" : ""));
}

}  // namespace

void add_check_command(CLI::App& program) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = program.add_subcommand(
      "check",
      "Looks for what is wrong in a table: values that are negative or no numbers, more light out "
      "than in, one value for light to eye and another for eye to light. Of a material, the errors "
      "of its values where numbers get difficult: grazing, opposite, on the crests of its lobes. "
      "Exits 1 if something is wrong.\n"
      "Examples: clothbrdf check silk.exr, clothbrdf check materials/silk.json");
  command->add_option("FILE", options->file, "table (" + table_endings() + ") or material (.json)")
      ->required()
      ->type_name("FILE");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "as one JSON object");
  command->callback([options] { check(*options); });
}

}  // namespace clothbrdf
