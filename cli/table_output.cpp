#include "cli/table_output.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "cli/measured_error.h"
#include "cli/options.h"
#include "cli/plan_text.h"
#include "formats/format_colours.h"
#include "table/table.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

// "1,234 cells are for the scene, the others hold 0"; nothing where all above the horizon are.
std::string reach_note(TableSpec spec, const Format& format) {
  if (!spec.reach) return "";
  const auto count = [&] {
    const std::vector<std::uint8_t> cells = cells_with_values(spec);
    return std::count(cells.begin(), cells.end(), 1);
  };
  const auto reached = static_cast<std::size_t>(count());
  spec.reach.reset();
  if (static_cast<std::size_t>(count()) == reached) return "";
  return with_commas(reached) + " cells are for the scene, the others hold 0" +
         (format.keeps_description ? "" : ", which this format cannot tell from values");
}

std::string what_is_lost(const Material& material, const TableSpec& computed,
                         const TableSpec& written, const Format& format) {
  std::vector<std::string> lost;
  if (written.isotropic()) lost.emplace_back("isotropic: the mean over phi_h");
  const bool folded = written.has_grid() && written.grid().folds_orders();
  if (material.reflectance == Reflectance::kPaper && folded) {
    lost.emplace_back("not reciprocal: the mean of both orders of the directions");
  }
  if (!format.averages.empty()) lost.emplace_back(format.averages);
  if (const std::string colours = colours_note(computed, written); !colours.empty()) {
    lost.push_back(colours);
  }
  std::string note;
  for (const std::string& what : lost) add_note(note, what);
  return note;
}

void report_json(const TableOutput& output, const Json& cost) {
  const Layout layout = output.order.format->layout(output.spec, output.setting.options);
  Json line = {{"file", output.order.name},
               {"format", output.order.format->name},
               {"grid", layout.description},
               {"cells", layout.cells},
               {"channels", output.spec.channels.size()}};
  line.update(cost);
  if (output.plan) {
    line["material"] = output.plan->material.name;
    line["effects"] = effect_words(output.plan->effects);
    line["bound"] = output.plan->bound;
  }
  if (!output.note.empty()) line["note"] = output.note;
  std::cout << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void report_text(const TableOutput& output, const std::string& cost) {
  const Layout layout = output.order.format->layout(output.spec, output.setting.options);
  std::cout << output.order.name << ": " << output.order.format->name << ' ' << layout.description
            << (output.setting.options.half ? " of half floats" : "") << ", "
            << with_commas(layout.cells) << " cells of " << output.spec.channels.size()
            << " channels, " << cost;
  if (!output.note.empty()) std::cout << " (" << output.note << ')';
  std::cout << '\n';
}

std::string cost_text(std::uint64_t bytes, double seconds) {
  std::ostringstream text;
  text << with_commas(bytes) << " bytes in " << std::setprecision(3) << seconds << " s";
  return text.str();
}

}  // namespace

void describe(TableOutput& output) {
  const FileOrder& order = output.order;
  const TableSpec computed = computed_spec(order, output.setting);
  output.spec = in_colours_of(*order.format, computed, output.setting.options);
  output.note = what_is_lost(order.material, computed, output.spec, *order.format);
  if (!output.plan) return;
  for (const std::string& more :
       {reach_note(output.spec, *order.format), left_out_text(*output.plan)}) {
    add_note(output.note, more);
  }
}

void report_written(const TableOutput& output, std::uint64_t bytes, double seconds, bool as_json) {
  if (as_json) {
    Json cost = {{"bytes", bytes}, {"seconds", seconds}};
    if (output.error) cost["error"] = error_json(*output.error);
    report_json(output, cost);
  } else {
    report_text(output, cost_text(bytes, seconds) +
                            (output.error ? "; " + error_text(*output.error) : std::string()));
  }
}

void report_expected(const TableOutput& output, const Prediction& expected, bool as_json) {
  const bool mean_only = expected.isotropy_loss > 0;
  if (as_json) {
    Json predicted = {{"seconds", expected.seconds},
                      {"bytes", expected.bytes},
                      {"error", error_json(expected.error)}};
    if (mean_only) predicted["isotropy_loss"] = expected.isotropy_loss;
    report_json(output, {{"predicted", predicted}});
    return;
  }
  std::ostringstream text;
  text << "not written (dry run); expected: " << cost_text(expected.bytes, expected.seconds) << "; "
       << error_text(expected.error) << std::setprecision(3);
  if (mean_only) text << "; the mean over rotations loses " << expected.isotropy_loss << " rms";
  report_text(output, text.str());
}

}  // namespace clothbrdf
