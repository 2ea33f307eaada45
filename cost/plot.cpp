#include "cost/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>
#include <vector>

#include "support/errors.h"

namespace clothbrdf {
namespace {

// Paul Tol's muted scheme: told apart with any colour vision. Together with the shapes, whose
// number has no divisor in common, 90 dials differ.
constexpr std::array<const char*, 9> kColours = {"#332288", "#CC6677", "#117733",
                                                 "#88CCEE", "#882255", "#44AA99",
                                                 "#999933", "#AA4499", "#DDCC77"};
// gnuplot's filled and open circle, square, triangles, diamond.
constexpr std::array<int, 10> kShapes = {7, 5, 9, 13, 11, 6, 4, 8, 12, 10};
constexpr const char* kDominatedColour = "#B0B0B0";

struct Front {
  const char* name;
  const char* title;
};
constexpr std::array<Front, 3> kFronts = {{{"3-D", "tables without phi_h (3-D)"},
                                           {"4-D", "tables with the weave (4-D)"},
                                           {"evaluation", "evaluating a million pairs"}}};

using Settings = std::vector<const CostSetting*>;

// In single quotes gnuplot knows no escapes but the doubled quote.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    result.append(c == '\'' ? 2 : 1, control ? ' ' : c);
  }
  return result + "'";
}

bool can_be_drawn(const CostSetting& setting) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  return positive(setting.error.rms) && positive(setting.seconds.median);
}

Settings drawn_settings(const CostReport& report, const std::string& front) {
  Settings settings;
  for (const CostSetting& setting : report.settings) {
    if (setting.front == front && can_be_drawn(setting)) settings.push_back(&setting);
  }
  std::stable_sort(settings.begin(), settings.end(), [](const auto* a, const auto* b) {
    return a->seconds.median < b->seconds.median;
  });
  return settings;
}

std::vector<std::string> dials_of(const Settings& settings) {
  std::vector<std::string> dials;
  for (const CostSetting* setting : settings) {
    if (std::find(dials.begin(), dials.end(), setting->dial) == dials.end()) {
      dials.push_back(setting->dial);
    }
  }
  return dials;
}

/// What of a panel's settings is one curve: a line, or the points of a dial.
template <class Belongs>
Settings chosen(const Settings& settings, const Belongs& belongs) {
  Settings some;
  std::copy_if(settings.begin(), settings.end(), std::back_inserter(some), belongs);
  return some;
}

/// The curves of a panel, and their points as named blocks of data, which come first.
class Panel {
 public:
  explicit Panel(std::string prefix) : prefix_(std::move(prefix)) {}

  void add(const Settings& settings, const std::string& style) {
    if (settings.empty()) return;
    const std::string name = "$" + prefix_ + "_" + std::to_string(++blocks_);
    data_ << name << " << EOD\n";
    for (const CostSetting* setting : settings) {
      data_ << setting->seconds.median << ' ' << setting->error.rms << '\n';
    }
    data_ << "EOD\n";
    add_curve(name + " using 1:2 " + style);
  }
  void add_curve(const std::string& curve) {
    plot_ += (plot_.empty() ? "plot " : ", \\\n  ") + curve;
  }
  std::string data() const { return data_.str(); }
  std::string plot() const { return plot_ + "\n"; }

 private:
  std::string prefix_;
  int blocks_ = 0;
  std::ostringstream data_;
  std::string plot_;
};

// Some room round the settings. gnuplot itself labels powers of 10 alone, of which a short axis may
// have none.
std::string axis_range(const char* axis, double lowest, double highest) {
  constexpr double kMargin = 1.6;
  constexpr double kShort = 100;
  lowest /= kMargin;
  highest *= kMargin;
  std::ostringstream text;
  text << "set " << axis << "range [" << lowest << ':' << highest << "]\nset " << axis << "tics ";
  if (highest / lowest > kShort) {
    text << "autofreq\n";
    return text.str();
  }
  const char* comma = "(";
  for (double decade = std::pow(10, std::floor(std::log10(lowest))); decade < highest;
       decade *= 10) {
    for (const double label : {decade, 2 * decade, 5 * decade}) {
      if (label < lowest || label > highest) continue;
      text << comma << label;
      comma = ", ";
    }
  }
  text << ")\n";
  return text.str();
}

