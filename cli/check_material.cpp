#include "cli/check_material.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "formats/material_json.h"
#include "support/errors.h"
#include "tabulate/precision_check.h"

namespace clothbrdf {
namespace {

std::string pair_text(const DirectionPair& pair) {
  constexpr int kAllDigits = 17;
  const auto degrees = [](double angle) { return short_number(angle, kAllDigits); };
  return "light " + degrees(pair.theta_i) + "," + degrees(pair.phi_i) + " eye " +
         degrees(pair.theta_o) + "," + degrees(pair.phi_o);
}

std::string worst_text(const PrecisionFigure& f) {
  return full_name(f.channel) + " " + short_number(f.value) + ", exactly " + short_number(f.exact) +
         ", at " + pair_text(f.pair);
}

void print_figures(const std::string& file, std::size_t pairs,
                   const std::vector<PrecisionFigure>& figures) {
  std::cout << file << ": " << pairs << " hard pairs of directions, against extended precision\n";
  std::vector<std::vector<std::string>> rows = {
      {"evaluation", "values", "worst error", "share of the promised"}};
  for (const PrecisionFigure& f : figures) {
    rows.push_back(
        {f.evaluation, with_commas(f.compared), short_number(f.worst, 2), percent(f.worst_share)});
  }
  std::cout << columns(rows);
  for (const PrecisionFigure& f : figures) {
    std::cout << labelled(f.evaluation, "worst: error " + short_number(f.error, 2) + " of " +
                                            short_number(f.promised, 2) + " promised, in " +
                                            worst_text(f));
  }
}

nlohmann::ordered_json figures_json(const std::string& file, std::size_t pairs,
                                    const std::vector<PrecisionFigure>& figures) {
  nlohmann::ordered_json json = {{"file", file}, {"pairs", pairs}};
  json["evaluations"] = nlohmann::ordered_json::array();
  for (const PrecisionFigure& f : figures) {
    json["evaluations"].push_back({{"evaluation", f.evaluation},
                                   {"values", f.compared},
                                   {"worst_error", f.worst},
                                   {"worst_share", f.worst_share},
                                   {"error", f.error},
                                   {"promised", f.promised},
                                   {"channel", full_name(f.channel)},
                                   {"theta_i", f.pair.theta_i},
                                   {"phi_i", f.pair.phi_i},
                                   {"theta_o", f.pair.theta_o},
                                   {"phi_o", f.pair.phi_o},
                                   {"value", f.value},
                                   {"exact", f.exact}});
  }
  return json;
}

}  // namespace

void check_material(const std::string& file, int threads, bool json) {
  const Material material = read_material(file);
  const std::vector<DirectionPair> pairs = hard_pairs(material);
  ProgressBar bar;
  const std::vector<PrecisionFigure> figures =
      check_precision(material, pairs, {threads, &bar.progress()});
  bar.clear();
  if (json) {
    std::cout << figures_json(file, pairs.size(), figures).dump() << '\n';
  } else {
    print_figures(file, pairs.size(), figures);
  }
  for (const PrecisionFigure& f : figures) {
    if (f.worst_share <= 1) continue;
    throw WorkError(file + ": " + f.evaluation + ": the error " + short_number(f.error, 2) +
                    " is above the promised " + short_number(f.promised, 2) + ", in " +
                    worst_text(f));
  }
}

}  // namespace clothbrdf
