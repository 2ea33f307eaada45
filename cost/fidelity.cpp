#include "cost/fidelity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cost/evaluation.h"
#include "tabulate/kernel.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

constexpr std::array<double, 4> kFloatTolerances = {1e-1, 1e-2, 1e-3, 1e-4};
constexpr std::array<int, 5> kRotations = {2, 4, 8, 16, 32};
constexpr std::size_t kMostLayerSettings = 8;
constexpr std::size_t kModelPairs = 2000;

int most_layers(const Material& material) {
  return std::max(material.warp.layers, material.weft.layers);
}

/// Numbers of layers from 0 to one less than all, spread evenly.
std::vector<int> kept_layers(const Material& material) {
  const int most = most_layers(material);
  const int count = std::min(most, static_cast<int>(kMostLayerSettings));
  std::vector<int> kept;
  kept.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) kept.push_back(count == 1 ? 0 : k * (most - 1) / (count - 1));
  return kept;
}

Material with_layers(Material material, int layers) {
  for (Yarn* yarn : {&material.warp, &material.weft}) yarn->layers = std::min(layers, yarn->layers);
  return material;
}

Material with_paths(Material material, Paths paths) {
  material.paths = paths;
  return material;
}

CostSetting named(const char* dial, std::string name, double size = 0) {
  CostSetting setting;
  setting.dial = dial;
  setting.name = std::move(name);
  setting.front = "evaluation";
  setting.size = size;
  return setting;
}

class Fidelity {
 public:
  Fidelity(const Material& material, const SampledPairs& sampled, std::span<const double> exact,
           int repeats, const Workers& workers)
      : material_(material),
        sampled_(sampled),
        exact_(exact),
        repeats_(repeats),
        workers_(workers),
        channels_(material_channels(material, false)),
        doubles_(sampled.pairs, channels_.size()),
        floats_(sampled.pairs, channels_.size()) {}

  std::vector<CostSetting> measure() {
    paths();
    layers();
    path_sum();
    rotations();
    return std::move(settings_);
  }

 private:
  void add(CostSetting setting) {
    settings_.push_back(std::move(setting));
    workers_.advance(1);
  }

  /// Another material in place of the given one.
  void add_material(CostSetting setting, const Material& material,
                    std::span<const double> reference) {
    const ClothModel<double> model(material);
    const BatchEvaluator<double> evaluator(model, channels_, workers_);
    setting.error = table_error(sampled_, reference, doubles_.values(evaluator, workers_));
    setting.seconds = doubles_.time(evaluator, repeats_, workers_);
    add(std::move(setting));
  }

  void paths() {
    const Material all = with_paths(material_, Paths::kAll);
    std::vector<double> computed;
    std::span<const double> reference = exact_;
    if (material_.paths != Paths::kAll) {
      const ClothModel<double> model(all);
      computed = doubles_.values(BatchEvaluator<double>(model, channels_, workers_), workers_);
      reference = computed;
    }
    add_material(named("paths", kAllPaths), all, reference);
    add_material(named("paths", "single paths"), with_paths(material_, Paths::kSingle), reference);
  }

  void layers() {
    for (const int kept : kept_layers(material_)) {
      add_material(named("layers kept",
                         std::to_string(kept) + " of " + std::to_string(most_layers(material_)) +
                             " layers kept",
                         kept),
                   with_layers(material_, kept), exact_);
    }
  }

  void path_sum() {
    const ClothModel<double> model(material_);
    for (const double tolerance : kFloatTolerances) {
      const int digits = static_cast<int>(std::lround(-std::log10(tolerance)));
      add_float(model, "path sum in floats to 1e-" + std::to_string(digits), tolerance);
    }
    add_float(model, "path sum in floats to 5e-6", kBatchTolerance<float>);
    const BatchEvaluator<double> evaluator(model, channels_, workers_);
    CostSetting setting = named("path sum", "path sum in doubles to 1e-12");
    setting.error = error_against_model(model, evaluator);
    setting.seconds = doubles_.time(evaluator, repeats_, workers_);
    add(std::move(setting));
  }

