#include "fit/identify.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "fit/doubts.h"
#include "fit/equivalents.h"
#include "fit/noisy_values.h"
#include "fit/profile.h"
#include "fit/remedies.h"
#include "fit/settle.h"
#include "fit/uncertainty.h"
#include "support/errors.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr double kDefaultNoise = 0.01;

// The sample standard deviation as it grows.
class Spread {
 public:
  void add(double value) {
    ++count_;
    const double change = value - mean_;
    mean_ += change / static_cast<double>(count_);
    square_ += change * (value - mean_);
  }
  double mean() const { return mean_; }
  double deviation() const { return std::sqrt(square_ / static_cast<double>(count_ - 1)); }

 private:
  std::size_t count_ = 0;
  double mean_ = 0;
  double square_ = 0;
};

void begin(Workers workers, const std::string& what, std::size_t count, const std::string& unit) {
  if (workers.progress != nullptr) workers.progress->begin(what, count, unit);
}

class Identifier {
 public:
  Identifier(const TableSpec& spec, const Material& material,
             const std::vector<unsigned char>& valid, const IdentifyOptions& options,
             Workers workers)
      : spec_(spec),
        material_(material),
        valid_(valid),
        original_(options.fit),
        options_(options),
        truth_(without_effects(spec, material, options_.fit)),
        workers_(workers),
        noise_(options.fit.noise.value_or(kDefaultNoise)),
        asked_(asked_set(spec, truth_, options_.fit)),
        set_(identified_set(spec, truth_, options_.fit)),
        observations_(observe(spec, material.reflectance, workers)),
        model_(model_values(observations_, truth_, kExact, workers)) {}

  IdentifyReport run() {
    const auto started = std::chrono::steady_clock::now();
    report_.material = material_;
    report_.grid = spec_.description();
    report_.cell_averages = spec_.cells.average;
    report_.noise = noise_;
    rows_ = make_rows(observations_, values(0, 0), row_weights(), &model_, true, workers_);
    report_.values = rows_.values;
    predict();
    expect_layers();
    find_others();
    verify();
    profile();
    find_remedies();
    report_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(report_);
  }

 private:
  RowWeights row_weights() const { return {options_.fit.weighting, options_.fit.loss, noise_}; }

  ValueSource values(double noise, std::uint64_t seed) const {
    return measured_values(observations_, spec_, valid_, model_, options_.fit.weighting, noise,
                           seed);
  }

  void predict() {
    const Misfit misfit(observations_, rows_, kExact, workers_);
    const Uncertainty found = uncertainty(misfit.triangle(truth_, set_), set_, truth_, noise_);
    report_.singular_values = found.singular_values;
    report_.condition = found.condition;
    report_.blind = found.blind;
    for (std::size_t i = 0; i < set_.parameters().size(); ++i) {
      const FitParameter& p = set_.parameters()[i];
      VerifiedParameter parameter;
      parameter.name = p.name;
      parameter.unit = p.unit;
      parameter.value = parameter_value(truth_, p);
      const auto free = std::find(set_.free().begin(), set_.free().end(), i);
      if (free != set_.free().end()) {
        parameter.predicted =
            found.standard_errors[static_cast<std::size_t>(free - set_.free().begin())];
        parameter.verdict = verdict_of(p, parameter.value, parameter.predicted);
        if (parameter.verdict != Verdict::kIdentifiable) {
          parameter.reason = reason_of(p, report_.blind);
        }
      } else if (asked_.state(i) == ParameterSet::State::kTied) {
        parameter.verdict = Verdict::kTied;
      } else if (asked_.state(i) == ParameterSet::State::kFree) {
        parameter.verdict = Verdict::kAtBound;
        parameter.reason = "its value lies on the bound of what is fitted";
      }
      report_.parameters.push_back(parameter);
    }
  }

