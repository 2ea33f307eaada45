#pragma once

#include <array>
#include <iostream>
#include <sstream>
#include <string>

#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/reference/reference_model.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {

/// Relative error of ClothModel<double> (model.md, section 9).
inline constexpr double kPromise = 1e-13;
/// Smaller results are excepted from the promise: their parts can be subnormal.
inline const Real kSmallest("1e-290");
/// So are larger ones, which may overflow.
inline const Real kLargest("1e300");

/// The largest error seen, and the input that gave it.
struct WorstCase {
  double error = 0;     ///< relative, or a multiple of what is promised
  double relative = 0;  ///< always relative
  long compared = 0;
  std::string input;

  void offer(double new_error, double new_relative, const Material& material,
             const DirectionPair& pair, std::size_t channel) {
    ++compared;
    if (new_error <= error) return;  // NaN is not, and stays
    error = new_error;
    relative = new_relative;
    std::ostringstream text;
    text << "channel " << channel << ' ';
    print(text, material, pair);
    input = text.str();
  }
};

/// The worst cases of specular, internal and diffuse.
struct WorstCases {
  std::array<WorstCase, 3> components;

  /// Printed even when all is well: the measured figure belongs beside the promised one.
  void print_to_cout(const std::string& title) const {
    const std::array<const char*, 3> names = {"specular", "internal", "diffuse"};
    std::cout << title << '\n';
    for (std::size_t k = 0; k < names.size(); ++k) {
      const WorstCase& worst = components[k];
      std::cout << "  " << names[k] << ": " << worst.relative << " relative, " << worst.error
                << " of the promise, of " << worst.compared << " values\n    " << worst.input;
    }
  }

  double largest() const {
    double largest = 0;
    for (const WorstCase& worst : components) {
      if (!(worst.error <= largest)) largest = worst.error;
    }
    return largest;
  }
};

inline double relative_error(double value, const Real& exact) {
  return static_cast<double>(abs(Real(value) / exact - 1));
}

/// Compares the double model with the reference for both conventions and both path sets.
/// `promise(component, material, channel, values)` is the relative error that is allowed; errors
/// are recorded as multiples of it.
template <class Promise>
void compare_with_reference(Material material, const DirectionPair& pair,
                            const ReferenceValues& exact, const Promise& promise,
                            WorstCases& worst) {
  for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
    for (const Paths paths : {Paths::kAll, Paths::kSingle}) {
      material.reflectance = reflectance;
      material.paths = paths;
      const Components f =
          ClothModel<double>(material).evaluate(pair_geometry<double>(pair, material.rotation_deg));
      const ReferenceComponents& e = exact.of(reflectance, paths);
      const std::array<const std::vector<double>*, 3> values = {&f.specular, &f.internal,
                                                                &f.diffuse};
      const std::array<const ReferenceChannels*, 3> references = {&e.specular, &e.internal,
                                                                  &e.diffuse};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t channel = 0; channel < material.channel_count(); ++channel) {
          const double value = (*values[k])[channel];
          const Real& reference = (*references[k])[channel];
          if (reference < kSmallest) {
            CHECK((value >= 0 && Real(value) < 2 * kSmallest));
            continue;
          }
          if (reference > kLargest) continue;
          const double relative = relative_error(value, reference);
          worst.components[k].offer(relative / promise(k, material, channel, exact), relative,
                                    material, pair, channel);
        }
      }
    }
  }
}

}  // namespace clothbrdf::test
