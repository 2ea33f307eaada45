#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <mutex>
#include <sstream>

#include "support/threads.h"
#include "tabulate/batch.h"
#include "tabulate/kernel.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

/// Draws from the ends of every range and from all between.
class ExtremeInputs {
 public:
  explicit ExtremeInputs(std::uint64_t seed) : draw_(seed) {}

  Material material() {
    Material m;
    m.reflectance = draw_.chance(0.7) ? Reflectance::kMicrofacet : Reflectance::kPaper;
    m.paths = draw_.chance(0.7) ? Paths::kAll : Paths::kSingle;
    for (double* weight : {&m.weights.specular, &m.weights.internal, &m.weights.diffuse}) {
      *weight = one_of({0, 1, 100, draw_.unit()});
    }
    m.diffuse_path = one_of({0, 1, 100});
    m.warp_fraction = one_of({0, 1, 1e-12, draw_.unit()});
    m.rotation_deg = one_of({0, 1e300, draw_.azimuth()});
    m.warp = yarn();
    m.weft = draw_.chance(0.2) ? m.warp : yarn();
    return m;
  }

  Directions pair() {
    const double theta_i = theta();
    const double phi_i = draw_.uniform(0, 360);
    double theta_o = theta();
    double phi_o = draw_.uniform(0, 360);
    const double kind = draw_.unit();
    const double off = draw_.log_uniform(1e-15, 1);
    if (kind < 0.2) phi_o = phi_i + 180 + off;
    if (kind < 0.1) theta_o = std::min(theta_i * (1 - off), 90 - 1.5e-14);
    if (kind > 0.95) return {direction(theta_i, phi_i), direction(theta_i, phi_i)};
    return {direction(theta_i, phi_i), direction(theta_o, phi_o)};
  }

 private:
  double one_of(std::initializer_list<double> values) {
    return values.begin()[draw_.integer(0, static_cast<int>(values.size()) - 1)];
  }
  double theta() {
    const double kind = draw_.unit();
    if (kind < 0.1) return 90 - draw_.log_uniform(1.5e-14, 10);
    return kind < 0.15 ? draw_.log_uniform(1e-15, 1) : draw_.uniform(0, 90);
  }
  Yarn yarn() {
    Yarn y;
    for (double& axis : y.lobe_axes) {
      axis = one_of({1e-6, 1, draw_.log_uniform(1e-6, 1), draw_.log_uniform(1e-2, 1)});
    }
    for (int c = 0; c < 3; ++c) {
      y.absorption.push_back(one_of(
          {0, 5e-324, 1e-300, 700, 1e6, draw_.log_uniform(1e-6, 10), draw_.unit(), draw_.unit()}));
    }
    y.layers = draw_.chance(0.7) ? draw_.integer(0, 8) : draw_.integer(0, 64);
    y.refractive_index =
        one_of({1, 1 + 1e-15, 3, 1 + draw_.log_uniform(1e-12, 1), draw_.uniform(1.2, 2)});
    y.scatter = one_of({0, 1, 1e-9, 1 - 1.2e-16, draw_.log_uniform(1e-4, 1), draw_.unit()});
    if (draw_.chance(0.3)) y.scatter_limit = std::max(y.lobe_axes[0], y.lobe_axes[1]);
    return y;
  }

  RandomInputs draw_;
};

/// What went wrong, of how many values.
struct Findings {
  long values = 0;
  long not_numbers = 0;
  long negative = 0;
  long needlessly_infinite = 0;
  long not_reciprocal = 0;
  std::string first = {};

  long all() const { return not_numbers + negative + needlessly_infinite + not_reciprocal; }
  void add(const Findings& others) {
    values += others.values;
    not_numbers += others.not_numbers;
    negative += others.negative;
    needlessly_infinite += others.needlessly_infinite;
    not_reciprocal += others.not_reciprocal;
    if (first.empty()) first = others.first;
  }
  void add(long& count, const Material& material, const Directions& d, std::size_t channel,
           double value) {
    ++count;
    if (!first.empty()) return;
    std::ostringstream text;
    text << std::setprecision(17) << "value " << value << " of channel " << channel << " at "
         << d.wi[0] << ' ' << d.wi[1] << ' ' << d.wi[2] << ", " << d.wo[0] << ' ' << d.wo[1] << ' '
         << d.wo[2] << '\n';
    test::print(text, material, {});
    first = text.str();
  }
  void print_to_cout(const char* what) const {
    std::cout << what << ": " << values << " values, " << not_numbers << " no numbers, " << negative
              << " negative, " << needlessly_infinite << " infinite though they fit, "
              << not_reciprocal << " not reciprocal\n"
              << first << std::flush;
  }
};

/// Values that a batch gave: [channel][pair].
template <class T>
std::vector<std::vector<T>> batch_values(const BatchEvaluator<T>& evaluator,
                                         const std::vector<Directions>& pairs, bool swapped,
                                         std::size_t channels) {
  std::array<std::vector<T>, 6> in;
  for (const Directions& d : pairs) {
    for (std::size_t k = 0; k < 3; ++k) {
      in[k].push_back(static_cast<T>(swapped ? d.wo[k] : d.wi[k]));
      in[3 + k].push_back(static_cast<T>(swapped ? d.wi[k] : d.wo[k]));
    }
  }
  std::vector<std::vector<T>> values(channels, std::vector<T>(pairs.size()));
  std::vector<T*> to;
  for (std::vector<T>& channel : values) to.push_back(channel.data());
  evaluator.evaluate({{in[0].data(), in[1].data(), in[2].data()},
                      {in[3].data(), in[4].data(), in[5].data()},
                      pairs.size()},
                     to);
  return values;
}

