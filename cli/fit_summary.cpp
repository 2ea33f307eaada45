#include <algorithm>

#include "cli/options.h"
#include "cli/report_text.h"
#include "formats/fit_names.h"

namespace clothbrdf {
namespace {

std::string header(const FitReport& report) {
  const std::string cells = report.cell_averages ? "averages" : "points";
  return report.table + ": " + report.grid + ", cells are " + cells + "\n" +
         labelled("values", with_commas(report.values) + " fitted; left out: " +
                                with_commas(report.masked) + " that are negative or not finite, " +
                                with_commas(report.below_horizon) + " below the horizon");
}

std::string solver_text(const FitReport& report) {
  std::string text = (report.converged ? "" : "NOT CONVERGED: ") + report.termination + " after " +
                     std::to_string(report.iterations) + " iterations";
  if (!report.message.empty()) text += ": " + report.message;
  return labelled("solver", text);
}

std::string unit_of(const FitReport& report) {
  if (report.weighting == choice_name(kWeightingNames, Weighting::kAbsolute)) return "1/sr";
  if (report.weighting == choice_name(kWeightingNames, Weighting::kLogarithmic)) {
    return "of the logarithm";
  }
  return "of the value";
}

std::string misfit_text(const FitReport& report) {
  const std::string unit = unit_of(report);
  return labelled("noise",
                  short_number(report.noise) + " " + unit +
                      (report.noise_estimated ? ", estimated from the residual" : ", as given")) +
         labelled("misfit", "rms " + short_number(report.residual_rms) + " " + unit + ", chi2 " +
                                short_number(report.chi2, 6) + "; " + report.weighting +
                                " weighting, " + report.loss + " loss");
}

std::string conventions_text(const FitReport& report) {
  if (report.conventions.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"reflectance", "paths", "chi2 above best", ""}};
  const double best =
      std::min_element(report.conventions.begin(), report.conventions.end(), [](auto& a, auto& b) {
        return a.chi2 < b.chi2;
      })->chi2;
  for (const ConventionFit& fit : report.conventions) {
    rows.push_back({std::string(choice_name(kReflectanceNames, fit.reflectance)),
                    std::string(choice_name(kPathsNames, fit.paths)), short_number(fit.chi2 - best),
                    fit.chosen ? "chosen"
                    : fit.told ? "the table tells it from the chosen one"
                               : "the table cannot tell it from the chosen one"});
  }
  return "  conventions\n" + columns(rows);
}

std::string parameters_text(const FitReport& report) {
  std::vector<std::vector<std::string>> rows = {
      {"parameter", "estimate", "std. error", "start", "bounds", "verdict"}};
  std::vector<Remark> remarks;
  for (const ParameterEstimate& p : report.parameters) {
    rows.push_back({p.name, short_number(p.value, 5), short_number(p.standard_error, 2),
                    short_number(p.start),
                    with_unit(short_number(p.lowest) + " to " + short_number(p.highest), p.unit),
                    std::string(verdict_text(p.verdict))});
    add_remark(remarks, p.name, p.reason);
  }
  return columns(rows) + remarks_text("why", remarks);
}

std::string starts_text(const FitReport& report) {
  if (report.starts == 0) return "";
  std::string text = std::to_string(report.starts_at_best) + " of " +
                     std::to_string(report.starts) + " scattered ones reached the best optimum";
  const auto best = std::min_element(report.optima.begin(), report.optima.end(),
                                     [](auto& a, auto& b) { return a.chi2 < b.chi2; });
  std::string others;
  for (auto at = report.optima.begin(); at != report.optima.end(); ++at) {
    if (at == best) continue;
    others += others.empty() ? "; others ended higher by chi2 " : ", ";
    others += short_number(at->chi2 - best->chi2) + " (" + std::to_string(at->starts) +
              ", layers " + std::to_string(at->warp_layers) + "/" +
              std::to_string(at->weft_layers) + ")";
  }
  return labelled("starts", text + others);
}

std::string residuals_text(const FitReport& report) {
  if (report.residuals.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"largest there", "larger theta", "values", "rms", "mean (table - fit) / fit"}};
  for (const RegionResidual& r : report.residuals) {
    rows.push_back({r.component, r.region, with_commas(r.values), short_number(r.rms, 3),
                    short_number(r.mean, 3)});
  }
  return "  residuals\n" + columns(rows);
}

}  // namespace

std::string fit_summary(const FitReport& report) {
  std::string text = header(report);
  if (!report.failure.empty()) return text + labelled("failure", report.failure);
  text += solver_text(report) + misfit_text(report) + conventions_text(report);
  if (report.one_yarn) {
    text += labelled("yarns", "two fit no better than this cloth of one: both are reported equal");
  }
  for (const std::string& note : report.notes) text += labelled("note", note);
  text += parameters_text(report) + blind_text(report.blind, report.condition);
  text += layers_text(report.layers) + starts_text(report) + equivalents_text(report.equivalents);
  text += residuals_text(report);
  return text + labelled("time", short_number(report.seconds, 3) + " s, " +
                                     with_commas(report.rows) + " rows after compression");
}

}  // namespace clothbrdf
