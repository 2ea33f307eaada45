#include "table/spectrum.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>

#include "table/cie1931.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Columns = std::array<std::array<double, kSpectrumSize>, 3>;

Columns basis_columns() {
  Columns columns{};
  for (std::size_t k = 0; k < kSpectrumSize; ++k) {
    for (std::size_t c = 0; c < 3; ++c) columns[c][k] = spectral_basis()[k][c];
  }
  return columns;
}

double roughness(const Columns& columns) {
  double sum = 0;
  for (const auto& b : columns) {
    for (std::size_t k = 1; k + 1 < b.size(); ++k) {
      const double second = b[k - 1] - 2 * b[k] + b[k + 1];
      sum += second * second;
    }
  }
  return sum;
}

// How far the columns are from giving R, G and B back.
double identity_error(const Columns& columns, const ChannelMatrix& weights) {
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = i == c ? -1 : 0;
      for (std::size_t k = 0; k < kSpectrumSize; ++k) sum += weights[i][k] * columns[c][k];
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

// One round of projections, each onto one of the conditions; they end where all hold.
void project(Columns& columns, const ChannelMatrix& weights) {
  for (std::size_t i = 0; i < 3; ++i) {
    double square = 0;
    for (const double weight : weights[i]) square += weight * weight;
    for (std::size_t c = 0; c < 3; ++c) {
      double off = i == c ? -1 : 0;
      for (std::size_t k = 0; k < kSpectrumSize; ++k) off += weights[i][k] * columns[c][k];
      for (std::size_t k = 0; k < kSpectrumSize; ++k) {
        columns[c][k] -= off / square * weights[i][k];
      }
    }
  }
  for (std::size_t k = 0; k < kSpectrumSize; ++k) {
    const double off = columns[0][k] + columns[1][k] + columns[2][k] - 1;
    for (auto& b : columns) b[k] = std::clamp(b[k] - off / 3, 0.0, 1.0);
  }
}

double sum_error(const Columns& columns) {
  double worst = 0;
  for (std::size_t k = 0; k < kSpectrumSize; ++k) {
    worst = std::max(worst, std::abs(columns[0][k] + columns[1][k] + columns[2][k] - 1));
  }
  return worst;
}

std::array<double, 3> rgb_of(const ChannelMatrix& weights, const std::vector<double>& samples) {
  std::array<double, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < samples.size(); ++k) rgb[c] += weights[c][k] * samples[k];
  }
  return rgb;
}

// (x, y) of light with a reflectance of 1.
std::array<double, 2> chromaticity_of_d65() {
  std::array<double, 3> sum{};
  for (const ObserverRow& row : kObserver) {
    sum[0] += row.d65 * row.x_bar;
    sum[1] += row.d65 * row.y_bar;
    sum[2] += row.d65 * row.z_bar;
  }
  const double all = sum[0] + sum[1] + sum[2];
  return {sum[0] / all, sum[1] / all};
}

}  // namespace

TEST_CASE("the observer's tables have the standard's sums, peak and white") {
  CHECK(observer_wavelength_nm(kObserver.size() - 1) == 780);
  CHECK(kObserver[40].d65 == 100);  // 560 nm
  CHECK(kObserver[39].y_bar == 1);  // 555 nm
  // The observer sees equal energy as grey: all three functions enclose the same area.
  double x = 0;
  double y = 0;
  double z = 0;
  for (std::size_t k = 4; k < kObserver.size(); ++k) {  // from 380 nm
    x += kObserver[k].x_bar;
    y += kObserver[k].y_bar;
    z += kObserver[k].z_bar;
  }
  CHECK_THAT(x / y, Catch::Matchers::WithinAbs(1, 1e-4));
  CHECK_THAT(z / y, Catch::Matchers::WithinAbs(1, 1e-4));
  // Rec. 709 rounds D65's chromaticity to four digits.
  constexpr double kRounding = 5e-5;
  const auto white = chromaticity_of_d65();
  CHECK_THAT(white[0], Catch::Matchers::WithinAbs(0.3127, kRounding));
  CHECK_THAT(white[1], Catch::Matchers::WithinAbs(0.3290, kRounding));
}

