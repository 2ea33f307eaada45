#include "preview/layer_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "preview/panels.h"
#include "preview/plot.h"

namespace clothbrdf {
namespace {

constexpr int kBelow = 56;  // numbers and name of the axis
constexpr int kRight = 40;
constexpr int kNarrowest = 420;  // holds the title

std::vector<double> sorted_values(const std::vector<SweepCell>& cells, double SweepCell::*member) {
  std::vector<double> values;
  values.reserve(cells.size());
  for (const SweepCell& cell : cells) values.push_back(cell.*member);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

int index_of(const std::vector<double>& values, double value) {
  return static_cast<int>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

// From none (0) to all (1), each step darker.
Rgb shade(double share) {
  static const Rgb kSteps[] = {screen_colour(252, 244, 214), screen_colour(161, 214, 176),
                               screen_colour(44, 152, 172), screen_colour(34, 76, 152),
                               screen_colour(28, 22, 84)};
  const double at = std::clamp(share, 0.0, 1.0) * 4;
  const auto k = static_cast<std::size_t>(std::min(at, 3.0));
  return mix(kSteps[k], kSteps[k + 1], at - static_cast<double>(k));
}

// Black or white, whichever stands out.
Rgb ink_on(const Rgb& ground) {
  const double luminance = 0.2126 * ground[0] + 0.7152 * ground[1] + 0.0722 * ground[2];
  constexpr double kMiddle = 0.18;
  return luminance > kMiddle ? kPlotInk : kPlotPaper;
}

/// A map's parts.
struct Layout {
  std::vector<double> noises;
  std::vector<double> absorptions;
  LayerMapCell cell;

  int columns() const { return static_cast<int>(noises.size()); }
  int rows() const { return static_cast<int>(absorptions.size()); }
  Box frame() const {
    return {kLayerMapLeft, kLayerMapTop, columns() * cell.width, rows() * cell.height};
  }
  Box box(const SweepCell& one) const {
    const int row = rows() - 1 - index_of(absorptions, one.absorption);
    return {kLayerMapLeft + index_of(noises, one.noise) * cell.width,
            kLayerMapTop + row * cell.height, cell.width, cell.height};
  }
};

void draw_cell(Image& image, const Box& box, int layers, int most) {
  const Rgb ground = shade(most > 0 ? 1.0 * layers / most : 0);
  // A thin gap keeps neighbours apart where there is room for it.
  const int gap = std::min(box.width, box.height) >= 12 ? 1 : 0;
  fill_box(image, {box.x, box.y, box.width - gap, box.height - gap}, ground);
  const std::string text = std::to_string(layers);
  const int width = text_width(kPlotText, text) - kPlotText;
  if (width + 4 > box.width || kLetterHeight + 4 > box.height) return;
  draw_text(image, box.x + (box.width - width) / 2, box.y + (box.height - kLetterHeight) / 2,
            kPlotText, text, ink_on(ground));
}

PlotAxis value_names(const std::string& name, const std::vector<double>& values) {
  PlotAxis axis{name, -0.5, static_cast<double>(values.size()) - 0.5, false, {}};
  for (std::size_t k = 0; k < values.size(); ++k) {
    constexpr double kDigits = 100;  // three of them
    double shown = values[k];
    if (shown > 0 && std::isfinite(shown)) {
      const double power = std::pow(10, std::floor(std::log10(shown)));
      shown = std::round(shown / power * kDigits) / kDigits * power;
    }
    axis.ticks.push_back({static_cast<double>(k), tick_text(shown)});
  }
  return axis;
}

}  // namespace

LayerMapCell layer_map_cell(std::size_t columns, std::size_t rows) {
  constexpr int kMost = 8192;
  const auto edge = [](std::size_t count, int room, int largest) {
    const int shared = room / static_cast<int>(std::clamp<std::size_t>(count, 1, kMost));
    return std::clamp(shared, 1, largest);
  };
  return {edge(columns, 960, 96), edge(rows, 640, 44)};
}

Image layer_map(const std::vector<SweepCell>& cells) {
  Layout layout{
      sorted_values(cells, &SweepCell::noise), sorted_values(cells, &SweepCell::absorption), {}};
  layout.cell = layer_map_cell(layout.noises.size(), layout.absorptions.size());
  const Box frame = layout.frame();
  Image image(std::max(kNarrowest, kLayerMapLeft + frame.width + kRight),
              kLayerMapTop + frame.height + kBelow, kPlotPaper);
  fill_box(image, frame, kPlotFaint);
  int most = 0;
  for (const SweepCell& one : cells) most = std::max(most, one.told_layers);
  for (const SweepCell& one : cells) draw_cell(image, layout.box(one), one.told_layers, most);
  draw_axes(image, frame, {"layers that can be told", "absorption up, noise across"},
            value_names("noise", layout.noises), value_names("absorption", layout.absorptions));
  return image;
}

}  // namespace clothbrdf
