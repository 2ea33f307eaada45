#include "preview/fit_slices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "preview/panels.h"
#include "preview/plot.h"
#include "preview/residual_map.h"
#include "preview/slices.h"
#include "support/errors.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A channel that is drawn.
struct Drawn {
  std::size_t channel;  ///< index in the table
  Rgb colour;
};

// In the order of the spectrum, dark enough for thin lines on white.
std::vector<Rgb> spectrum() {
  return {screen_colour(110, 40, 160), screen_colour(30, 80, 200), screen_colour(0, 140, 150),
          screen_colour(20, 125, 35),  screen_colour(205, 120, 0), screen_colour(200, 25, 30)};
}

std::vector<Drawn> drawn_channels(const std::vector<Channel>& channels) {
  const std::vector<Rgb> colours = spectrum();
  const std::size_t count = channels.size();
  std::vector<std::size_t> shown;
  if (count <= colours.size()) {
    for (std::size_t c = 0; c < count; ++c) shown.push_back(c);
  } else {
    shown = {0, count / 2, count - 1};
  }
  std::vector<Drawn> drawn;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::string& name = channels[shown[k]].name;
    const std::size_t of_rgb = name == "R" ? 5 : name == "G" ? 3 : name == "B" ? 1 : 6;
    const std::size_t spread = shown.size() < 2 ? 1 : k * (colours.size() - 1) / (shown.size() - 1);
    drawn.push_back({shown[k], colours[of_rgb < colours.size() && count == 3 ? of_rgb : spread]});
  }
  return drawn;
}

/// What the fitted material says: one value a channel of each cell that is asked for.
using CellValues = std::map<std::size_t, std::vector<double>>;

// Goes through the fit once, without keeping it: its table may be as large as the one given.
void compare(const Table& table, const Producer& fit, const Workers& workers, CellValues& wanted,
             ResidualMap& map) {
  const TableSpec& spec = table.spec();
  const std::size_t columns = spec.column_count();
  const std::size_t channels = spec.channels.size();
  stream_rows(fit, workers, [&](std::size_t first_row, std::span<double> values) {
    for (std::size_t at = 0; at < values.size(); ++at) {
      const std::size_t row = first_row + at / spec.row_values();
      const std::size_t channel = at / columns % channels;
      const std::size_t cell = row * columns + at % columns;
      if (table.valid(cell)) map.add(cell, table.value(cell, channel), values[at]);
    }
    const std::size_t first = first_row * columns;
    const std::size_t end = first + values.size() / channels;
    for (auto at = wanted.lower_bound(first); at != wanted.end() && at->first < end; ++at) {
      const std::size_t row = (at->first - first) / columns;
      for (std::size_t c = 0; c < channels; ++c) {
        at->second.push_back(values[(row * channels + c) * columns + at->first % columns]);
      }
    }
  });
}

bool above_horizon(const TableSpec& spec, std::size_t cell) {
  return spec.cells.average ? spec.grid().any_above_horizon(cell)
                            : spec.grid().node_above_horizon(cell);
}

Image draw_slice(const Slice& slice, const Table& table, const CellValues& fit,
                 const std::vector<Drawn>& drawn) {
  std::vector<Curve> curves;
  for (const Drawn& one : drawn) {
    Curve curve;
    curve.x = slice.x;
    curve.colour = one.colour;
    for (const std::size_t cell : slice.cells) {
      curve.dots.push_back(table.valid(cell) ? table.value(cell, one.channel) : kNone);
      const bool lit = above_horizon(table.spec(), cell);
      curve.line.push_back(lit ? fit.at(cell)[one.channel] : kNone);
    }
    curves.push_back(std::move(curve));
  }
  return draw_plot(slice.title, slice.axis, curves);
}

void draw_header(Image& picture, const std::vector<Channel>& channels,
                 const std::vector<Drawn>& drawn) {
  constexpr int kTop = 16;
  const std::string text = "f_r in 1/sr: dots the table, lines the fit. channels:";
  draw_text(picture, kPlotFrame.x, kTop, kPlotText, text, kPlotInk);
  int x = kPlotFrame.x + text_width(kPlotText, text + " ");
  for (const Drawn& one : drawn) {
    const std::string& name = channels[one.channel].name;
    draw_text(picture, x, kTop, kPlotText, name, one.colour);
    x += text_width(kPlotText, name + " ");
  }
}

void place(const Image& panel, Image& picture, int index) {
  static_assert(kFitSlicesWidth == 3 * kPlotWidth);
  static_assert(kFitSlicesHeight == kFitSlicesHeader + 2 * kPlotHeight);
  const int left = index % 3 * kPlotWidth;
  const int top = kFitSlicesHeader + index / 3 * kPlotHeight;
  for (int y = 0; y < panel.height; ++y) {
    for (int x = 0; x < panel.width; ++x) picture.at(left + x, top + y) = panel.at(x, y);
  }
}

}  // namespace

Image fit_slices(const Table& table, const Material& fitted, const Workers& workers) {
  const TableSpec& spec = table.spec();
  if (!spec.has_grid()) throw InputError("a list of pairs has no slices; a picture needs a grid");
  TableSpec fit_spec = material_spec(fitted, {}, spec.grid(), spec.cells);
  fit_spec.channels = spec.channels;
  const std::vector<Slice> slices = typical_slices(spec.grid());
  CellValues fit;
  for (const Slice& slice : slices) {
    for (const std::size_t cell : slice.cells) fit[cell];
  }
  ResidualMap map(spec.grid());
  compare(table, *make_producer(fit_spec, workers), workers, fit, map);

  const std::vector<Drawn> drawn = drawn_channels(spec.channels);
  Image picture(kFitSlicesWidth, kFitSlicesHeight, kPlotPaper);
  draw_header(picture, spec.channels, drawn);
  int index = 0;
  for (const Slice& slice : slices) place(draw_slice(slice, table, fit, drawn), picture, index++);
  place(map.draw(), picture, index);
  return picture;
}

}  // namespace clothbrdf