  // What chi2 another count of layers would cost, on a table without noise.
  void expect_layers() {
    const LayerRange warp = layer_range(set_, options_.fit, 0);
    const LayerRange weft = layer_range(set_, options_.fit, 1);
    const auto widened = [](LayerRange range, int layers) {
      return LayerRange{std::min(range.fewest, layers), std::max(range.most, layers)};
    };
    LayerTable table(widened(warp, truth_.warp.layers), widened(weft, truth_.weft.layers),
                     set_.layers_tied());
    report_.layers.fewest = options_.fit.fewest_layers;
    report_.layers.most = options_.fit.most_layers;
    report_.layers.warp = truth_.warp.layers;
    report_.layers.weft = truth_.weft.layers;
    const ValueSource source = values(0, 0);
    const FitProblem problem{observations_,     source, set_, options_.fit.weighting,
                             options_.fit.loss, noise_};
    SettledFit truth;
    truth.rows = rows_;
    truth.solution.material = truth_;
    truth.solution.start = truth_;
    truth.solution.cost = Misfit(observations_, rows_, kExact, workers_).cost(truth_);
    truth.chi2 = rows_.constant + truth.solution.cost;
    if (!table.holds(truth_.warp.layers, truth_.weft.layers)) return;  // tied, and yet not equal
    begin(workers_, "comparing layer counts", 2 * table.pairs().size(), "fits");
    table.at(truth_.warp.layers, truth_.weft.layers) = truth.solution;
    const Observations few = thinned(observations_, kSearchedX, kSearchedGroups);
    const ModelValues few_model = model_values(few, truth_, kExact, workers_);
    const Rows few_rows =
        make_rows(few, measured_values(few, spec_, valid_, few_model, options_.fit.weighting, 0, 0),
                  row_weights(), &few_model, true, Workers(1));
    fill_layers(Misfit(few, few_rows, kSearching, Workers(1)), set_, table, workers_);
    compare_layers(problem, truth, table, workers_);
    std::vector<Material> others;
    for (const auto& [a, b] : table.pairs()) {
      const double chi2 =
          std::max(0.0, table.at(a, b).cost - truth.solution.cost) / (noise_ * noise_);
      report_.layers.fits.push_back({a, b, chi2, chi2 > kToldApart, false});
      const bool own = a == truth_.warp.layers && b == truth_.weft.layers;
      if (chi2 <= kToldApart && !own) others.push_back(table.at(a, b).material);
    }
    const Misfit misfit(observations_, rows_, kExact, workers_);
    const std::vector<Doubt> doubt = doubts(misfit, set_, truth_, others, noise_);
    for (const std::size_t i : set_.free()) {
      VerifiedParameter& parameter = report_.parameters[i];
      if (doubt[i].verdict <= parameter.verdict) continue;
      parameter.verdict = doubt[i].verdict;
      parameter.reason = doubt[i].reason;
    }
  }

  void find_others() {
    constexpr std::size_t kPlacesX = 6;
    constexpr std::size_t kPlaces = 40;
    const Observations places = thinned(observations_, kPlacesX, kPlaces);
    for (const Relabelling& other : find_equivalents(places, truth_, set_)) {
      if (other.exchanges == 0 && other.turn_deg == 0) continue;
      report_.equivalents.push_back({other.words, other.apply(truth_)});
    }
  }

