#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iomanip>
#include <numbers>
#include <ostream>
#include <random>
#include <string>

#include "model/directions.h"
#include "model/effects.h"
#include "model/material.h"

namespace clothbrdf::test {

inline constexpr double kPi = std::numbers::pi;

/// The seed of the random tests: CLOTHBRDF_SEED, or always the same one.
inline std::uint64_t seed_from_environment() {
  const char* text = std::getenv("CLOTHBRDF_SEED");
  return text ? std::strtoull(text, nullptr, 10) : 20260101;
}

/// How many cases a soaking test draws: CLOTHBRDF_SOAK_CASES where that is more than usual.
inline int soak_cases(int usual) {
  const char* text = std::getenv("CLOTHBRDF_SOAK_CASES");
  const long wanted = text ? std::strtol(text, nullptr, 10) : 0;
  return wanted > usual ? static_cast<int>(wanted) : usual;
}

/// Ranges that random materials are drawn from.
struct MaterialRanges {
  double lowest_axis = 0.03;
  double highest_absorption = 3;
  double lowest_index = 1.2;
  double highest_index = 2;
  double highest_scatter = 0.5;
  int most_layers = 8;
};

/// Draws that are the same on every platform and standard library: the engine's output is fixed by
/// the standard, the mapping is our own.
class RandomInputs {
 public:
  explicit RandomInputs(std::uint64_t seed) : engine_(seed) {}

  /// [0, 1), 53 bits.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double lowest, double highest) { return lowest + (highest - lowest) * unit(); }
  double log_uniform(double lowest, double highest) {
    return std::exp(uniform(std::log(lowest), std::log(highest)));
  }
  /// [lowest, highest].
  int integer(int lowest, int highest) {
    return lowest + static_cast<int>(unit() * (highest - lowest + 1));
  }
  bool chance(double probability) { return unit() < probability; }

  Yarn yarn(const MaterialRanges& ranges, std::size_t channels) {
    Yarn yarn;
    for (double& axis : yarn.lobe_axes) axis = log_uniform(ranges.lowest_axis, 1);
    for (std::size_t c = 0; c < channels; ++c) yarn.absorption.push_back(absorption(ranges));
    yarn.layers = integer(1, ranges.most_layers);
    yarn.refractive_index = uniform(ranges.lowest_index, ranges.highest_index);
    if (chance(0.75)) {
      yarn.scatter = chance(0.1) ? log_uniform(1e-4, ranges.highest_scatter)
                                 : uniform(0, ranges.highest_scatter);
    }
    if (chance(0.4)) {
      yarn.scatter_limit = uniform(std::fmax(yarn.lobe_axes[0], yarn.lobe_axes[1]), 1);
    }
    return yarn;
  }

  Material material(const MaterialRanges& ranges, std::size_t channels = 3) {
    Material material;
    material.reflectance = chance(0.5) ? Reflectance::kMicrofacet : Reflectance::kPaper;
    material.paths = chance(0.5) ? Paths::kAll : Paths::kSingle;
    material.weights = {uniform(0.1, 2), uniform(0.1, 2), uniform(0.1, 2)};
    material.diffuse_path = uniform(0, 3);
    material.warp_fraction = uniform(0, 1);
    material.rotation_deg = azimuth();
    material.warp = yarn(ranges, channels);
    material.weft = yarn(ranges, channels);
    return material;
  }

  /// theta at most 89.9 degrees; a share of special azimuths, of grazing directions and of pairs
  /// close to the mirror direction, where narrow lobes are not small.
  DirectionPair pair() {
    DirectionPair pair{theta(), azimuth(), theta(), azimuth()};
    if (chance(0.1)) {
      pair.phi_i = 30.0 * integer(-24, 24);
      pair.phi_o = pair.phi_i + 30.0 * integer(-6, 6);
    }
    if (chance(0.25)) {
      const double off = log_uniform(1e-9, 10);
      pair.theta_o = std::fmin(std::fabs(pair.theta_i + off * uniform(-1, 1)), 89.9);
      pair.phi_o = pair.phi_i + 180 + off * uniform(-1, 1);
    }
    return pair;
  }

  /// Each effect is off now and then, limits included.
  Effects effects() {
    Effects effects;
    for (const auto& [name, member] : kComponentEffects) effects.*member = chance(0.8);
    for (const auto& [name, member] : kOtherEffects) effects.*member = chance(0.7);
    if (chance(0.2)) effects.layers = integer(0, 4);
    if (chance(0.2)) effects.events = integer(1, 30);
    if (chance(0.2)) effects.cos_theta_d = uniform(0.05, 1);
    return effects;
  }

  /// In degrees, more than a turn either way; a quarter are multiples of 30.
  double azimuth() {
    if (chance(0.25)) return 30.0 * integer(-24, 24);
    return chance(0.1) ? uniform(-1e6, 1e6) : uniform(-720, 720);
  }

 private:
  double theta() {
    if (chance(0.05)) return 0;
    return chance(0.2) ? uniform(85, 89.9) : uniform(0, 89.9);
  }

  /// From clear to nearly opaque: half of the draws even, a tenth exactly 0.
  double absorption(const MaterialRanges& ranges) {
    if (chance(0.1)) return 0;
    return chance(0.4) ? log_uniform(1e-4, ranges.highest_absorption)
                       : uniform(0, ranges.highest_absorption);
  }

  std::mt19937_64 engine_;
};

/// Everything needed to replay a case, every digit of it.
inline void print(std::ostream& out, const Yarn& yarn) {
  out << "axes " << yarn.lobe_axes[0] << ' ' << yarn.lobe_axes[1] << " absorption";
  for (const double a : yarn.absorption) out << ' ' << a;
  out << " layers " << yarn.layers << " index " << yarn.refractive_index << " scatter "
      << yarn.scatter << " limit ";
  if (yarn.scatter_limit) {
    out << *yarn.scatter_limit;
  } else {
    out << "none";
  }
}

inline void print(std::ostream& out, const Material& material, const DirectionPair& pair) {
  const auto old = out.precision(17);
  out << (material.reflectance == Reflectance::kPaper ? "paper" : "microfacet")
      << (material.paths == Paths::kAll ? " all" : " single") << " weights "
      << material.weights.specular << ' ' << material.weights.internal << ' '
      << material.weights.diffuse << " diffuse_path " << material.diffuse_path << " warp_fraction "
      << material.warp_fraction << " rotation " << material.rotation_deg << "\n    warp ";
  print(out, material.warp);
  out << "\n    weft ";
  print(out, material.weft);
  out << "\n    theta_i " << pair.theta_i << " phi_i " << pair.phi_i << " theta_o " << pair.theta_o
      << " phi_o " << pair.phi_o << '\n';
  out.precision(old);
}

}  // namespace clothbrdf::test
