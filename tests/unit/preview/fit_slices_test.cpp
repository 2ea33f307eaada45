#include "preview/fit_slices.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "preview/plot.h"
#include "preview/residual_map.h"
#include "preview/slices.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

const std::vector<Grid>& fitted_grids() {
  static const std::vector<Grid> kGrids = {halfdiff3d(12, 10, 8), halfdiff4d(9, 6, 8, 7),
                                           inout(6, 8, 6, 8)};
  return kGrids;
}

Image panel(const Image& picture, int index) {
  Image part(kPlotWidth, kPlotHeight);
  for (int y = 0; y < kPlotHeight; ++y) {
    for (int x = 0; x < kPlotWidth; ++x) {
      part.at(x, y) =
          picture.at(index % 3 * kPlotWidth + x, kFitSlicesHeader + index / 3 * kPlotHeight + y);
    }
  }
  return part;
}

/// Pixels of the residual map of a picture.
struct MapPixels {
  int white = 0;
  int grey = 0;
  int red = 0;
  int blue = 0;
};
MapPixels map_pixels(const Image& picture) {
  const Image map = panel(picture, 5);
  MapPixels found;
  for (int y = 0; y < kResidualFrame.height; ++y) {
    for (int x = 0; x < kResidualFrame.width; ++x) {
      const Rgb& pixel = map.at(kResidualFrame.x + x, kResidualFrame.y + y);
      // Rounding errors of a fit over a scale of 0.001 do not reach this.
      constexpr double kWhite = 1 - 1e-6;
      if (pixel == kPlotFaint) {
        ++found.grey;
      } else if (std::min({pixel[0], pixel[1], pixel[2]}) > kWhite) {
        ++found.white;
      } else {
        ++(pixel[0] > pixel[2] ? found.red : found.blue);
      }
    }
  }
  return found;
}

Material silk() { return read_material(preset("silk")); }

bool same_size_and_finite(const Image& picture) {
  return picture.width == kFitSlicesWidth && picture.height == kFitSlicesHeight &&
         std::all_of(picture.pixels.begin(), picture.pixels.end(), [](const Rgb& pixel) {
           return std::all_of(pixel.begin(), pixel.end(),
                              [](double c) { return c >= 0 && c <= 1; });
         });
}

constexpr int kMapArea = kResidualFrame.width * kResidualFrame.height;

}  // namespace

TEST_CASE("the residuals of a perfect fit are white, those of a wrong one are not") {
  for (const Grid& grid : fitted_grids()) {
    for (const bool average : {false, true}) {
      if (average && grid.kind == GridKind::kInOut) continue;  // slow, and the same code
      CAPTURE(grid.description(), average);
      const Table table = preset_table("silk", grid, false, {average, 1e-3});
      const MapPixels perfect = map_pixels(fit_slices(table, silk(), 1));
      CHECK(perfect.red + perfect.blue == 0);
      CHECK(perfect.white > 0.85 * kMapArea);
      const auto scaled = [&](double factor) {
        return mapped(table, [=](double v) { return factor * v; });
      };
      const MapPixels higher = map_pixels(fit_slices(scaled(1.1), silk(), 1));
      CHECK(higher.red == perfect.white);
      CHECK(higher.blue == 0);
      const MapPixels lower = map_pixels(fit_slices(scaled(0.9), silk(), 1));
      CHECK(lower.blue == perfect.white);
      CHECK(lower.red == 0);
    }
  }
}

TEST_CASE("dots are the table's values, lines are the fitted material's at the same cells") {
  const Rgb colours[] = {screen_colour(200, 25, 30), screen_colour(20, 125, 35),
                         screen_colour(30, 80, 200)};
  for (const Grid& grid : fitted_grids()) {
    CAPTURE(grid.description());
    const Table table = preset_table("silk", grid);
    const Table fit = preset_table("tamamushi", grid);
    const Image picture = fit_slices(table, read_material(preset("tamamushi")), 2);
    const std::vector<Slice> slices = typical_slices(grid);
    for (std::size_t s = 0; s < slices.size(); ++s) {
      std::vector<Curve> curves;
      for (std::size_t c = 0; c < 3; ++c) {
        curves.push_back({slices[s].x, {}, {}, colours[c]});
        for (const std::size_t cell : slices[s].cells) {
          const double none = std::numeric_limits<double>::quiet_NaN();
          curves[c].dots.push_back(table.valid(cell) ? table.value(cell, c) : none);
          curves[c].line.push_back(fit.valid(cell) ? fit.value(cell, c) : none);
        }
      }
      CAPTURE(slices[s].title.above, slices[s].title.below);
      const bool same = panel(picture, static_cast<int>(s)).pixels ==
                        draw_plot(slices[s].title, slices[s].axis, curves).pixels;
      CHECK(same);
    }
  }
}