std::string ranges(const Settings& settings) {
  const auto [fastest, slowest] = std::minmax_element(
      settings.begin(), settings.end(),
      [](const auto* a, const auto* b) { return a->seconds.median < b->seconds.median; });
  const auto [best, worst] =
      std::minmax_element(settings.begin(), settings.end(),
                          [](const auto* a, const auto* b) { return a->error.rms < b->error.rms; });
  return axis_range("x", (*fastest)->seconds.median, (*slowest)->seconds.median) +
         axis_range("y", (*best)->error.rms, (*worst)->error.rms);
}

void draw_front(const Front& front, const Settings& settings,
                const std::vector<std::string>& all_dials, std::ostream& script) {
  std::string prefix = front.name;
  std::erase_if(prefix, [](char c) { return c == '-'; });
  Panel panel("front_" + prefix);
  const std::string line = "with lines lw 1.5 lc rgb '#606060' ";
  // Rotations approximate another thing, the mean over them, and so have a front of their own.
  for (const bool rotations : {false, true}) {
    const auto on_front = [&](const CostSetting* setting) {
      return setting->pareto && (setting->dial == "rotations") == rotations;
    };
    panel.add(chosen(settings, on_front), line + (rotations ? "notitle" : "title 'front'"));
  }
  for (const std::string& dial : dials_of(settings)) {
    const auto number = static_cast<std::size_t>(
        std::find(all_dials.begin(), all_dials.end(), dial) - all_dials.begin());
    const std::string shape =
        "with points ps 1.1 pt " + std::to_string(kShapes[number % kShapes.size()]) + " lc rgb '";
    const std::string coloured = shape + kColours[number % kColours.size()] + "'";
    // A key of its own, in the dial's colour even where none of its settings is on the front.
    panel.add_curve("1/0 " + coloured + " title " + quoted(dial));
    const auto of_dial = [&](bool pareto) {
      return chosen(settings, [&](const CostSetting* setting) {
        return setting->dial == dial && setting->pareto == pareto;
      });
    };
    panel.add(of_dial(false), shape + kDominatedColour + "' notitle");
    panel.add(of_dial(true), coloured + " notitle");
  }
  script << panel.data() << "set title " << quoted(front.title) << '\n'
         << ranges(settings) << panel.plot();
}

}  // namespace

std::string cost_plot(const CostReport& report, const std::string& terminal) {
  std::vector<std::pair<Front, Settings>> panels;
  Settings all;
  for (const Front& front : kFronts) {
    const Settings settings = drawn_settings(report, front.name);
    if (settings.empty()) continue;
    panels.emplace_back(front, settings);
    all.insert(all.end(), settings.begin(), settings.end());
  }
  if (panels.empty()) throw WorkError("there is no setting to draw: all errors or times are 0");
  const std::vector<std::string> dials = dials_of(all);

  std::ostringstream script;
  script.precision(9);
  script
      << "set terminal " << terminal << " size " << kCostPlotWidth << ',' << kCostPlotHeight
      << " noenhanced background '#FFFFFF' font 'sans,11'\n"
      << "set multiplot layout 1," << panels.size() << " title "
      << quoted(report.material.name + ": error over time (grey: dominated)") << " noenhanced\n"
      << "set logscale xy\nset format xy '%g'\n"
      << "set grid xtics ytics lt 1 lc rgb '#DDDDDD'\n"
      << "set xlabel 'seconds'\nset ylabel 'rms error'\n"
      << "set lmargin 10\nset rmargin 2\n"
      << "set tmargin at screen 0.87\nset bmargin at screen 0.29\n"
      << "set key at graph 0.5, graph -0.18 center top vertical maxrows 5 Left reverse samplen 1 "
         "width -1 font ',10' noenhanced\n";
  for (const auto& [front, settings] : panels) draw_front(front, settings, dials, script);
  script << "unset multiplot\n";
  return script.str();
}

}  // namespace clothbrdf
