#include "fit/noisy_values.h"

#include <array>
#include <cmath>
#include <limits>

#include "model/scalar.h"

namespace clothbrdf {
namespace {

// SplitMix64: short, and good enough for noise.
class Gaussians {
 public:
  explicit Gaussians(std::uint64_t seed) : state_(seed) {}

  // Two independent ones (Box-Muller).
  std::array<double, 2> next() {
    const double radius = std::sqrt(-2 * std::log(unit()));
    const double angle = 2 * pi<double>() * unit();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  double unit() {  // (0, 1]
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return static_cast<double>((z >> 11U) + 1) * 0x1p-53;
  }
  std::uint64_t state_;
};

}  // namespace

ValueSource measured_values(const Observations& observations, const TableSpec& spec,
                            const std::vector<unsigned char>& valid, const ModelValues& model,
                            Weighting weighting, double noise, std::uint64_t seed) {
  return [&observations, &spec, &valid, &model, weighting, noise, seed](
             std::size_t group, std::size_t channel, std::span<double> values) {
    const Observations::Group& g = observations.groups[group];
    Gaussians gaussians(seed ^
                        (group * observations.channels + channel + 1) * 0xd1342543de82ef95ULL);
    const std::size_t columns = spec.column_count();
    const std::size_t row = g.first_value / spec.row_values();
    const std::size_t cell = row * columns + g.first_value % spec.row_values();
    std::array<double, 2> pair{};
    for (std::size_t k = 0; k < g.samples; ++k) {
      double value = model.diffuse[channel];
      for (std::size_t s = 0; s < g.sites; ++s) {
        value += observations.factors[g.first_factor + s * g.samples + k] *
                 model.site[(g.first_site + s) * observations.channels + channel];
      }
      if (noise > 0) {
        if (k % 2 == 0) pair = gaussians.next();
        const double error = noise * pair[k % 2];
        if (weighting == Weighting::kRelative) value *= 1 + error;
        if (weighting == Weighting::kAbsolute) value += error;
        if (weighting == Weighting::kLogarithmic) value *= std::exp(error);
      }
      const bool measured = valid.empty() || valid[cell + k] != 0;
      values[k] = measured ? value : std::numeric_limits<double>::quiet_NaN();
    }
  };
}

}  // namespace clothbrdf
