#include "table/spectrum.h"

#include <algorithm>
#include <stdexcept>

#include "table/cie1931.h"

namespace clothbrdf {
namespace {

struct Share {
  std::size_t sample;  // the one at or below the wavelength
  double above;        // of the next one; the rest is the sample's
};

Share share_at(std::span<const double> wavelengths_nm, double wavelength_nm) {
  if (wavelength_nm <= wavelengths_nm.front()) return {0, 0};
  if (wavelength_nm >= wavelengths_nm.back()) return {wavelengths_nm.size() - 1, 0};
  const auto next = std::upper_bound(wavelengths_nm.begin(), wavelengths_nm.end(), wavelength_nm);
  const double low = *(next - 1);
  return {static_cast<std::size_t>(next - wavelengths_nm.begin()) - 1,
          (wavelength_nm - low) / (*next - low)};
}

// The least sum of squared second differences over all three columns, for nodes 25 nm apart, under
// the conditions that spectral_basis() promises: a quadratic programme as in Mallett and Yuksel,
// "Spectral Primary Decomposition for Rendering with sRGB Reflectance" (2019). Solved once by an
// interior point method; the 16 values that are off the bounds then from the linear equations.
constexpr std::array<std::array<double, kSpectrumSize>, 3> kBasis = {{
    {0.20088840188816909, 0.12303066720644265, 0.04642887812972793, 0, 0, 0, 0, 0,
     0.12395262984436703, 0.92129422596863053, 1, 1, 1, 1, 1, 1, 1},
    {0, 0, 0, 0, 0.21071967549016335, 0.89150555272713627, 1, 1, 0.82069929533625996,
     0.074161936050531035, 0, 0, 0, 0, 0, 0, 0},
    {0.79911159811183607, 0.87696933279355094, 0.95357112187026549, 1, 0.78928032450983765,
     0.1084944472728637, 0, 0, 0.055348074819369146, 0.004543837980833498, 0, 0, 0, 0, 0, 0, 0},
}};

}  // namespace

ChannelMatrix rgb_weights(std::span<const double> wavelengths_nm) {
  if (wavelengths_nm.empty() ||
      std::adjacent_find(wavelengths_nm.begin(), wavelengths_nm.end(),
                         [](double a, double b) { return !(a < b); }) != wavelengths_nm.end()) {
    throw std::invalid_argument("wavelengths must ascend");
  }
  ChannelMatrix weights(3, std::vector<double>(wavelengths_nm.size()));
  for (std::size_t k = 0; k < kObserver.size(); ++k) {
    const ObserverRow& row = kObserver[k];
    const Share share = share_at(wavelengths_nm, observer_wavelength_nm(k));
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& xyz = kRgbOfXyz[c];
      const double seen = row.d65 * (xyz[0] * row.x_bar + xyz[1] * row.y_bar + xyz[2] * row.z_bar);
      weights[c][share.sample] += seen * (1 - share.above);
      if (share.above > 0) weights[c][share.sample + 1] += seen * share.above;
    }
  }
  for (std::vector<double>& row : weights) {
    double white = 0;
    for (const double weight : row) white += weight;
    for (double& weight : row) weight /= white;
  }
  return weights;
}

const std::array<double, kSpectrumSize>& spectrum_wavelengths_nm() {
  static const auto kWavelengths = [] {
    std::array<double, kSpectrumSize> wavelengths{};
    for (std::size_t k = 0; k < kSpectrumSize; ++k) {
      wavelengths[k] = 380 + 25 * static_cast<double>(k);
    }
    return wavelengths;
  }();
  return kWavelengths;
}

const ChannelMatrix& spectral_basis() {
  static const ChannelMatrix kMatrix = [] {
    ChannelMatrix matrix(kSpectrumSize, std::vector<double>(3));
    for (std::size_t k = 0; k < kSpectrumSize; ++k) {
      for (std::size_t c = 0; c < 3; ++c) matrix[k][c] = kBasis[c][k];
    }
    return matrix;
  }();
  return kMatrix;
}

}  // namespace clothbrdf
