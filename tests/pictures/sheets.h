#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "formats/material_json.h"
#include "preview/sheet.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

inline std::unique_ptr<Cloth> preset_cloth(const std::string& name) {
  return material_cloth(read_material(preset(name)), name);
}

/// The sheet of a cloth with its weave turned.
inline Image sheet_of(const Cloth& cloth, const SheetView& view, Part part = Part::kTotal,
                      double turn_deg = 0) {
  return render_sheet(turned(cloth.shading(part), turn_deg), view, 2);
}

/// The slope of the sheet at the middle of a pixel.
inline Slope slope_at(int size, int column, int row) {
  return sheet_slope((column + 0.5) / size, (size - row - 0.5) / size);
}

inline double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

inline std::vector<double> luminances(const Image& image) {
  std::vector<double> values;
  for (const Rgb& pixel : image.pixels) values.push_back(luminance(pixel));
  return values;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// A share of the values, 0 to 1, is at most this.
inline double percentile(std::vector<double> values, double share) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(share * last));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The differences of two pictures over all channels, relative to the mean square of the first.
struct Difference {
  double rms = 0;
  double max = 0;  ///< the largest, relative to the root mean square of the first
};
inline Difference difference(const Image& a, const Image& b) {
  double squares = 0;
  double off = 0;
  double largest = 0;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = b.pixels[p][c] - a.pixels[p][c];
      squares += a.pixels[p][c] * a.pixels[p][c];
      off += d * d;
      largest = std::max(largest, std::abs(d));
    }
  }
  const double count = 3 * static_cast<double>(a.pixels.size());
  return {std::sqrt(off / squares), largest / std::sqrt(squares / count)};
}

}  // namespace clothbrdf::test
