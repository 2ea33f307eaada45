#include "preview/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "preview/panels.h"

namespace clothbrdf {
namespace {

constexpr double kLogarithmicFrom = 20;  // largest over smallest value

bool drawable(double value) { return value >= 0 && value <= kMostDrawn; }

/// What values reach over; none are where lowest > highest.
struct Range {
  double lowest_positive = std::numeric_limits<double>::infinity();
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -1;

  void add(const std::vector<double>& values) {
    for (const double value : values) {
      if (!drawable(value)) continue;
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
      if (value > 0) lowest_positive = std::min(lowest_positive, value);
    }
  }
};

std::vector<Tick> linear_ticks(double lowest, double highest) {
  constexpr double kMostTicks = 5;
  const double least = (highest - lowest) / kMostTicks;
  const double power = std::pow(10, std::floor(std::log10(least)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= least) step = factor * power;
  }
  std::vector<Tick> ticks;
  for (double k = std::ceil(lowest / step); k * step <= highest; ++k) {
    ticks.push_back({k * step, tick_text(k * step)});
  }
  return ticks;
}

std::vector<Tick> decade_ticks(double lowest, double highest) {
  constexpr int kMostDecades = 6;
  const int first = static_cast<int>(std::floor(std::log10(lowest)));
  const int last = static_cast<int>(std::ceil(std::log10(highest)));
  const int stride = (last - first + kMostDecades - 1) / kMostDecades;
  const bool few = last - first <= 3;
  std::vector<Tick> ticks;
  for (int decade = first; decade <= last; decade += stride) {
    for (int digit = 1; digit < 10; ++digit) {
      if (stride > 1 && digit > 1) break;
      const double at = digit * std::pow(10, decade);
      if (at < lowest || at > highest) continue;
      const bool named = digit == 1 || (few && (digit == 2 || digit == 5));
      ticks.push_back({at, named ? tick_text(at) : ""});
    }
  }
  return ticks;
}

void draw_x_axis(Image& image, const Box& frame, const PlotAxis& x) {
  const int bottom = frame.y + frame.height;
  int free_from = 0;
  for (const Tick& tick : x.ticks) {
    const int at = frame.x + static_cast<int>(std::lround(x.share(tick.at) * frame.width));
    if (at < frame.x || at > frame.x + frame.width) continue;
    fill_box(image, {at, bottom, 1, 6}, kPlotInk);
    const int width = text_width(kPlotText, tick.text) - kPlotText;
    const int start = at - width / 2;
    if (start < free_from) continue;
    draw_text(image, start, bottom + 9, kPlotText, tick.text, kPlotInk);
    free_from = start + width + 6 * kPlotText;
  }
  const int middle = frame.x + (frame.width - text_width(kPlotText, x.name)) / 2;
  draw_text(image, middle, bottom + 17 + kLetterHeight, kPlotText, x.name, kPlotInk);
}

void draw_y_axis(Image& image, const Box& frame, const PlotAxis& y) {
  int free_to = image.height;
  for (const Tick& tick : y.ticks) {
    const int at = frame.y + static_cast<int>(std::lround((1 - y.share(tick.at)) * frame.height));
    if (at < frame.y || at > frame.y + frame.height) continue;
    const int mark = tick.text.empty() ? 3 : 6;
    fill_box(image, {frame.x - mark, at, mark, 1}, kPlotInk);
    const int top = at - kLetterHeight / 2;
    if (top + kLetterHeight > free_to) continue;
    const int start = frame.x - 8 - text_width(kPlotText, tick.text) + kPlotText;
    draw_text(image, start, top, kPlotText, tick.text, kPlotInk);
    if (!tick.text.empty()) free_to = top - 2;
  }
}

// Faint lines at the numbers, behind the curves.
void draw_rules(Image& image, const Box& frame, const PlotAxis& x, const PlotAxis& y) {
  for (const Tick& tick : x.ticks) {
    const int at = frame.x + static_cast<int>(std::lround(x.share(tick.at) * frame.width));
    if (at <= frame.x || at >= frame.x + frame.width) continue;
    fill_box(image, {at, frame.y, 1, frame.height}, kPlotFaint);
  }
  for (const Tick& tick : y.ticks) {
    const int at = frame.y + static_cast<int>(std::lround((1 - y.share(tick.at)) * frame.height));
    if (tick.text.empty() || at <= frame.y || at >= frame.y + frame.height) continue;
    fill_box(image, {frame.x, at, frame.width, 1}, kPlotFaint);
  }
}

bool shown(const PlotAxis& y, double value) {
  return drawable(value) && (!y.logarithmic || value > 0);
}

void draw_dots(Image& image, const PlotAxis& x, const PlotAxis& y, const Curve& curve) {
  constexpr double kRadius = 2.6;
  constexpr double kTint = 0.4;  // lets the line stand out on its dots
  Mask mask(kPlotFrame);
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (!shown(y, curve.dots[k])) continue;
    mask.add_disc(plot_point(kPlotFrame, x, y, curve.x[k], curve.dots[k]), kRadius);
  }
  mask.paint(image, mix(curve.colour, kPlotPaper, kTint));
}

void draw_line(Image& image, const PlotAxis& x, const PlotAxis& y, const Curve& curve) {
  constexpr double kWidth = 1.3;
  constexpr double kAlone = 3;  // half the length of the dash that is a line of one point
  Mask mask(kPlotFrame);
  const auto has = [&](std::size_t k) { return k < curve.x.size() && shown(y, curve.line[k]); };
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (!has(k)) continue;
    const Point from = plot_point(kPlotFrame, x, y, curve.x[k], curve.line[k]);
    if (has(k + 1)) {
      mask.add_line(from, plot_point(kPlotFrame, x, y, curve.x[k + 1], curve.line[k + 1]), kWidth);
    } else if (k == 0 || !has(k - 1)) {
      mask.add_line({from.x - kAlone, from.y}, {from.x + kAlone, from.y}, kWidth);
    }
  }
  mask.paint(image, curve.colour);
}

}  // namespace

