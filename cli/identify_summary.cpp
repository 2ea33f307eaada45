#include <algorithm>

#include "cli/options.h"
#include "cli/report_text.h"
#include "table/table_spec.h"

namespace clothbrdf {
namespace {

std::string parameters_text(const IdentifyReport& report) {
  std::vector<std::vector<std::string>> rows = {
      {"parameter", "value", "predicted s.e.", "observed s.e.", "bias", "verdict"}};
  std::vector<Remark> remarks;
  for (const VerifiedParameter& p : report.parameters) {
    rows.push_back({p.name, with_unit(short_number(p.value, 5), p.unit),
                    short_number(p.predicted, 3), short_number(p.observed, 3),
                    short_number(p.bias, 2), std::string(verdict_text(p.verdict))});
    std::string words = p.reason;
    if (!p.remedy.empty()) add_note(words, "would settle it: " + p.remedy);
    add_remark(remarks, p.name, words);
  }
  return columns(rows) + remarks_text("why, and what would settle it", remarks);
}

std::string singular_values_text(const IdentifyReport& report) {
  if (report.singular_values.empty()) return "";
  const auto [least, most] =
      std::minmax_element(report.singular_values.begin(), report.singular_values.end());
  return labelled("sensitivity", "singular values from " + short_number(*most, 3) + " down to " +
                                     short_number(*least, 3) +
                                     " (changes of the table, in "
                                     "standard deviations of the noise)");
}

std::string profile_text(const Profile& profile) {
  const auto& points = profile.points;
  const auto by_value = [](const ProfilePoint& a, const ProfilePoint& b) {
    return a.value < b.value;
  };
  const auto by_chi2 = [](const ProfilePoint& a, const ProfilePoint& b) { return a.chi2 < b.chi2; };
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), by_value);
  const auto worst = std::max_element(points.begin(), points.end(), by_chi2);
  std::string text = profile.name + ": held from " + short_number(low->value) + " to " +
                     short_number(high->value) + ", chi2 rises by at most " +
                     short_number(worst->chi2, 3);
  std::vector<Remark> bounds;
  for (const ProfilePoint& point : points) {
    for (const std::string& name : point.at_bound)
      add_remark(bounds, short_number(point.value), name);
  }
  for (const Remark& bound : bounds) {
    text += "; " + bound.words + " sits at its bound at " + bound.names;
  }
  return paragraph(text);
}

std::string profiles_text(const IdentifyReport& report) {
  std::string text;
  for (const Profile& profile : report.profiles) {
    if (!profile.points.empty()) text += profile_text(profile);
  }
  return text.empty() ? "" : "  profile likelihoods\n" + text;
}

}  // namespace

std::string identify_summary(const std::string& file, const IdentifyReport& report,
                             const std::string& noise_source) {
  std::string text = file + ": " + report.grid + ", cells are " +
                     (report.cell_averages ? "averages" : "points") + ", " +
                     with_commas(report.values) + " values\n";
  text += labelled("noise", short_number(report.noise) + ", " + noise_source);
  text += labelled("refits", report.refits == 0
                                 ? "none: the prediction is not verified"
                                 : std::to_string(report.refits_converged) + " of " +
                                       std::to_string(report.refits) + " noisy tables converged");
  text += parameters_text(report) + singular_values_text(report);
  text += blind_text(report.blind, report.condition) + layers_text(report.layers);
  text += equivalents_text(report.equivalents) + profiles_text(report);
  if (!report.tried.empty()) {
    std::string tried;
    for (const std::string& other : report.tried) add_note(tried, other);
    text += labelled("tried", "what other measurements would settle: " + tried);
  }
  return text + labelled("time", short_number(report.seconds, 3) + " s");
}

}  // namespace clothbrdf
