#include "tabulate/batch.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "formats/material_json.h"
#include "tabulate/batch_kernel.h"
#include "tests/catch.h"
#include "tests/support/lobe_condition.h"
#include "tests/support/part_of.h"
#include "tests/support/random_inputs.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

// What batch.h promises.
template <class T>
constexpr double kPromise = sizeof(T) == sizeof(float) ? 5e-6 : 1e-12;

/// Pairs of directions as a batch, and what it gives.
template <class T>
struct Batch {
  explicit Batch(const std::vector<DirectionPair>& pairs) {
    for (const DirectionPair& p : pairs) {
      const Vector3<double> wi = direction(p.theta_i, p.phi_i);
      const Vector3<double> wo = direction(p.theta_o, p.phi_o);
      for (std::size_t k = 0; k < 3; ++k) {
        in[k].push_back(static_cast<T>(wi[k]));
        in[3 + k].push_back(static_cast<T>(wo[k]));
      }
    }
  }

  std::size_t size() const { return in[0].size(); }
  Vector3<double> vector(std::size_t first, std::size_t p) const {
    return {double{in[first][p]}, double{in[first + 1][p]}, double{in[first + 2][p]}};
  }
  DirectionArrays<T> arrays(std::size_t first, std::size_t count) const {
    return {{in[0].data() + first, in[1].data() + first, in[2].data() + first},
            {in[3].data() + first, in[4].data() + first, in[5].data() + first},
            count};
  }
  /// [channel][pair]
  std::vector<std::vector<T>> evaluate(const BatchEvaluator<T>& evaluator, std::size_t channels,
                                       std::size_t first = 0, std::size_t count = 1U << 30U) const {
    count = std::min(count, size() - first);
    std::vector<std::vector<T>> values(channels, std::vector<T>(count, T(-1)));
    std::vector<T*> to;
    for (std::vector<T>& channel : values) to.push_back(channel.data());
    evaluator.evaluate(arrays(first, count), to);
    return values;
  }

  std::array<std::vector<T>, 6> in;
};

struct Worst {
  double error = 0;  ///< over the promise, condition number included
  int compared = 0;
};

template <class T>
void compare(const Material& material, const Effects& effects, bool components,
             const std::vector<DirectionPair>& pairs, Worst& worst, std::size_t target = 0) {
  const ClothModel<double> model(material, effects);
  const std::vector<Channel> channels = material_channels(material, components);
  BatchEvaluator<T> evaluator(model, channels, 1);
  evaluator.choose_target(target);
  const Batch<T> batch(pairs);
  const auto values = batch.evaluate(evaluator, channels.size());
  for (std::size_t p = 0; p < batch.size(); ++p) {
    const PairGeometry<double> g =
        pair_geometry(batch.vector(0, p), batch.vector(3, p), material.rotation_deg);
    const Components f = model.evaluate(g);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double exact = part_of(f, channels[c]);
      const auto value = double{values[c][p]};
      if (exact == 0 || !(exact < 1e37)) continue;
      const double error =
          std::abs(value / exact - 1) / (kPromise<T> * lobe_condition(material, g.cos_theta_d));
      if (!(error <= 1)) {
        INFO("channel " << full_name(channels[c]) << ": " << value << " for " << exact);
        print(std::cout, material, pairs[p]);
        CHECK(error <= 1);
      }
      worst.error = std::max(worst.error, error);
      ++worst.compared;
    }
  }
}

template <class T>
Worst worst_over_materials(RandomInputs& random, const MaterialRanges& ranges, int materials) {
  Worst worst;
  for (int n = 0; n < materials; ++n) {
    const Material material = random.material(ranges);
    std::vector<DirectionPair> pairs;
    for (int p = 0; p < 200; ++p) pairs.push_back(random.pair());
    const Effects components{n % 5 != 0, n % 7 != 0, n % 3 != 0};
    compare<T>(material, components, n % 4 == 0, pairs, worst);
    for (int k = 0; k < 2; ++k) {
      const auto target = static_cast<std::size_t>(n + k) % batch_targets().size();
      compare<T>(material, random.effects(), n % 4 == 0, pairs, worst, target);
    }
  }
  return worst;
}

template <class T>
void check_random(const char* name) {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  const Worst usual = worst_over_materials<T>(random, {}, 60);
  MaterialRanges hard;
  hard.lowest_axis = 1e-3;
  hard.highest_absorption = 40;
  hard.lowest_index = 1.01;
  hard.highest_index = 3;
  hard.highest_scatter = 1;
  hard.most_layers = 64;
  const Worst hardest = worst_over_materials<T>(random, hard, 60);
  std::cout << name << " batches against the model: worst share of what is promised " << usual.error
            << " of " << usual.compared << " values, hard materials " << hardest.error << " of "
            << hardest.compared << " (seed " << seed << ")\n";
  CHECK(usual.compared > 30000);
  CHECK(hardest.compared > 20000);
}

}  // namespace

TEST_CASE("batches of floats are within 5e-6 of the model, times the lobe's condition number") {
  check_random<float>("float");
}

TEST_CASE("batches of doubles are within 1e-12 of the model, times the lobe's condition number") {
  check_random<double>("double");
}

