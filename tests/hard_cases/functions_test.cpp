#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "model/directions.h"
#include "model/fresnel.h"
#include "model/layers.h"
#include "model/lobe.h"
#include "model/reflectance.h"
#include "tests/catch.h"
#include "tests/hard_cases/accuracy_table.h"
#include "tests/reference/reference_model.h"
#include "tests/support/random_inputs.h"

// The functions of model/ one by one: each in double against itself in 50 digits, at all
// combinations of its hard inputs and at random ones. That the 50 digits are right is for
// tests/reference, which has formulas of its own.

namespace clothbrdf::test {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

using Inputs = std::vector<double>;

/// The hard values of an input, and the range of the random ones.
struct InputRange {
  Inputs hard;
  double low;
  double high;
  bool logarithmic = false;
};

/// A function of some inputs, in two precisions.
struct ModelFunction {
  std::string name;
  double promised;  ///< relative error, over max(1, condition number), in units of epsilon
  std::vector<InputRange> inputs;
  std::function<double(const Inputs&)> of_doubles;
  std::function<Real(const std::vector<Real>&)> of_reals;
};

template <class F>
ModelFunction function(const std::string& name, double promised,
                       const std::vector<InputRange>& inputs, const F& f) {
  return {name, promised, inputs, [f](const Inputs& x) { return f(x); },
          [f](const std::vector<Real>& x) { return f(x); }};
}

template <class T>
LobeAxes<T> axes_of(const T& along, const T& across) {
  return {along, across};
}

template <class T>
BasicYarn<T> yarn_of(const std::vector<T>& x) {
  BasicYarn<T> yarn;
  yarn.lobe_axes = {x[0], x[1]};
  yarn.layers = 64;
  yarn.scatter = x[2];
  yarn.absorption = {T(0)};
  return yarn;
}

/// The light of one event of a yarn of so many layers: cosine, index, absorption.
template <int kLayers, bool kAll, int kEvent, class T>
T weight_of(const std::vector<T>& x) {
  std::vector<T> weights(130);
  BasicYarn<T> yarn;
  yarn.layers = kLayers;
  const Effects effects;
  path_weights(yarn, path_set(kAll ? Paths::kAll : Paths::kSingle, effects, kLayers),
               fresnel(x[0], x[1]), x[2], std::span<T>(weights));
  return weights[kEvent];
}

// Light and eye above the horizon, in degrees, are never nearer to opposite than that.
const InputRange kCosine = {{1e-17, 1e-8, 0.5, 1 - 1e-16, 1}, 0, 1};
const InputRange kIndex = {{1, 1 + 1e-15, 1.5, 3}, 1, 3};
const InputRange kAxis = {{1e-6, 1e-3, 0.5, 0.5 + 1e-15, 1}, 1e-6, 1, true};
const InputRange kAbsorption = {{0, 5e-324, 1e-300, 1, 700}, 1e-12, 100, true};
const InputRange kAngle = {{0, 1e-300, 30, 45, 89.99999999999999, 90, 180, -540, 1e22}, -720, 720};
const InputRange kElevation = {{0, 1e-8, 45, 89.99999999999999}, 0, 90};

std::vector<ModelFunction> model_functions() {
  std::vector<ModelFunction> all;
  const auto add = [&](const char* name, double promised, const std::vector<InputRange>& inputs,
                       const auto& f) { all.push_back(function(name, promised, inputs, f)); };
  // The two ends of a turn are one angle.
  add("reduce_turns", 0, {kAngle}, [](const auto& x) {
    using std::abs;
    return std::decay_t<decltype(x[0])>(abs(reduce_turns(x[0])));
  });
  add("degrees_to_radians", 2, {kAngle}, [](const auto& x) { return degrees_to_radians(x[0]); });
  add("sincosd, sine", 1, {kAngle}, [](const auto& x) { return sincosd(x[0]).sin; });
  add("sincosd, cosine", 1, {kAngle}, [](const auto& x) { return sincosd(x[0]).cos; });
  add("sincosd, of a sum", 2, {kAngle, kElevation},
      [](const auto& x) { return sincosd(two_sum(x[0], x[1])).sin; });
  add("direction", 2, {kElevation, kAngle}, [](const auto& x) { return direction(x[0], x[1])[0]; });
  add("turned", 2, {kCosine, kCosine, kAngle}, [](const auto& x) {
    return turned({x[0], x[1], x[0]}, sincosd(x[2]))[0];
  });
  const std::vector<InputRange> pair = {kElevation, kAngle, kElevation, kAngle, kAngle};
  const auto geometry = [](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    return pair_geometry(BasicDirectionPair<T>{x[0], x[1], x[2], x[3]}, x[4]);
  };
  add("pair_geometry, h_weft", 8, pair, [=](const auto& x) { return geometry(x).h_weft; });
  add("pair_geometry, h_n", 8, pair, [=](const auto& x) { return geometry(x).h_n; });
  add("pair_geometry, cos_theta_d", 8, pair,
      [=](const auto& x) { return geometry(x).cos_theta_d; });
  const InputRange part = {{-1, -1e-8, 1e-8, 0.5}, -1, 1};
  const std::vector<InputRange> vectors = {part, part, kCosine, part, part, kCosine, kAngle};
  const auto of_vectors = [](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    return pair_geometry(Vector3<T>{x[0], x[1], x[2]}, Vector3<T>{x[3], x[4], x[5]}, x[6]);
  };
  add("pair_geometry of vectors, h_weft", 8, vectors,
      [=](const auto& x) { return of_vectors(x).h_weft; });
  add("pair_geometry of vectors, cos_theta_d", 8, vectors,
      [=](const auto& x) { return of_vectors(x).cos_theta_d; });
  const InputRange lean = {{0, 1e-8, 30, 89.99999999999999}, 0, 90};
  add("incidence_cosines", 2, {lean, kElevation, kAngle}, [](const auto& x) {
    return incidence_cosines(sincosd(x[0]), sincosd(x[1]), sincosd(x[2]).cos).o;
  });
  add("fresnel, reflected", 4, {kCosine, kIndex},
      [](const auto& x) { return fresnel(x[0], x[1]).reflected; });
  add("fresnel, transmitted", 4, {kCosine, kIndex},
      [](const auto& x) { return fresnel(x[0], x[1]).transmitted; });
  add("fresnel, cos_theta_t", 4, {kCosine, kIndex},
      [](const auto& x) { return fresnel(x[0], x[1]).cos_theta_t; });
  add("log_directionality", 2, {{{1e-300, 1e-9, 0.5, 1 - 1e-16}, 1e-12, 1, true}},
      [](const auto& x) { return log_directionality(x[0], 7); });
  add("lobe_axes", 4, {kAxis, kAxis, {{0, 1e-9, 0.1, 1 - 1e-16, 1}, 1e-9, 1, true}},
      [](const auto& x) { return lobe_axes(yarn_of(x), 3).along; });
  add("passage, once", 2, {kAbsorption, kCosine},
      [](const auto& x) { return passage(x[0], x[1]).once; });
  add("passage, lost_twice", 2, {kAbsorption, kCosine},
      [](const auto& x) { return passage(x[0], x[1]).lost_twice; });
  const std::vector<InputRange> path = {kCosine, kIndex, kAbsorption};
  add("path_weights, single, 64 layers", 450, path,
      [](const auto& x) { return weight_of<64, false, 127>(x); });
  add("path_weights, all, 8 layers, first", 12, path,
      [](const auto& x) { return weight_of<8, true, 1>(x); });
  add("path_weights, all, 8 layers, later", 450, path,
      [](const auto& x) { return weight_of<8, true, 40>(x); });
  add("path_weights, all, 64 layers, rest", 450, path,
      [](const auto& x) { return weight_of<64, true, 129>(x); });
  const InputRange across = {{0, 1e-8, 0.3}, 1e-9, 0.7, true};
  add("lobe_height", 4, {across, across, kCosine, kAxis, kAxis},
      [](const auto& x) { return lobe_height(x[0], x[1], x[2], axes_of(x[3], x[4])); });
  add("lobe_azimuthal_mean", 4, {across, kCosine, kAxis, kAxis},
      [](const auto& x) { return lobe_azimuthal_mean(x[0], x[1], axes_of(x[2], x[3])); });
  const InputRange from = {{0, 1e-9, 0.5, 1.5}, 0, 1.5};
  const InputRange to = {{1.5707963267948966, 2, 3.141592653589793}, 1.5, 3.1};
  add("lobe_azimuthal_mean, of a part", 8, {across, kCosine, kAxis, kAxis, from, to},
      [](const auto& x) {
        return lobe_azimuthal_mean(x[0], x[1], axes_of(x[2], x[3]), x[4], x[5]);
      });
  const InputRange side = {{0, 1e-300, 1e-12, 1 - 1e-15, 1, 1e12}, 1e-12, 1e12, true};
  const InputRange last = {{1e-12, 1, 1 + 1e-15, 1e12}, 1e-12, 1e12, true};
  add("carlson_rd", 4, {side, side, last},
      [](const auto& x) { return x[0] == 0 && x[1] == 0 ? x[0] : carlson_rd(x[0], x[1], x[2]); });
  add("lobe_integral", 6, {kAxis, kAxis},
      [](const auto& x) { return lobe_integral(axes_of(x[0], x[1])); });
  add("directional_factor, microfacet", 2, {kCosine, kCosine, kCosine, kCosine}, [](const auto& x) {
    return directional_factor(Reflectance::kMicrofacet, x[0], x[1], x[2], x[3]);
  });
  add("directional_factor, paper", 2, {kCosine, kCosine, kCosine, kCosine}, [](const auto& x) {
    return directional_factor(Reflectance::kPaper, x[0], x[1], x[2], x[3]);
  });
  add("diffuse_colour", 2, {kAbsorption, {{0, 1, 1e6}, 0, 10}},
      [](const auto& x) { return diffuse_colour(x[0], x[1]); });
  const InputRange share = {{0, 0.5, 1}, 0, 1};
  add("diffuse_reflectance", 4, {share, kAbsorption, kAbsorption, share}, [](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    BasicMaterial<T> cloth;
    cloth.weights.diffuse = x[0];
    cloth.warp.absorption = {x[1]};
    cloth.weft.absorption = {x[2]};
    cloth.diffuse_path = T(2);
    return diffuse_reflectance<T>(cloth, {x[3], T(1) - x[3]}, 0);
  });
  return all;
}

/// How much a relative change of the inputs changes the value: the sum of |x f'/f|, by differences
/// in 50 digits.
double condition_number(const ModelFunction& f, const std::vector<Real>& x, const Real& value) {
  const Real step("1e-20");
  Real sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    std::vector<Real> moved = x;
    moved[k] = x[k] * (1 - step);
    sum += abs(f.of_reals(moved) - value);
  }
  return static_cast<double>(sum / step / abs(value));
}