  // Refits of noisy tables, from the truth.
  void verify() {
    const auto count = static_cast<std::size_t>(std::max(options_.refits, 0));
    report_.refits = static_cast<int>(count);
    if (count < 2 || set_.free().empty()) return;
    begin(workers_, "refitting noisy tables", count, "tables");
    std::vector<Solution> fits(count);
    const Workers single(1, workers_.progress);
    run_parallel(count, workers_, [&](std::size_t k) {
      const ValueSource noisy = values(noise_, options_.fit.seed + (k + 1) * 0x9e3779b97f4a7c15ULL);
      const FitProblem problem{observations_,     noisy, set_, options_.fit.weighting,
                               options_.fit.loss, noise_};
      SettledFit fit;
      fit.rows = make_rows(observations_, noisy, row_weights(), &model_, true, single);
      fit.solution.material = truth_;
      fit.solution.start = truth_;
      settle(problem, fit, single);
      fits[k] = fit.solution;
      workers_.advance(1);
    });
    std::vector<Spread> spreads(set_.parameters().size());
    for (const Solution& fit : fits) {
      if (!fit.converged) continue;
      ++report_.refits_converged;
      for (const std::size_t i : set_.free()) {
        spreads[i].add(parameter_value(fit.material, set_.parameters()[i]));
      }
    }
    if (report_.refits_converged < 2) return;
    for (const std::size_t i : set_.free()) {
      VerifiedParameter& parameter = report_.parameters[i];
      if (!parameter.predicted) continue;
      parameter.observed = spreads[i].deviation();
      parameter.bias = spreads[i].mean() - parameter.value;
    }
  }

  void profile() {
    std::vector<std::size_t> flagged;
    for (const std::size_t i : set_.free()) {
      const Verdict verdict = report_.parameters[i].verdict;
      if (verdict == Verdict::kWeak || verdict == Verdict::kNotIdentifiable) flagged.push_back(i);
    }
    if (options_.profile_points < 1) return;
    begin(workers_, "profiling", flagged.size(), "parameters");
    report_.profiles.resize(flagged.size());
    const Misfit misfit(observations_, rows_, kExact, Workers(1, workers_.progress));
    run_parallel(flagged.size(), workers_, [&](std::size_t k) {
      report_.profiles[k] =
          profile_likelihood(misfit, set_, flagged[k], truth_, noise_, options_.profile_points,
                             Workers(1, workers_.progress));
      workers_.advance(1);
    });
  }

  void find_remedies() {
    bool needed = false;
    for (const VerifiedParameter& p : report_.parameters) {
      needed = needed || p.verdict == Verdict::kWeak || p.verdict == Verdict::kNotIdentifiable;
    }
    if (!needed) return;
    const std::vector<Remedy> remedies =
        try_remedies(spec_, material_, original_, noise_, workers_);
    for (const Remedy& remedy : remedies) report_.tried.push_back(remedy.words);
    for (std::size_t i = 0; i < report_.parameters.size(); ++i) {
      VerifiedParameter& p = report_.parameters[i];
      if (p.verdict != Verdict::kWeak && p.verdict != Verdict::kNotIdentifiable) continue;
      const auto settles = std::find_if(remedies.begin(), remedies.end(),
                                        [&](const Remedy& remedy) { return remedy.settles[i]; });
      p.remedy = settles != remedies.end() ? settles->words : "nothing that was tried";
    }
  }

  const TableSpec& spec_;
  const Material& material_;
  const std::vector<unsigned char>& valid_;
  const FitOptions& original_;
  IdentifyOptions options_;  // and what is known of a table without some effects
  Material truth_;           // what the table shows of the material
  Workers workers_;
  double noise_;
  ParameterSet asked_;
  ParameterSet set_;  // less what lies on its bound
  Observations observations_;
  ModelValues model_;
  Rows rows_;
  IdentifyReport report_;
};

// Values come from the material that is looked at.
void check_known(const TableSpec& spec, const Material& material, const ParameterWish& wish) {
  FitOptions alone;
  alone.start = material;
  alone.wishes = {wish};
  const ParameterSet set(alone, material.channel_count(), has_phi_h(spec));
  for (const FitParameter& p : set.parameters()) {
    if (parameter_value(set.defaults(), p) != parameter_value(material, p) &&
        p.column != kRotation) {
      throw InputError(p.name + ": the material has another value than the one to fix it at");
    }
  }
}