TEST_CASE("channels in another order, one or many of them, meet their own absorption") {
  const Grid grid = halfdiff3d(8, 7, 6);
  for (const std::size_t count : {1U, 2U, 6U, 7U, 31U}) {
    Material material = silk();
    material.warp.absorption.clear();
    for (std::size_t c = 0; c < count; ++c) {
      material.warp.absorption.push_back(0.1 + 0.05 * static_cast<double>(c));
      material.wavelengths_nm.push_back(400 + 10 * static_cast<double>(c));
    }
    material.weft.absorption = material.warp.absorption;
    TableSpec spec = material_spec(material, {}, grid);
    std::reverse(spec.channels.begin(), spec.channels.end());
    const Image picture = fit_slices(collect(*make_producer(spec, 1), 1), material, 1);
    CAPTURE(count);
    CHECK(same_size_and_finite(picture));
    const MapPixels found = map_pixels(picture);
    CHECK(found.red + found.blue == 0);
    CHECK(found.white > 0.85 * kMapArea);
  }
}

TEST_CASE("cells that hold no measurement leave no trace") {
  for (const Grid& grid : fitted_grids()) {
    const Table table = preset_table("silk", grid);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -1.0,
                             std::numeric_limits<double>::infinity()}) {
      std::vector<double> values(table.values().begin(), table.values().end());
      for (std::size_t k = 0; k < values.size(); k += 2) values[k] = bad;
      CAPTURE(grid.description(), bad);
      const Image picture = fit_slices(with_values(table, values), silk(), 1);
      CHECK(same_size_and_finite(picture));
      const MapPixels half = map_pixels(picture);
      CHECK(half.red + half.blue == 0);
      CHECK(half.white > 0.7 * kMapArea);
      std::fill(values.begin(), values.end(), bad);
      const Image none = fit_slices(with_values(table, values), silk(), 1);
      CHECK(same_size_and_finite(none));
      CHECK(map_pixels(none).grey == kMapArea);
    }
    // The mask alone takes a cell out, whatever its value.
    const std::vector<double> wrong(table.values().size(), 7);
    const Table masked(table.spec(), wrong,
                       std::vector<std::uint8_t>(table.spec().cell_count(), 0));
    CHECK(map_pixels(fit_slices(masked, silk(), 1)).grey == kMapArea);
  }
}

TEST_CASE("degenerate tables give a picture of the stated size") {
  const std::vector<Grid> small = {
      halfdiff3d(1, 1, 1),    halfdiff3d(1, 5, 4),    halfdiff3d(5, 1, 4), halfdiff3d(5, 4, 1),
      halfdiff4d(1, 1, 1, 1), halfdiff4d(4, 1, 3, 5), inout(1, 1, 1, 1),   inout(3, 1, 1, 4)};
  for (const Grid& grid : small) {
    const Table table = preset_table("silk", grid);
    CAPTURE(grid.description());
    CHECK(same_size_and_finite(fit_slices(table, silk(), 1)));
    for (const double value : {0.0, 5e-324, 1e30, 1e308}) {
      CAPTURE(value);
      const Table constant = mapped(table, [=](double) { return value; });
      CHECK(same_size_and_finite(fit_slices(constant, silk(), 1)));
      const Table one = with_value(table, grid.cell_count() / 2, 1, value);
      CHECK(same_size_and_finite(fit_slices(one, silk(), 1)));
    }
    Material black = silk();
    black.weights = {0, 0, 0};
    CHECK(same_size_and_finite(fit_slices(table, black, 1)));
    CHECK(map_pixels(fit_slices(table, black, 1)).grey == kMapArea);
  }
}

TEST_CASE("a list of pairs is refused, it has no slices") {
  TableSpec spec;
  spec.samples = PairList{{{0, 0, 0, 0}}};
  spec.channels = {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}, {"B", Part::kTotal, 2}};
  CHECK_THROWS_AS(fit_slices(Table(spec, {1, 2, 3}, {1}), silk(), 1), InputError);
}

}  // namespace clothbrdf::test
