#include "tabulate/isotropic_mean.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace clothbrdf {
namespace {

constexpr double kLobeTolerance = 2e-13;
constexpr double kTableTolerance = 7e-13;

}  // namespace

IsotropicMean::IsotropicMean(const ClothModel<double>& model, std::vector<Channel> channels,
                             Workers workers)
    : lanes_(model, std::move(channels), kLobeTolerance) {
  if (lanes_.error() <= kLobeTolerance) {
    table_ = weight_table<double>(lanes_, kTableTolerance, workers);
  }
}

// As the batch kernel does, a lane at a time; [channel][lane].
void IsotropicMean::weights(double cos_theta_d, std::span<double> weights) const {
  if (table_.lanes == 0) {
    lanes_.weights(cos_theta_d, weights);
    return;
  }
  const double y = cos_theta_d + kWeightShift;
  const int octave = std::ilogb(y);
  const double place = std::ldexp(std::ldexp(y, -octave) - 1, table_.piece_bits);
  const double piece = std::floor(place);
  const double t = 2 * (place - piece) - 1;
  const auto row = (static_cast<std::size_t>(octave - kFirstOctave)
                    << static_cast<unsigned>(table_.piece_bits)) +
                   static_cast<std::size_t>(piece);
  const double* power = table_.coefficients.data() + row * table_.row_size();
  const std::size_t lanes = lanes_.size();
  for (std::size_t c = 0; c < table_.channels; ++c) {
    double* const to = weights.data() + c * lanes;
    std::copy_n(power + kWeightDegree<double> * table_.lanes, lanes, to);
    for (std::size_t k = kWeightDegree<double>; k-- > 0;) {
      for (std::size_t l = 0; l < lanes; ++l) to[l] = to[l] * t + power[k * table_.lanes + l];
    }
    power += (kWeightDegree<double> + 1) * table_.lanes;
  }
}

void IsotropicMean::fill(std::span<const Directions> pairs, std::span<double> values) const {
  const std::size_t channels = lanes_.channels().size();
  const std::size_t lanes = lanes_.size();
  std::vector<double> density(lanes);
  std::vector<double> weight(lanes * channels);
  for (const Directions& pair : pairs) {
    const std::span<double> to = values.first(channels);
    values = values.subspan(channels);
    const PairGeometry<double> g = pair_geometry(pair.wi, pair.wo, 0.0);
    if (!g.above_horizon()) {
      std::fill(to.begin(), to.end(), 0.0);
      continue;
    }
    const double sin2 = g.h_weft * g.h_weft + g.h_warp * g.h_warp;
    const double cos2 = g.h_n * g.h_n;
    for (std::size_t l = 0; l < lanes; ++l) {
      density[l] =
          1 / std::sqrt((sin2 * lanes_.weft()[l] + cos2) * (sin2 * lanes_.warp()[l] + cos2));
    }
    weights(std::min(g.cos_theta_d, 1.0), weight);
    const double factor =
        g.h_n * lanes_.model().factor(g.h_n, g.cos_theta_d, g.cos_theta_i, g.cos_theta_o);
    for (std::size_t c = 0; c < channels; ++c) {
      double sum = 0;
      for (std::size_t l = 0; l < lanes; ++l) sum += weight[c * lanes + l] * density[l];
      to[c] = factor * sum + lanes_.constant(c);
    }
  }
}

}  // namespace clothbrdf
