#include "cli/report_text.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace clothbrdf {
namespace {

constexpr std::size_t kIndent = 4;
constexpr std::size_t kLabelWidth = 14;

// Words of a text on lines that begin at `indent`; the first line's beginning is there already.
std::string broken(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string lines;
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    const bool first = column == indent;
    if (!first && column + 1 + word.size() > kReportColumns) {
      lines += "\n" + std::string(indent, ' ') + word;
      column = indent + word.size();
    } else {
      lines += (first ? "" : " ") + word;
      column += word.size() + (first ? 0 : 1);
    }
  }
  return lines + "\n";
}

}  // namespace

std::string short_number(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string short_number(const std::optional<double>& value, int digits) {
  return value ? short_number(*value, digits) : "-";
}

std::string percent(double share) {
  constexpr int kDigits = 3;
  return std::isfinite(share) ? short_number(100 * share, kDigits) + "%" : "infinite";
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit == "1" || unit.empty() || text == "-" ? text : text + " " + unit;
}

std::string columns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line(kIndent, ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string labelled(const std::string& label, const std::string& text) {
  std::string line = "  " + label;
  line.resize(std::max(line.size() + 1, kLabelWidth), ' ');
  return line + broken(text, line.size());
}

std::string paragraph(const std::string& text) {
  return std::string(kIndent, ' ') + broken(text, kIndent);
}

void add_remark(std::vector<Remark>& remarks, const std::string& name, const std::string& words) {
  if (words.empty()) return;
  const auto same = std::find_if(remarks.begin(), remarks.end(),
                                 [&](const Remark& remark) { return remark.words == words; });
  if (same == remarks.end()) {
    remarks.push_back({name, words});
  } else {
    same->names += ", " + name;
  }
}

std::string remarks_text(const std::string& heading, const std::vector<Remark>& remarks) {
  if (remarks.empty()) return "";
  std::string text = "  " + heading + "\n";
  for (const Remark& remark : remarks) text += paragraph(remark.names + ": " + remark.words);
  return text;
}

std::string blind_text(const std::vector<BlindDirection>& blind, double condition) {
  std::string text =
      labelled("condition", condition > 0 ? short_number(condition)
                                          : "infinite: the table does not change with some");
  if (blind.empty()) return text;
  text += "  changes that the table hardly shows, in standard deviations of the noise\n";
  for (const BlindDirection& direction : blind) {
    text += paragraph(direction.words + " (" + short_number(direction.singular_value, 3) + ")");
  }
  return text;
}

std::string equivalents_text(const std::vector<Equivalent>& equivalents) {
  if (equivalents.empty()) return "";
  std::string text = "  the same table comes from the material with\n";
  for (const Equivalent& equivalent : equivalents) text += paragraph(equivalent.words);
  return text;
}

std::string layers_text(const LayerProfile& layers) {
  std::string others;
  for (const LayerFit& fit : layers.fits) {
    if (fit.told || fit.equivalent || (fit.warp == layers.warp && fit.weft == layers.weft))
      continue;
    others +=
        (others.empty() ? "" : ", ") + std::to_string(fit.warp) + "/" + std::to_string(fit.weft);
  }
  std::string text = "warp " + std::to_string(layers.warp) + ", weft " +
                     std::to_string(layers.weft) + "; of " + std::to_string(layers.fewest) +
                     " to " + std::to_string(layers.most) + " the table ";
  text += others.empty() ? "tells them from all others" : "cannot tell them from " + others;
  return labelled("layers", text);
}

}  // namespace clothbrdf