// Volatile: g++ 12 leaves out the rounding of neighbours that it puts into one vector.
template <class T>
Vector3<double> rounded(const Vector3<double>& v) {
  Vector3<double> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const volatile T component = static_cast<T>(v[k]);
    result[k] = component;
  }
  return result;
}

// The largest value that must not become infinite.
template <class T>
constexpr double kFits = sizeof(T) == sizeof(float) ? 1e37 : 1e300;

template <class T>
void soak_batches(const Material& material, const std::vector<Directions>& pairs,
                  Findings& findings) {
  const ClothModel<double> model(material);
  const std::vector<Channel> channels = material_channels(material, pairs.size() % 2 == 0);
  const BatchEvaluator<T> evaluator(model, channels, 1);
  const auto values = batch_values(evaluator, pairs, false, channels.size());
  const auto mirrored = batch_values(evaluator, pairs, true, channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const T value = values[c][p];
      ++findings.values;
      if (std::isnan(value)) findings.add(findings.not_numbers, material, pairs[p], c, value);
      if (value < 0) findings.add(findings.negative, material, pairs[p], c, value);
      if (material.reflectance == Reflectance::kMicrofacet && value != mirrored[c][p]) {
        findings.add(findings.not_reciprocal, material, pairs[p], c, value);
      }
      if (!std::isinf(value)) continue;
      const Components exact = model.evaluate(
          pair_geometry(rounded<T>(pairs[p].wi), rounded<T>(pairs[p].wo), material.rotation_deg));
      if (channel_value(exact, channels[c]) < kFits<T>) {
        findings.add(findings.needlessly_infinite, material, pairs[p], c, value);
      }
    }
  }
}

void soak_formula(const Material& material, const Directions& d, Findings& findings) {
  const ClothModel<double> model(material);
  const auto at = [&](const Vector3<double>& wi, const Vector3<double>& wo) {
    return model.evaluate(pair_geometry(wi, wo, material.rotation_deg));
  };
  const Components f = at(d.wi, d.wo);
  const Components back = at(d.wo, d.wi);
  for (std::size_t c = 0; c < material.channel_count(); ++c) {
    const double value = f.total(c);
    ++findings.values;
    if (std::isnan(value)) findings.add(findings.not_numbers, material, d, c, value);
    if (value < 0) findings.add(findings.negative, material, d, c, value);
    if (material.reflectance == Reflectance::kMicrofacet && value != back.total(c)) {
      findings.add(findings.not_reciprocal, material, d, c, value);
    }
  }
}

/// What was found in one material or in many.
struct Soak {
  Findings floats = {};
  Findings doubles = {};
  Findings formula = {};

  void add(const Soak& others) {
    floats.add(others.floats);
    doubles.add(others.doubles);
    formula.add(others.formula);
  }
  void print_to_cout() const {
    floats.print_to_cout("float batches");
    doubles.print_to_cout("double batches");
    formula.print_to_cout("the plain formula");
  }
};

/// One random material at so many random pairs, and at a few by the plain formula.
Soak soak_material(std::uint64_t seed, std::size_t pair_count) {
  constexpr std::size_t kFormulaPairs = 100;
  ExtremeInputs draw(seed);
  const Material material = draw.material();
  std::vector<Directions> pairs;
  while (pairs.size() < pair_count) pairs.push_back(draw.pair());
  Soak found;
  soak_batches<float>(material, pairs, found.floats);
  soak_batches<double>(material, pairs, found.doubles);
  for (std::size_t p = 0; p < kFormulaPairs; ++p) soak_formula(material, pairs[p], found.formula);
  return found;
}

}  // namespace

TEST_CASE(
    "no evaluation of extreme materials gives a negative value, no number or a needless "
    "infinity, and all are reciprocal") {
  // CLOTHBRDF_SOAK_CASES=100000 means 10,000 materials, 1e9 values in floats and as many in
  // doubles.
  const auto materials = static_cast<std::size_t>(std::max(150, soak_cases(0) / 10));
  const std::size_t pairs = materials > 1000 ? 20000 : 2000;
  const std::uint64_t seed = seed_from_environment();
  std::cout << materials << " materials, the seeds " << seed << " and after" << std::endl;
  Soak all;
  std::size_t done = 0;
  std::mutex adding;
  const int threads = default_threads();
  with_threads(threads, [&] {
    run_parallel(materials, threads, [&](std::size_t n) {
      const Soak found = soak_material(seed + n, pairs + n % 2);
      const std::lock_guard lock(adding);
      all.add(found);
      if (++done % 1000 > 0 || done == materials) return;
      std::cout << done << " of " << materials << " materials:\n";
      all.print_to_cout();
    });
  });
  all.print_to_cout();
  CHECK(all.floats.all() == 0);
  CHECK(all.doubles.all() == 0);
  CHECK(all.formula.all() == 0);
}

}  // namespace clothbrdf::test