void check_ties(const ParameterSet& set, const Material& material) {
  for (std::size_t i = 0; i < set.parameters().size(); ++i) {
    const FitParameter& p = set.parameters()[i];
    FitParameter warp = p;
    warp.yarn = 0;
    if (set.state(i) == ParameterSet::State::kTied &&
        parameter_value(material, warp) != parameter_value(material, p)) {
      throw InputError(p.name + ": tied, and yet the material's yarns differ in it");
    }
  }
  if (set.layers_tied() && material.warp.layers != material.weft.layers) {
    throw InputError("layers: tied, and yet the material's yarns differ in them");
  }
}

void check(const TableSpec& spec, const Material& material, const IdentifyOptions& options) {
  if (spec.channels.size() != material.channel_count()) {
    throw InputError("identify: a table of the channels' totals is needed, without components");
  }
  if (options.refits == 1) {
    throw InputError("refits: 1 has no spread; 0, or 2 and more");
  }
  for (const ParameterWish& wish : options.fit.wishes) {
    if (wish.kind == ParameterWish::Kind::kFix && wish.value) check_known(spec, material, wish);
  }
  check_ties(asked_set(spec, material, options.fit), material);
  if (options.fit.noise && !(*options.fit.noise > 0 && std::isfinite(*options.fit.noise))) {
    throw InputError("noise: a number above 0 is needed");
  }
}

}  // namespace

IdentifyReport identify(const TableSpec& spec, const Material& material,
                        const std::vector<unsigned char>& valid, const IdentifyOptions& options,
                        Workers workers) {
  check(spec, material, options);
  IdentifyReport report;
  with_threads(workers.threads,
               [&] { report = Identifier(spec, material, valid, options, workers).run(); });
  return report;
}

std::vector<SweepCell> sweep_layers(const TableSpec& spec, const Material& material,
                                    const std::vector<double>& absorptions,
                                    const std::vector<double>& noises,
                                    const IdentifyOptions& options, Workers workers) {
  check(spec, material, options);
  // Without noise the cost of a wrong count is known; over the noise it is what chi2 expects.
  const int most = options.fit.most_layers;
  const auto counts = static_cast<std::size_t>(std::max(most, 0));
  std::vector<double> cost(absorptions.size() * counts);
  with_threads(workers.threads, [&] {
    begin(workers, "sweeping", cost.size(), "fits");
    const Observations observations = observe(spec, material.reflectance, workers);
    run_parallel(cost.size(), workers, [&](std::size_t k) {
      Material truth = material;
      const int layers = static_cast<int>(k % counts) + 1;
      for (Yarn* yarn : {&truth.warp, &truth.weft}) {
        yarn->layers = layers;
        std::fill(yarn->absorption.begin(), yarn->absorption.end(), absorptions[k / counts]);
      }
      const ParameterSet set = identified_set(spec, truth, options.fit);
      const Workers single(1, workers.progress);
      const ModelValues model = model_values(observations, truth, kExact, single);
      const std::vector<unsigned char> all;
      const ValueSource source =
          measured_values(observations, spec, all, model, options.fit.weighting, 0, 0);
      const Rows rows = make_rows(observations, source, {options.fit.weighting, Loss::kSquared, 0},
                                  &model, true, single);
      const Misfit misfit(observations, rows, kExact, single);
      Material fewer = truth;
      fewer.warp.layers = fewer.weft.layers = layers - 1;
      constexpr SolveLimits kLimits{
          .iterations = 60, .function_tolerance = 1e-4, .parameter_tolerance = 1e-8, .rounds = 1};
      cost[k] = std::max(0.0, solve(misfit, set, fewer, kLimits, single).cost - misfit.cost(truth));
      workers.advance(1);
    });
  });
  std::vector<SweepCell> cells;
  for (std::size_t a = 0; a < absorptions.size(); ++a) {
    for (const double noise : noises) {
      int told = 0;
      while (told < most &&
             cost[a * counts + static_cast<std::size_t>(told)] / (noise * noise) > kToldApart) {
        ++told;
      }
      cells.push_back({absorptions[a], noise, told});
    }
  }
  return cells;
}

}  // namespace clothbrdf