struct FunctionError {
  double share = 0;     ///< relative error over max(1, condition number)
  double relative = 0;  ///< at the same input
  long compared = 0;
  Inputs input;
};

void compare(const ModelFunction& f, const Inputs& x, FunctionError& worst) {
  const std::vector<Real> exact_x(x.begin(), x.end());
  const Real exact = f.of_reals(exact_x);
  const double value = f.of_doubles(x);
  if (abs(exact) < Real("1e-290")) {  // parts of it can be subnormal; 0 also where terms cancel
    CAPTURE(f.name, x);
    CHECK(std::abs(value) <= (exact == 0 ? 4 * kEpsilon : 2e-290));
    return;
  }
  if (abs(exact) > Real("1e300")) return;
  ++worst.compared;
  const double relative = static_cast<double>(abs(Real(value) / exact - 1));
  const double share = relative / std::max(1.0, condition_number(f, exact_x, exact));
  if (share <= worst.share) return;  // NaN is not, and stays
  worst.share = share;
  worst.relative = relative;
  worst.input = x;
}

Inputs random_inputs(const ModelFunction& f, RandomInputs& random) {
  Inputs x;
  for (const InputRange& range : f.inputs) {
    x.push_back(range.logarithmic
                    ? std::exp(random.uniform(std::log(range.low), std::log(range.high)))
                    : random.uniform(range.low, range.high));
  }
  return x;
}

}  // namespace

