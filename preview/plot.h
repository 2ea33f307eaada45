#pragma once

#include <array>
#include <string>
#include <vector>

#include "preview/drawing.h"
#include "support/image.h"

namespace clothbrdf {

/// A number written beside an axis.
struct Tick {
  double at = 0;
  std::string text;  ///< empty: a short mark alone
};

/// One edge of a plot: which values it reaches over and what is written beside it.
struct PlotAxis {
  std::string name;
  double lowest = 0;  ///< > 0 where logarithmic
  double highest = 1;
  bool logarithmic = false;
  std::vector<Tick> ticks;

  /// 0 at the lowest end, 1 at the highest one.
  double share(double value) const;
};

/// Measured values as dots and what is held against them as a line; as many of both as of x. A NaN
/// is a gap.
struct Curve {
  std::vector<double> x;
  std::vector<double> dots;
  std::vector<double> line;
  Rgb colour{};
};

/// Two lines of text above a plot; `below` says what holds for all of it.
struct PlotTitle {
  std::string above;
  std::string below;
};

inline constexpr int kPlotWidth = 520;
inline constexpr int kPlotHeight = 360;
inline constexpr Box kPlotFrame = {78, 54, 424, 250};  ///< where the curves are
inline constexpr int kPlotText = 2;                    ///< scale of its letters
inline constexpr int kLetterHeight = 7 * kPlotText;
inline const Rgb kPlotPaper = {1, 1, 1};
inline const Rgb kPlotInk = {0.02, 0.02, 0.02};
inline const Rgb kPlotFaint = {0.84, 0.84, 0.84};

/// Values above this are not drawn: far beyond any reflectance, and sums of them stay finite.
inline constexpr double kMostDrawn = 1e100;

/// Reaches over all values of the curves that can be drawn (from 0 to kMostDrawn): logarithmic
/// where the largest is more than 20 times the smallest above 0, and then no further down than six
/// decades below what the dots and the lines both reach.
PlotAxis value_axis(const std::vector<Curve>& curves);

/// The middle of a pair of values, pixels.
Point plot_point(const Box& frame, const PlotAxis& x, const PlotAxis& y, double at_x, double at_y);

/// Ticks, numbers, names and the frame's outline, on what is there.
void draw_axes(Image& image, const Box& frame, const PlotTitle& title, const PlotAxis& x,
               const PlotAxis& y);

/// All of it, kPlotWidth x kPlotHeight; "log" is added to the title where the axis is.
Image draw_plot(const PlotTitle& title, const PlotAxis& x, const std::vector<Curve>& curves);

/// A number in few letters: "0.25", "1E-9", "2E30".
std::string tick_text(double value);

}  // namespace clothbrdf
