#include "tabulate/precision_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "support/threads.h"
#include "tabulate/batch.h"
#include "tabulate/kernel.h"

namespace clothbrdf {
namespace {

using Extended = long double;
static_assert(std::numeric_limits<Extended>::digits >= 64, "needs what double has not");

BasicYarn<Extended> extended(const Yarn& yarn) {
  BasicYarn<Extended> result;
  result.lobe_axes = {Extended(yarn.lobe_axes[0]), Extended(yarn.lobe_axes[1])};
  result.absorption.assign(yarn.absorption.begin(), yarn.absorption.end());
  result.layers = yarn.layers;
  result.refractive_index = yarn.refractive_index;
  result.scatter = yarn.scatter;
  if (yarn.scatter_limit) result.scatter_limit = Extended(*yarn.scatter_limit);
  return result;
}

BasicMaterial<Extended> extended(const Material& material) {
  BasicMaterial<Extended> result;
  result.reflectance = material.reflectance;
  result.paths = material.paths;
  result.weights = {Extended(material.weights.specular), Extended(material.weights.internal),
                    Extended(material.weights.diffuse)};
  result.diffuse_path = material.diffuse_path;
  result.warp_fraction = material.warp_fraction;
  result.rotation_deg = material.rotation_deg;
  result.warp = extended(material.warp);
  result.weft = extended(material.weft);
  return result;
}

Vector3<Extended> extended(const Vector3<double>& v) { return {v[0], v[1], v[2]}; }

// Volatile: g++ 12 leaves out the rounding of neighbours that it puts into one vector.
Vector3<double> rounded_to_float(const Vector3<double>& v) {
  Vector3<double> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const volatile float component = static_cast<float>(v[k]);
    result[k] = component;
  }
  return result;
}

// What the scalars can hold.
struct Range {
  double smallest;
  double largest;
};
constexpr Range kDoubleRange = {1e-290, 1e300};
constexpr Range kFloatRange = {1e-36, 1e37};

double narrowest(const Yarn& yarn) { return std::min(yarn.lobe_axes[0], yarn.lobe_axes[1]); }

// From angles in degrees, for a channel's part.
double promise_of_formula(const Material& material, const Channel& channel,
                          const PairGeometry<double>& g) {
  constexpr double kUsual = 1e-13;
  constexpr double kLargestExponent = 300;
  constexpr double kRounding = 4e-16;
  double largest = 0;
  double promise = kUsual;
  for (const Yarn* yarn : {&material.warp, &material.weft}) {
    const double absorption = yarn->absorption[channel.colour];
    const double n = yarn->refractive_index;
    const double cos_theta_t = std::sqrt((n - 1) * (n + 1) + g.cos_theta_d * g.cos_theta_d) / n;
    if (channel.part == Part::kInternal || channel.part == Part::kTotal) {
      if (absorption > 0) largest = std::max(largest, 2 * absorption / cos_theta_t);
    }
    if (channel.part == Part::kDiffuse || channel.part == Part::kTotal) {
      largest = std::max(largest, absorption * material.diffuse_path);
    }
  }
  if (largest >= kLargestExponent) promise = kRounding * largest;
  if (channel.part == Part::kDiffuse) return promise;
  const double axis = std::min(narrowest(material.warp), narrowest(material.weft));
  const double lean = std::min(std::abs(g.h_weft), std::abs(g.h_warp));
  return promise + kRounding / std::max(lean, axis);
}

// How much h / axis magnifies the roundings of vectors.
double condition(const Material& material, double cos_theta_d) {
  return 1 / (std::min(narrowest(material.warp), narrowest(material.weft)) * cos_theta_d);
}

/// Values of one kind of evaluation, at one pair after the other.
class Comparison {
 public:
  Comparison(std::string evaluation, const Range& range) : range_(range) {
    figure_.evaluation = std::move(evaluation);
  }

  void add(const DirectionPair& pair, const Channel& channel, double value, const Extended& exact,
           double promised) {
    if (!(exact < range_.largest)) return;
    double error = 0;
    if (exact < range_.smallest) {
      error = value >= 0 && value <= 2 * range_.smallest ? 0 : HUGE_VAL;
    } else if (std::isfinite(value)) {
      error = static_cast<double>(std::abs(Extended{value} / exact - 1));
    } else {
      error = HUGE_VAL;
    }
    const std::lock_guard lock(mutex_);
    ++figure_.compared;
    figure_.worst = std::max(figure_.worst, error);
    const double share = error / promised;
    if (share <= figure_.worst_share && figure_.compared > 1) return;
    figure_.worst_share = share;
    figure_.error = error;
    figure_.promised = promised;
    figure_.pair = pair;
    figure_.channel = channel;
    figure_.value = value;
    figure_.exact = static_cast<double>(exact);
  }

  const PrecisionFigure& figure() const { return figure_; }

 private:
  Range range_;
  std::mutex mutex_;
  PrecisionFigure figure_;
};

/// f_r of a batch of one pair, which has the bits of any batch.
template <class T>
class SinglePairs {
 public:
  SinglePairs(const ClothModel<double>& model, const std::vector<Channel>& channels,
              Workers workers)
      : evaluator_(model, channels, workers), channels_(channels.size()) {}