TEST_CASE("every function of the model keeps its stated error at its hard inputs") {
  constexpr int kRandom = 300;
  constexpr std::size_t kMostHard = 1500;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  std::cout << "seed " << seed << '\n';
  std::vector<std::string> rows;
  for (const ModelFunction& f : model_functions()) {
    FunctionError worst;
    std::size_t combinations = 1;
    for (const InputRange& range : f.inputs) combinations *= range.hard.size();
    const std::size_t stride = combinations / kMostHard + 1;
    for (std::size_t n = 0; n < combinations; n += stride) {
      Inputs x;
      std::size_t rest = n;
      for (const InputRange& range : f.inputs) {
        x.push_back(range.hard[rest % range.hard.size()]);
        rest /= range.hard.size();
      }
      compare(f, x, worst);
    }
    for (int n = 0; n < kRandom; ++n) compare(f, random_inputs(f, random), worst);
    std::ostringstream at;
    at << std::setprecision(17);
    for (const double x : worst.input) at << ' ' << x;
    std::cout << f.name << ": " << worst.share / kEpsilon << " epsilon (" << worst.relative
              << " relative) of " << f.promised << ", at" << at.str() << ", " << worst.compared
              << " inputs" << std::endl;
    INFO(f.name << at.str());
    CHECK(worst.compared > 0);
    CHECK(worst.share <= f.promised * kEpsilon);
    std::ostringstream row;
    row << "| " << f.name << " | " << std::setprecision(3) << worst.share / kEpsilon << " | "
        << f.promised << " |\n";
    rows.push_back(row.str());
  }
  check_or_write_rows("| function |", rows);
}

}  // namespace clothbrdf::test