TEST_CASE(
    "XYZ of RGB has the primaries and the white of Rec. 709, and the other way is its inverse") {
  const double chromaticities[][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  constexpr double kSeventeenDigits = 1e-15;
  for (std::size_t c = 0; c < 3; ++c) {
    const double all = kXyzOfRgb[0][c] + kXyzOfRgb[1][c] + kXyzOfRgb[2][c];
    CHECK_THAT(kXyzOfRgb[0][c] / all,
               Catch::Matchers::WithinAbs(chromaticities[c][0], kSeventeenDigits));
    CHECK_THAT(kXyzOfRgb[1][c] / all,
               Catch::Matchers::WithinAbs(chromaticities[c][1], kSeventeenDigits));
  }
  const double white[] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK_THAT(kXyzOfRgb[i][0] + kXyzOfRgb[i][1] + kXyzOfRgb[i][2],
               Catch::Matchers::WithinAbs(white[i], kSeventeenDigits));
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += kRgbOfXyz[i][k] * kXyzOfRgb[k][c];
      CHECK_THAT(sum, Catch::Matchers::WithinAbs(i == c ? 1 : 0, 1e-15));
    }
  }
}

TEST_CASE("a spectrum of equal values is that grey, whatever its wavelengths") {
  RandomInputs random(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    std::vector<double> wavelengths = {random.uniform(200, 900)};
    for (int k = random.integer(0, 40); k > 0; --k) {
      wavelengths.push_back(wavelengths.back() + random.log_uniform(0.01, 100));
    }
    const double grey = random.uniform(0, 2);
    for (const double rgb :
         rgb_of(rgb_weights(wavelengths), std::vector<double>(wavelengths.size(), grey))) {
      worst = std::max(worst, std::abs(rgb - grey));
    }
  }
  std::cout << "grey spectra: off by " << worst << " (seed " << seed_from_environment() << ")\n";
  CHECK(worst <= 1e-14);
}

TEST_CASE("RGB of spectra agree with an independent program") {
  // colour-science 0.4.7, sd_to_XYZ by integration over 360 to 780 nm, to RGB by kRgbOfXyz and
  // divided by the RGB of a white spectrum. By 5 nm, as here: the same sums. By 1 nm, with D65
  // linear between its values: what summing by 5 nm costs, most where a spectrum has kinks.
  struct Row {
    const char* name;
    std::vector<double> wavelengths_nm;
    std::vector<double> samples;
    std::array<double, 3> by_5_nm;
    std::array<double, 3> by_1_nm;
    double cost;
  };
  const Row rows[] = {
      {"ramp",
       {380, 780},
       {0, 1},
       {0.656110493, 0.407521307, 0.152076187},
       {0.656095074, 0.407523194, 0.152054810},
       1e-4},
      {"step",
       {380, 575, 580, 780},
       {0, 0, 1, 1},
       {1.249441664, 0.054481862, -0.031904797},
       {1.248245200, 0.055031508, -0.031955715},
       2e-3},
      {"bump",
       {450, 500, 550},
       {0.1, 0.8, 0.2},
       {0.021372038, 0.415410795, 0.236337851},
       {0.021717078, 0.415385478, 0.236772739},
       1e-3},
      {"dye",
       {380, 405, 430, 455, 480, 505, 530, 555, 580, 605, 630, 655, 680, 705, 730, 755, 780},
       {0.05, 0.05, 0.06, 0.07, 0.08, 0.1, 0.15, 0.3, 0.55, 0.7, 0.76, 0.8, 0.82, 0.83, 0.84, 0.85,
        0.85},
       {0.886854574, 0.245591276, 0.033637366},
       {0.886446036, 0.245788377, 0.033629717},
       1e-3},
  };
  for (const Row& row : rows) {
    const auto rgb = rgb_of(rgb_weights(row.wavelengths_nm), row.samples);
    double same = 0;
    double finer = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      same = std::max(same, std::abs(rgb[c] - row.by_5_nm[c]));
      finer = std::max(finer, std::abs(rgb[c] - row.by_1_nm[c]));
    }
    std::cout << row.name << ": RGB off by " << same << " from sums by 5 nm, by " << finer
              << " from sums by 1 nm\n";
    CHECK(same <= 1e-8);
    CHECK(finer <= row.cost);
  }
}

