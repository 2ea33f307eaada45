#include "cli/cost_text.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/options.h"
#include "cli/report_text.h"

namespace clothbrdf {
namespace {

constexpr int kDigits = 3;

// "1.52" or "1.52 (1.4-1.7)".
std::string time_text(const Timing& timing) {
  std::string median = short_number(timing.median, kDigits);
  if (timing.lowest == timing.highest) return median;
  return median + " (" + short_number(timing.lowest, 2) + "-" + short_number(timing.highest, 2) +
         ")";
}

// "2.1M"; powers of 1000, as disks are sold.
std::string bytes_text(const std::optional<std::uint64_t>& bytes) {
  if (!bytes) return "-";
  double number = static_cast<double>(*bytes);
  constexpr std::string_view kUnits = "kMGT";
  std::size_t unit = 0;
  for (; number >= 999.5 && unit < kUnits.size(); ++unit) number /= 1000;
  const std::string text = short_number(number, kDigits);
  return unit == 0 ? text : text + kUnits[unit - 1];
}

std::string front_text(const CostReport& report, const std::string& front) {
  std::vector<const CostSetting*> settings;
  for (const CostSetting& setting : report.settings) {
    if (setting.front == front) settings.push_back(&setting);
  }
  if (settings.empty()) return "";
  std::stable_sort(settings.begin(), settings.end(), [](const auto* a, const auto* b) {
    return a->seconds.median < b->seconds.median;
  });
  const auto any = [&](const auto& has) {
    return std::any_of(settings.begin(), settings.end(), has);
  };
  const bool losses = any([](const auto* s) { return s->isotropy_loss.has_value(); });
  const bool files = any([](const auto* s) { return s->bytes || s->peak_memory; });
  std::vector<std::string> head = {"", "rms", "p99", "max"};
  if (losses) head.emplace_back("isotropy");
  head.emplace_back("seconds");
  if (files) head.insert(head.end(), {"bytes", "memory"});
  head.emplace_back("setting");
  std::vector<std::vector<std::string>> rows = {head};
  for (const CostSetting* setting : settings) {
    std::vector<std::string> row = {setting->pareto ? "*" : "", percent(setting->error.rms),
                                    percent(setting->error.p99), percent(setting->error.max)};
    if (losses) row.push_back(setting->isotropy_loss ? percent(*setting->isotropy_loss) : "-");
    row.push_back(time_text(setting->seconds));
    if (files) {
      row.insert(row.end(), {bytes_text(setting->bytes), bytes_text(setting->peak_memory)});
    }
    row.push_back(setting->name);
    rows.push_back(row);
  }
  return "  " + front + (front == "evaluation" ? ", a million pairs on one thread" : " tables") +
         "\n" + columns(rows);
}

std::string convergence_text(const Convergence& convergence) {
  std::string text = convergence.dial + ": " + convergence.law + ", fitted " +
                     short_number(convergence.fitted, kDigits) + ", expected " +
                     short_number(convergence.expected, kDigits);
  if (convergence.differs) text += ", DIFFERS: " + convergence.reason;
  return paragraph(text);
}

}  // namespace

std::string cost_text(const CostReport& report) {
  std::string text =
      report.material.name + ": errors over " + with_commas(report.pairs) + " pairs, times of " +
      std::to_string(report.repeats) + " runs, " + std::to_string(report.threads) +
      (report.threads == 1 ? " thread" : " threads") + "; * none is both faster and as accurate\n";
  for (const char* front : {"3-D", "4-D", "evaluation"}) text += front_text(report, front);
  if (!report.convergence.empty()) text += "  convergence\n";
  for (const Convergence& convergence : report.convergence) text += convergence_text(convergence);
  if (!report.sentences.empty()) text += "  in words\n";
  for (const std::string& sentence : report.sentences) text += paragraph(sentence);
  return text;
}

}  // namespace clothbrdf