  void add_float(const ClothModel<double>& model, std::string name, double tolerance) {
    const BatchEvaluator<float> evaluator(model, channels_, workers_, tolerance);
    CostSetting setting = named("path sum", std::move(name));
    setting.error = table_error(sampled_, exact_, floats_.values(evaluator, workers_));
    setting.seconds = floats_.time(evaluator, repeats_, workers_);
    add(std::move(setting));
  }

  TableError error_against_model(const ClothModel<double>& model,
                                 const BatchEvaluator<double>& evaluator) const {
    const std::size_t count = std::min(kModelPairs, sampled_.pairs.size());
    const auto pairs = std::span(sampled_.pairs).first(count);
    const auto shares = std::span(sampled_.shares).first(count);
    const SampledPairs some = {{pairs.begin(), pairs.end()}, {shares.begin(), shares.end()}};
    std::vector<double> from_model;
    for (const Directions& pair : some.pairs) {
      workers_.check();
      const Components f = model.evaluate(pair_geometry(pair.wi, pair.wo, material_.rotation_deg));
      for (const Channel& channel : channels_) from_model.push_back(channel_value(f, channel));
    }
    const Evaluation<double> evaluation(some.pairs, channels_.size());
    return table_error(some, from_model, evaluation.values(evaluator, workers_));
  }

  void rotations() {
    const ClothModel<double> model(material_);
    std::vector<double> reference(exact_.size());
    // In closed form.
    const auto mean_model = make_producer(material_spec(material_, {}, AnyPairs{true}), workers_);
    fill_all_pairs(*mean_model, workers_, sampled_.pairs, reference);
    const BatchEvaluator<double> evaluator(model, channels_, workers_);
    for (const int steps : kRotations) {
      std::vector<double> mean(exact_.size());
      for (int k = 0; k < steps; ++k) {
        const Evaluation<double> evaluation(turned_pairs(180.0 * k / steps), channels_.size());
        const std::vector<double> values = evaluation.values(evaluator, workers_);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += values[i] / steps;
      }
      CostSetting setting =
          named("rotations", "mean over " + std::to_string(steps) + " rotations", steps);
      setting.error = table_error(sampled_, reference, mean);
      // Every rotation takes the same time.
      setting.seconds = doubles_.time(evaluator, repeats_, workers_);
      for (double* seconds :
           {&setting.seconds.median, &setting.seconds.lowest, &setting.seconds.highest})
        *seconds *= steps;
      add(std::move(setting));
    }
  }

  /// As a cloth turned the other way sees them.
  std::vector<Directions> turned_pairs(double angle_deg) const {
    const SinCos<double> turn = sincosd(angle_deg);
    std::vector<Directions> pairs;
    pairs.reserve(sampled_.pairs.size());
    for (const Directions& pair : sampled_.pairs) {
      pairs.push_back({turned(pair.wi, turn), turned(pair.wo, turn)});
    }
    return pairs;
  }

  const Material& material_;
  const SampledPairs& sampled_;
  std::span<const double> exact_;
  int repeats_;
  const Workers& workers_;
  std::vector<Channel> channels_;
  Evaluation<double> doubles_;
  Evaluation<float> floats_;
  std::vector<CostSetting> settings_;
};

}  // namespace

std::vector<CostSetting> measure_fidelity(const Material& material, const SampledPairs& sampled,
                                          std::span<const double> exact, int repeats,
                                          const Workers& workers) {
  return Fidelity(material, sampled, exact, repeats, workers).measure();
}

std::size_t fidelity_settings(const Material& material) {
  constexpr std::size_t kPaths = 2;
  constexpr std::size_t kDefaults = 2;  // of floats, of doubles
  return kPaths + kept_layers(material).size() + kFloatTolerances.size() + kDefaults +
         kRotations.size();
}

}  // namespace clothbrdf
