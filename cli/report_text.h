#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/report.h"

namespace clothbrdf {

// How reports of fits are shown to people, at most kReportColumns wide.
inline constexpr std::size_t kReportColumns = 100;

/// "0.1235", "1.2e-05".
std::string short_number(double value, int digits = 4);
/// The same; "-" where there is none.
std::string short_number(const std::optional<double>& value, int digits = 4);

/// "0.42%", three digits; "infinite".
std::string percent(double share);

/// "0.06 deg"; the unit 1 is left out.
std::string with_unit(const std::string& text, const std::string& unit);

/// Rows in aligned columns, indented by 4.
std::string columns(const std::vector<std::vector<std::string>>& rows);

/// "  label       text", the text broken into as many lines as it needs.
std::string labelled(const std::string& label, const std::string& text);

/// A text under a heading, broken into lines, indented by 4.
std::string paragraph(const std::string& text);

/// What is said of several parameters, once: "warp.scatter, weft.scatter: ...".
struct Remark {
  std::string names;
  std::string words;
};
/// Adds a remark on a parameter to those that are there; one without words is left out.
void add_remark(std::vector<Remark>& remarks, const std::string& name, const std::string& words);
std::string remarks_text(const std::string& heading, const std::vector<Remark>& remarks);

/// The parts that both reports have; empty where there is nothing to say.
std::string blind_text(const std::vector<BlindDirection>& blind, double condition);
std::string equivalents_text(const std::vector<Equivalent>& equivalents);
std::string layers_text(const LayerProfile& layers);

/// The summary of a fit, and of a look at what can be identified.
std::string fit_summary(const FitReport& report);
std::string identify_summary(const std::string& file, const IdentifyReport& report,
                             const std::string& noise_source);

}  // namespace clothbrdf
