#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace clothbrdf {

// Between spectra, linear R, G, B (Rec. 709) and X, Y, Z of the CIE's 1931 observer, in light D65.
//
// Both ways are linear in f_r, so that they hold for every pair of directions alike and a grey
// table stays grey.

/// One row for each channel that comes out, one value in it for each that goes in.
using ChannelMatrix = std::vector<std::vector<double>>;

/// What linear R, G and B are made of, from samples of a reflectance at these wavelengths (nm,
/// strictly ascending, at least one): 3 rows. Reflectance is read as renderers read it, linear
/// between the samples and constant outside, and summed over the rows of kObserver. Each row's
/// weights are scaled to add up to 1, so that a white spectrum is (1, 1, 1): the tables' D65 is that
/// of Rec. 709 only to 1e-4.
/// Colours outside Rec. 709 have values below 0. Throws std::invalid_argument.
ChannelMatrix rgb_weights(std::span<const double> wavelengths_nm);

/// Where spectra from R, G and B are sampled, nm: 380, 405, ... 780.
inline constexpr std::size_t kSpectrumSize = 17;
const std::array<double, kSpectrumSize>& spectrum_wavelengths_nm();

/// The spectrum of R, G and B: 3 values in [0, 1] that add up to 1 at each of those wavelengths
/// (kSpectrumSize rows), the smoothest ones for which rgb_weights give R, G and B back, to 1e-12.
/// Reflectances from 0 to 1 thus stay there.
const ChannelMatrix& spectral_basis();

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// X, Y and Z of linear R, G and B; white has Y = 1 and the chromaticity (0.3127, 0.3290), as in
/// ITU-R BT.709.
inline constexpr Matrix3 kXyzOfRgb = {{
    {0.41239079926595951, 0.35758433938387796, 0.18048078840183429},
    {0.21263900587151036, 0.71516867876775592, 0.072192315360733714},
    {0.019330818715591849, 0.11919477979462599, 0.95053215224966059},
}};

/// Its inverse.
inline constexpr Matrix3 kRgbOfXyz = {{
    {3.2409699419045213, -1.5373831775700935, -0.49861076029300327},
    {-0.96924363628087984, 1.8759675015077206, 0.041555057407175612},
    {0.055630079696993608, -0.20397695888897657, 1.0569715142428786},
}};

}  // namespace clothbrdf
