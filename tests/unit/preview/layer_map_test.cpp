#include "preview/layer_map.h"

#include <algorithm>
#include <cmath>

#include "preview/panels.h"
#include "preview/plot.h"
#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

std::vector<SweepCell> sweep(int absorptions, int noises) {
  std::vector<SweepCell> cells;
  for (int a = 0; a < absorptions; ++a) {
    for (int n = 0; n < noises; ++n) {
      cells.push_back({0.05 * std::pow(1.5, a), 0.001 * std::pow(2, n), a + 2 * n});
    }
  }
  return cells;
}

// The top left corner of a cell, which its number leaves free.
const Rgb& corner(const Image& image, int column, int row_from_top, const LayerMapCell& cell) {
  return image.at(kLayerMapLeft + column * cell.width + 1,
                  kLayerMapTop + row_from_top * cell.height + 1);
}

double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

}  // namespace

TEST_CASE("noise grows to the right and absorption upward, darker where more layers are told") {
  const Image image = layer_map(sweep(4, 3));
  const LayerMapCell cell = layer_map_cell(3, 4);
  std::vector<double> by_layers(8, -1);
  for (int a = 0; a < 4; ++a) {
    for (int n = 0; n < 3; ++n) {
      const double light = luminance(corner(image, n, 3 - a, cell));
      double& known = by_layers[static_cast<std::size_t>(a + 2 * n)];
      if (known >= 0) CHECK(light == known);
      known = light;
    }
  }
  for (std::size_t k = 1; k < by_layers.size(); ++k) {
    CAPTURE(k);
    CHECK(by_layers[k] < by_layers[k - 1] - 0.01);
  }
}

TEST_CASE("the order of the cells does not matter") {
  std::vector<SweepCell> cells = sweep(5, 4);
  const Image image = layer_map(cells);
  std::reverse(cells.begin(), cells.end());
  CHECK(layer_map(cells).pixels == image.pixels);
  std::rotate(cells.begin(), cells.begin() + 7, cells.end());
  CHECK(layer_map(cells).pixels == image.pixels);
}

TEST_CASE("each cell holds its number") {
  for (const int layers : {0, 3, 8, 12}) {
    const Image image = layer_map({{0.1, 0.01, layers}, {0.2, 0.01, 12}});
    const LayerMapCell cell = layer_map_cell(1, 2);
    const Rgb ground = corner(image, 0, 1, cell);
    Image expected(cell.width, cell.height, ground);
    const std::string text = std::to_string(layers);
    const int width = text_width(kPlotText, text) - kPlotText;
    const Rgb ink = luminance(ground) > 0.18 ? kPlotInk : kPlotPaper;
    draw_text(expected, (cell.width - width) / 2, (cell.height - 7 * kPlotText) / 2, kPlotText,
              text, ink);
    CAPTURE(layers);
    int wrong = 0;
    for (int y = 0; y < cell.height - 1; ++y) {
      for (int x = 0; x < cell.width - 1; ++x) {
        const Rgb& seen = image.at(kLayerMapLeft + x, kLayerMapTop + cell.height + y);
        if (seen != expected.at(x, y)) ++wrong;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("the picture grows with its cells and by nothing else") {
  const Image small = layer_map(sweep(5, 6));
  for (const auto& [rows, columns] : {std::pair{8, 5}, {14, 9}, {2, 30}, {60, 6}, {300, 300}}) {
    const LayerMapCell cell =
        layer_map_cell(static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
    const LayerMapCell first = layer_map_cell(6, 5);
    const Image image = layer_map(sweep(rows, columns));
    CAPTURE(rows, columns);
    CHECK(image.width - columns * cell.width == small.width - 6 * first.width);
    CHECK(image.height - rows * cell.height == small.height - 5 * first.height);
    CHECK(image.width <= 1200);
    CHECK(image.height <= 900);
  }
}

TEST_CASE("pairs that are missing stay grey, and an empty sweep is a picture, too") {
  std::vector<SweepCell> cells = sweep(3, 3);
  cells.erase(cells.begin() + 4);
  const Image image = layer_map(cells);
  const LayerMapCell cell = layer_map_cell(3, 3);
  CHECK(corner(image, 1, 1, cell) == kPlotFaint);
  CHECK(corner(image, 0, 1, cell) != kPlotFaint);
  CHECK(layer_map({}).width > 0);
  CHECK(layer_map({{0, 0, 0}}).height > 0);
}

}  // namespace clothbrdf::test