TEST_CASE("batches keep to looser tolerances, and use them") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
    double worst = 0;
    double largest = 0;
    std::size_t work = 0;
    std::size_t default_work = 0;
    for (int n = 0; n < 40; ++n) {
      const Material material = random.material({});
      const ClothModel<double> model(material);
      const std::vector<Channel> channels = material_channels(material, false);
      const BatchEvaluator<float> evaluator(model, channels, 1, tolerance);
      const BatchEvaluator<float> usual(model, channels, 1);
      if (usual.tabulated()) {
        work += evaluator.multiply_adds();
        default_work += usual.multiply_adds();
      }
      std::vector<DirectionPair> pairs;
      for (int p = 0; p < 200; ++p) pairs.push_back(random.pair());
      const Batch<float> batch(pairs);
      const auto values = batch.evaluate(evaluator, channels.size());
      for (std::size_t p = 0; p < batch.size(); ++p) {
        const PairGeometry<double> g =
            pair_geometry(batch.vector(0, p), batch.vector(3, p), material.rotation_deg);
        const Components f = model.evaluate(g);
        const double rounding = kPromise<float> * lobe_condition(material, g.cos_theta_d);
        for (std::size_t c = 0; c < channels.size(); ++c) {
          const double exact = part_of(f, channels[c]);
          if (exact == 0 || !(exact < 1e37)) continue;
          const double off = std::abs(double{values[c][p]} / exact - 1);
          worst = std::max(worst, off / (tolerance + rounding));
          largest = std::max(largest, off);
        }
      }
    }
    std::cout << "float batches of tolerance " << tolerance << ": largest error " << largest
              << ", worst share of what is promised " << worst << ", multiply-adds " << work
              << " in place of " << default_work << " (seed " << seed << ")\n";
    CHECK(worst <= 1);
    // Below that rounding hides what the tolerance changes.
    if (tolerance >= 1e-2) CHECK(largest > kPromise<float>);
    // Lanes are padded to full registers, so that few of them save little.
    CHECK(work <= default_work);
  }
}

TEST_CASE("every width of vector registers gives the model's values") {
  RandomInputs random(seed_from_environment());
  const Material material = read_material(preset("tamamushi"));
  std::vector<DirectionPair> pairs;
  for (int p = 0; p < 500; ++p) pairs.push_back(random.pair());
  const ClothModel<double> model(material);
  BatchEvaluator<float> evaluator(model, material_channels(material, false), 1);
  std::vector<std::vector<std::vector<float>>> seen;
  for (std::size_t target = 0; target < batch_targets().size(); ++target) {
    Worst worst;
    compare<float>(material, {}, true, pairs, worst, target);
    compare<double>(material, {}, true, pairs, worst, target);
    evaluator.choose_target(target);
    seen.push_back(Batch<float>(pairs).evaluate(evaluator, 3));
    std::cout << batch_targets()[target].name << ": worst share of what is promised " << worst.error
              << " of " << worst.compared << " values\n";
  }
  // The narrowest adds in another order: were it never chosen, all bits would be the same.
  CHECK((seen.size() == 1 || seen.front() != seen.back()));
}

TEST_CASE("a pair has the same bits in any batch") {
  RandomInputs random(seed_from_environment());
  const Material material = read_material(preset("silk"));
  const ClothModel<double> model(material);
  const std::vector<Channel> channels = material_channels(material, false);
  const BatchEvaluator<float> evaluator(model, channels, 1);
  std::vector<DirectionPair> pairs;
  for (int p = 0; p < 331; ++p) pairs.push_back(random.pair());
  const Batch<float> batch(pairs);
  const auto whole = batch.evaluate(evaluator, 3);
  for (const auto& [first, count] : {std::pair{0U, 1U}, {7U, 64U}, {100U, 65U}, {330U, 1U}}) {
    const auto some = batch.evaluate(evaluator, 3, first, count);
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(std::equal(some[c].begin(), some[c].end(), whole[c].begin() + first));
    }
  }
  CHECK(batch.evaluate(evaluator, 3, 331, 10)[0].empty());
}

TEST_CASE("a batch is 0 on and below the horizon") {
  const Material material = read_material(preset("silk"));
  const ClothModel<double> model(material);
  const BatchEvaluator<float> evaluator(model, material_channels(material, false), 1);
  const Batch<float> batch(std::vector<DirectionPair>{{90, 0, 30, 0},
                                                      {30, 0, 90, 0},
                                                      {120, 0, 30, 0},
                                                      {30, 0, 150, 180},
                                                      {180, 0, 0, 0},
                                                      {91, 3, 91, 4}});
  for (const std::vector<float>& channel : batch.evaluate(evaluator, 3)) {
    for (const float value : channel) CHECK(value == 0.0F);
  }
}

TEST_CASE("where weights jump at grazing incidence pairs are evaluated one by one, and right") {
  Material material = read_material(preset("silk"));
  material.warp.refractive_index = 1 + 1e-9;
  material.weft = material.warp;
  const ClothModel<double> model(material);
  CHECK_FALSE(BatchEvaluator<float>(model, material_channels(material, false), 1).tabulated());
  RandomInputs random(seed_from_environment());
  std::vector<DirectionPair> pairs;
  for (int p = 0; p < 100; ++p) pairs.push_back(random.pair());
  Worst worst;
  compare<float>(material, {}, false, pairs, worst);
  CHECK(worst.compared > 100);
}

}  // namespace clothbrdf::test