  std::vector<T> operator()(const Directions& d) const {
    std::array<T, 6> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = static_cast<T>(d.wi[k]);
      at[3 + k] = static_cast<T>(d.wo[k]);
    }
    std::vector<T> values(channels_);
    std::vector<T*> to;
    to.reserve(channels_);
    for (T& value : values) to.push_back(&value);
    evaluator_.evaluate({{&at[0], &at[1], &at[2]}, {&at[3], &at[4], &at[5]}, 1}, to);
    return values;
  }

 private:
  BatchEvaluator<T> evaluator_;
  std::size_t channels_;
};

// Degrees that are not 90 although their vectors' z may round to 0.
constexpr double kNextToHorizon = 90 - 0x1p-46;

}  // namespace

std::vector<DirectionPair> hard_pairs(const Material& material) {
  std::vector<DirectionPair> pairs;
  const double turn = std::remainder(material.rotation_deg, 360);
  // The eye at the light: the half vector runs from the pole to the horizon.
  for (const double theta : {0.0, 1e-9, 30.0, 89.9, 89.9999, 90 - 1e-9, kNextToHorizon}) {
    pairs.push_back({theta, turn + 20, theta, turn + 20});
  }
  // Nearly opposite, and the half vector at the pole or a little beside it.
  for (const double theta : {1e-9, 45.0, 89.9, 89.9999, 90 - 1e-9, kNextToHorizon}) {
    for (const double off : {0.0, 1e-12, 1e-6, 1e-3}) {
      pairs.push_back({theta, turn + 20, theta * (1 - off), turn + 200 + off});
    }
  }
  // Light or eye alone at grazing incidence.
  for (const double theta : {89.9, 90 - 1e-9, kNextToHorizon}) {
    for (const double other : {0.0, 45.0, 89.0}) {
      pairs.push_back({theta, turn + 20, other, turn + 110});
      pairs.push_back({other, turn - 50, theta, turn + 130});
    }
  }
  // Half vectors that lean across a yarn, on the crest of its lobe and some axes beside it.
  const auto [narrow, wide] = std::minmax({narrowest(material.warp), narrowest(material.weft)});
  for (const double across : {0.0, 90.0}) {
    for (const double axis : {narrow, wide}) {
      for (const double beside : {0.0, 0.3, 3.0}) {
        const double azimuth = turn + across + beside * axis / kRadian;
        pairs.push_back({40, azimuth - 35, 40, azimuth + 35});
        pairs.push_back({85, azimuth - 80, 85, azimuth + 80});
      }
    }
  }
  return pairs;
}

std::vector<PrecisionFigure> check_precision(const Material& material,
                                             std::span<const DirectionPair> pairs,
                                             Workers workers) {
  if (workers.progress != nullptr) {
    workers.progress->begin("extended precision", pairs.size(), "pairs of directions");
  }
  const std::vector<Channel> channels = material_channels(material, true);
  const ClothModel<double> model(material);
  const ClothModel<Extended> exact_model(extended(material));
  const SinglePairs<double> doubles(model, channels, workers);
  const SinglePairs<float> floats(model, channels, workers);
  const Extended turn(material.rotation_deg);

  Comparison formula("double", kDoubleRange);
  Comparison vectors("double, vectors", kDoubleRange);
  Comparison double_batches("double batches", kDoubleRange);
  Comparison float_batches("float batches", kFloatRange);
  const auto check = [&](const DirectionPair& pair) {
    workers.check();
    const PairGeometry<double> g = pair_geometry<double>(pair, material.rotation_deg);
    const Components from_angles = model.evaluate(g);
    const BasicComponents<Extended> exact =
        exact_model.evaluate(pair_geometry<Extended>({Extended(pair.theta_i), Extended(pair.phi_i),
                                                      Extended(pair.theta_o), Extended(pair.phi_o)},
                                                     turn));
    const auto exact_at = [&](const Directions& d) {
      return exact_model.evaluate(pair_geometry(extended(d.wi), extended(d.wo), turn));
    };
    const Directions wide = {direction(pair.theta_i, pair.phi_i),
                             direction(pair.theta_o, pair.phi_o)};
    const Directions narrow = {rounded_to_float(wide.wi), rounded_to_float(wide.wo)};
    const Components from_vectors =
        model.evaluate(pair_geometry(wide.wi, wide.wo, material.rotation_deg));
    const BasicComponents<Extended> exact_wide = exact_at(wide);
    const BasicComponents<Extended> exact_narrow = exact_at(narrow);
    const std::vector<double> wide_values = doubles(wide);
    const std::vector<float> narrow_values = floats(narrow);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const Channel& channel = channels[c];
      const double promise = promise_of_formula(material, channel, g);
      const double magnified = condition(material, g.cos_theta_d);
      formula.add(pair, channel, channel_value(from_angles, channel), channel_value(exact, channel),
                  promise);
      vectors.add(pair, channel, channel_value(from_vectors, channel),
                  channel_value(exact_wide, channel), promise + 0x1p-51 * magnified);
      double_batches.add(pair, channel, wide_values[c], channel_value(exact_wide, channel),
                         kBatchTolerance<double> * std::max(1.0, magnified));
      float_batches.add(pair, channel, double{narrow_values[c]},
                        channel_value(exact_narrow, channel),
                        kBatchTolerance<float> * std::max(1.0, magnified));
    }
    workers.advance(1);
  };
  with_threads(workers.threads, [&] {
    run_parallel(pairs.size(), workers, [&](std::size_t k) { check(pairs[k]); });
  });
  return {formula.figure(), vectors.figure(), double_batches.figure(), float_batches.figure()};
}

}  // namespace clothbrdf