std::string tick_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  std::string text = buffer;
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const int power = std::stoi(text.substr(exponent + 1));
  return text.substr(0, exponent) + "E" + std::to_string(power);
}

double PlotAxis::share(double value) const {
  if (logarithmic) return std::log(value / lowest) / std::log(highest / lowest);
  return (value - lowest) / (highest - lowest);
}

PlotAxis value_axis(const std::vector<Curve>& curves) {
  Range dots;
  Range lines;
  for (const Curve& curve : curves) {
    dots.add(curve.dots);
    lines.add(curve.line);
  }
  PlotAxis axis;
  const double highest = std::max(dots.highest, lines.highest);
  // Smaller ones would make steps between ticks that are no longer normal numbers.
  constexpr double kLeastDrawn = 1e-100;
  if (highest < kLeastDrawn) {
    axis.ticks = linear_ticks(axis.lowest, axis.highest);
    return axis;
  }
  constexpr double kFloor = 1e-6;
  double common = std::min(dots.highest, lines.highest);
  if (common < kLeastDrawn) common = highest;
  const double lowest_positive =
      std::max(std::min(dots.lowest_positive, lines.lowest_positive), kFloor * common);
  if (highest > kLogarithmicFrom * lowest_positive) {
    constexpr double kMargin = 1.3;
    axis.logarithmic = true;
    axis.lowest = lowest_positive / kMargin;
    axis.highest = highest * kMargin;
    axis.ticks = decade_ticks(axis.lowest, axis.highest);
    return axis;
  }
  constexpr double kMargin = 0.06;
  const double lowest = std::min(dots.lowest, lines.lowest);
  const double from = lowest < 0.5 * highest ? 0 : lowest;
  const double span = std::max(highest - from, 0.1 * highest);
  axis.lowest = from == 0 ? 0 : from - kMargin * span;
  axis.highest = from + (1 + kMargin) * span;
  axis.ticks = linear_ticks(axis.lowest, axis.highest);
  return axis;
}

Point plot_point(const Box& frame, const PlotAxis& x, const PlotAxis& y, double at_x, double at_y) {
  return {frame.x + x.share(at_x) * frame.width, frame.y + (1 - y.share(at_y)) * frame.height};
}

void draw_axes(Image& image, const Box& frame, const PlotTitle& title, const PlotAxis& x,
               const PlotAxis& y) {
  const int right = frame.x + frame.width;
  const int bottom = frame.y + frame.height;
  fill_box(image, {frame.x - 1, frame.y - 1, frame.width + 2, 1}, kPlotInk);
  fill_box(image, {frame.x - 1, bottom, frame.width + 2, 1}, kPlotInk);
  fill_box(image, {frame.x - 1, frame.y - 1, 1, frame.height + 2}, kPlotInk);
  fill_box(image, {right, frame.y - 1, 1, frame.height + 2}, kPlotInk);
  draw_x_axis(image, frame, x);
  draw_y_axis(image, frame, y);
  const int above = frame.y - 2 * (kLetterHeight + 6);
  draw_text(image, frame.x, above, kPlotText, title.above, kPlotInk);
  draw_text(image, frame.x, above + kLetterHeight + 5, kPlotText, title.below, kPlotInk);
}

Image draw_plot(const PlotTitle& title, const PlotAxis& x, const std::vector<Curve>& curves) {
  Image image(kPlotWidth, kPlotHeight, kPlotPaper);
  const PlotAxis y = value_axis(curves);
  draw_rules(image, kPlotFrame, x, y);
  for (const Curve& curve : curves) draw_dots(image, x, y, curve);
  for (const Curve& curve : curves) draw_line(image, x, y, curve);
  draw_axes(image, kPlotFrame, {title.above + (y.logarithmic ? ", log" : ""), title.below}, x, y);
  return image;
}

}  // namespace clothbrdf
