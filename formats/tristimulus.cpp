#include "formats/tristimulus.h"

#include <cstddef>

#include "table/spectrum.h"

namespace clothbrdf {
namespace {

// X, Y, Z of R = G = B = 1.
constexpr double white(std::size_t row) {
  return kXyzOfRgb[row][0] + kXyzOfRgb[row][1] + kXyzOfRgb[row][2];
}

}  // namespace

Tristimulus to_tristimulus(const Rgb& rgb) {
  const auto relative = [&](std::size_t row) {
    double sum = 0;
    for (std::size_t c = 0; c < rgb.size(); ++c) sum += kXyzOfRgb[row][c] * rgb[c];
    return sum / white(row);
  };
  return {relative(0), relative(1), relative(2)};
}

Rgb to_rgb(const Tristimulus& xyz) {
  const Rgb absolute = {xyz.x * white(0), xyz.y * white(1), xyz.z * white(2)};
  Rgb rgb{};
  for (std::size_t c = 0; c < rgb.size(); ++c) {
    for (std::size_t k = 0; k < rgb.size(); ++k) rgb[c] += kRgbOfXyz[c][k] * absolute[k];
  }
  return rgb;
}

}  // namespace clothbrdf