TEST_CASE("spectra are read as linear between samples and constant outside") {
  // More samples of the same broken line change nothing.
  const std::vector<double> few = {450, 520, 640};
  const std::vector<double> values = {0.2, 0.9, 0.4};
  const std::vector<double> more = {300, 450, 485, 520, 580, 640, 700, 900};
  const std::vector<double> same = {0.2, 0.2, 0.55, 0.9, 0.65, 0.4, 0.4, 0.4};
  const auto a = rgb_of(rgb_weights(few), values);
  const auto b = rgb_of(rgb_weights(more), same);
  for (std::size_t c = 0; c < 3; ++c) CHECK_THAT(a[c], Catch::Matchers::WithinAbs(b[c], 1e-14));
}

TEST_CASE("wavelengths that do not ascend have no weights") {
  const auto weights = [](std::vector<double> nm) { return rgb_weights(nm); };
  CHECK_THROWS_AS(weights({}), std::invalid_argument);
  CHECK_THROWS_AS(weights({500, 500}), std::invalid_argument);
  CHECK_THROWS_AS(weights({500, 400}), std::invalid_argument);
  CHECK_THROWS_AS(weights({500, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
  CHECK(weights({500}) == ChannelMatrix{{1}, {1}, {1}});
}

TEST_CASE("the spectral basis stays in its range, adds up to 1 and gives R, G and B back") {
  const Columns basis = basis_columns();
  CHECK(spectrum_wavelengths_nm().front() == 380);
  CHECK(spectrum_wavelengths_nm().back() == 780);
  for (const auto& b : basis) {
    for (const double value : b) {
      CHECK(value >= 0);
      CHECK(value <= 1);
    }
  }
  const double identity = identity_error(basis, rgb_weights(spectrum_wavelengths_nm()));
  std::cout << "spectral basis: RGB come back to " << identity << ", sums to " << sum_error(basis)
            << ", squared second differences " << roughness(basis) << '\n';
  CHECK(identity <= 1e-12);
  CHECK(sum_error(basis) <= 1e-14);
}

TEST_CASE("no other basis under the same conditions is smoother") {
  const Columns basis = basis_columns();
  const ChannelMatrix weights = rgb_weights(spectrum_wavelengths_nm());
  constexpr double kFeasible = 1e-9;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double least_rise = std::numeric_limits<double>::infinity();  // over the squared distance
  int tried = 0;
  for (int n = 0; n < 60; ++n) {
    Columns other = basis;
    const double scale = random.log_uniform(1e-3, 1);
    for (auto& b : other) {
      for (double& value : b) value += random.uniform(-scale, scale);
    }
    for (int round = 0; round < 20000; ++round) {
      project(other, weights);
      if (round % 100 == 0 && identity_error(other, weights) + sum_error(other) < kFeasible) break;
    }
    if (identity_error(other, weights) + sum_error(other) >= kFeasible) continue;
    double distance = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < kSpectrumSize; ++k) {
        distance += std::abs(other[c][k] - basis[c][k]);
      }
    }
    ++tried;
    least_rise = std::min(least_rise, (roughness(other) - roughness(basis)) / distance);
  }
  std::cout << "spectral basis: " << tried << " others, all rougher by at least " << least_rise
            << " of their distance (seed " << seed << ")\n";
  CHECK(tried >= 40);
  CHECK(least_rise > 0);
}

}  // namespace clothbrdf::test
