#include "formats/tristimulus.h"

#include <cstddef>

namespace clothbrdf {
namespace {

using Matrix = std::array<Rgb, 3>;

// The primaries of Rec. 709 and the white that they add up to, chromaticities x, y.
constexpr double kPrimaries[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
constexpr double kWhite[2] = {0.3127, 0.3290};

constexpr Matrix inverse(const Matrix& m) {
  Matrix result{};
  double determinant = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    determinant += m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
    for (std::size_t row = 0; row < 3; ++row) {
      const std::size_t a = (row + 1) % 3;
      const std::size_t b = (row + 2) % 3;
      result[i][row] = m[a][j] * m[b][k] - m[a][k] * m[b][j];
    }
  }
  for (Rgb& row : result) {
    for (double& value : row) value /= determinant;
  }
  return result;
}

constexpr Rgb product(const Matrix& m, const Rgb& v) {
  Rgb result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += m[i][j] * v[j];
  }
  return result;
}

// Rows X, Y, Z; each adds up to 1.
constexpr Matrix to_relative_xyz() {
  Matrix primaries{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double x = kPrimaries[c][0];
    const double y = kPrimaries[c][1];
    primaries[0][c] = x / y;
    primaries[1][c] = 1;
    primaries[2][c] = (1 - x - y) / y;
  }
  const Rgb white = {kWhite[0] / kWhite[1], 1, (1 - kWhite[0] - kWhite[1]) / kWhite[1]};
  const Rgb shares = product(inverse(primaries), white);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) primaries[i][c] *= shares[c] / white[i];
  }
  return primaries;
}

constexpr Matrix kToXyz = to_relative_xyz();
constexpr Matrix kToRgb = inverse(kToXyz);

}  // namespace

Tristimulus to_tristimulus(const Rgb& rgb) {
  const Rgb xyz = product(kToXyz, rgb);
  return {xyz[0], xyz[1], xyz[2]};
}

Rgb to_rgb(const Tristimulus& xyz) { return product(kToRgb, {xyz.x, xyz.y, xyz.z}); }

}  // namespace clothbrdf
