#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace clothbrdf {

using Rgb = std::array<double, 3>;  ///< linear, Rec. 709

/// A picture in linear light, Rec. 709; 1 is white. Rows from the top.
struct Image {
  Image(int w, int h, const Rgb& fill = {0, 0, 0})
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

  Rgb& at(int x, int y) { return pixels[index(x, y)]; }
  const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }

  int width;
  int height;
  std::vector<Rgb> pixels;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

}  // namespace clothbrdf
