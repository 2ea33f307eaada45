#include "fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "fit/estimate.h"
#include "fit/estimates.h"
#include "fit/misfit.h"
#include "fit/one_yarn.h"
#include "fit/remedies.h"
#include "fit/residual_regions.h"
#include "fit/search.h"
#include "fit/settle.h"
#include "fit/table_values.h"
#include "model/effects.h"
#include "support/errors.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

const char* weighting_text(Weighting weighting) {
  switch (weighting) {
    case Weighting::kRelative: return "relative";
    case Weighting::kAbsolute: return "absolute";
    case Weighting::kLogarithmic: return "logarithmic";
  }
  return "";
}

const char* loss_text(Loss loss) {
  switch (loss) {
    case Loss::kSquared: return "squared";
    case Loss::kHuber: return "huber";
    case Loss::kCauchy: return "cauchy";
  }
  return "";
}

// The fit of one convention to all rows.
struct ConventionResult {
  std::shared_ptr<const Observations> observations;
  Reflectance reflectance;
  Paths paths;
  Search search;
  SettledFit fit;
};

class TableFit {
 public:
  TableFit(const Table& table, const FitOptions& options, Workers workers)
      : table_(table),
        options_(options),
        workers_(workers),
        with_phi_h_(has_phi_h(table.spec())),
        set_(options, table.spec().channels.size(), with_phi_h_) {}

  FitReport run() {
    const auto started = std::chrono::steady_clock::now();
    describe_table();
    if (report_.failure.empty()) {
      for (const Reflectance reflectance : options_.reflectances) fit_conventions(reflectance);
      if (!results_.empty()) {
        choose();
      } else if (report_.failure.empty()) {
        report_.failure = overflows_
                              ? "no cloth comes near these values: squares of what is left overflow"
                              : "averaged cells can be fitted with the microfacet convention only";
      }
    }
    report_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(report_);
  }

 private:
  void describe_table() {
    const TableSpec& spec = table_.spec();
    report_.grid = spec.description();
    report_.cell_averages = spec.cells.average;
    report_.weighting = weighting_text(options_.weighting);
    report_.loss = loss_text(options_.loss);
    bool any = false;
    bool any_light = false;
    double largest = 0;
    for (const double value : table_.values()) {
      if (!std::isfinite(value) || value < 0) continue;
      any = true;
      any_light = any_light || value > 0;
      largest = std::max(largest, value);
    }
    constexpr double kBrightest = 1e100;
    if (!any) {
      report_.failure = "no cell holds a value: all are negative or not finite";
    } else if (!any_light) {
      report_.failure = "every value is 0: nothing can be told of a cloth that reflects nothing";
    } else if (largest > kBrightest) {
      report_.failure = "values up to " + std::to_string(std::log10(largest)) +
                        " decades above 1: no reflectance";
    }
  }

  FitProblem problem(const Observations& observations, const ValueSource& source) const {
    const bool relative = options_.weighting != Weighting::kAbsolute;
    const StoredPrecision stored = table_.precision();
    const double rounding = relative ? stored.relative / std::sqrt(3.0) : stored.step;
    return {observations,
            source,
            set_,
            options_.weighting,
            options_.loss,
            options_.noise,
            std::max(rounding, kLeastNoise)};
  }

  void fit_conventions(Reflectance reflectance) {
    const TableSpec& spec = table_.spec();
    if (spec.cells.average && reflectance == Reflectance::kPaper) return;
    const auto shared = std::make_shared<const Observations>(observe(spec, reflectance, workers_));
    const Observations& observations = *shared;
    const ValueSource source = table_values(table_, observations);
    // Robust losses begin once there is a fit to be robust about.
    const RowWeights first = {options_.weighting, Loss::kSquared, 0};
    const Rows rows = first_rows(observations, source, first, reflectance);
    report_.below_horizon = observations.below_horizon;
    report_.masked = rows.masked;
    report_.values = rows.values;
    if (rows.values <= set_.free().size()) {
      report_.failure = std::to_string(rows.values) + " values cannot settle " +
                        std::to_string(set_.free().size()) + " free parameters";
      return;
    }
    const Observations few = thinned(observations, kSearchedX, kSearchedGroups);
    const ValueSource few_source = table_values(table_, few);
    const Rows few_rows = make_rows(few, few_source, first, nullptr, true, Workers(1));
    const Material estimate = estimate_from_table(few, few_source, set_);
    for (const Paths paths : options_.paths) {
      if (workers_.progress != nullptr) {
        const auto pairs = LayerTable(layer_range(set_, options_, 0),
                                      layer_range(set_, options_, 1), set_.layers_tied())
                               .pairs()
                               .size();
        workers_.progress->begin(
            std::string("fitting ") +
                (reflectance == Reflectance::kMicrofacet ? "microfacet" : "paper") +
                (paths == Paths::kAll ? ", all paths" : ", single paths"),
            pairs - 1 + static_cast<std::size_t>(options_.start ? 1 : options_.starts), "fits");
      }
      const Misfit searched(few, few_rows, kSearching, Workers(1));
      ConventionResult result{
          shared,
          reflectance,
          paths,
          search(searched, set_, options_, estimate, reflectance, paths, workers_),
          {}};
      const auto [warp, weft] = result.search.layers.best();
      result.fit.solution = result.search.layers.at(warp, weft);
      result.fit.rows = rows;
      settle(problem(observations, source), result.fit, workers_);
      if (!std::isfinite(result.fit.chi2)) {
        overflows_ = true;
        continue;
      }
      if (result.fit.chi2 < chosen_chi2()) chosen_ = results_.size();
      results_.push_back(std::move(result));
    }
  }

  // Rows with weights from the start that was asked for, where that is near; else from smoothed
  // values.
  Rows first_rows(const Observations& observations, const ValueSource& source,
                  const RowWeights& weights, Reflectance reflectance) const {
    if (options_.start && weights.weighting == Weighting::kRelative) {
      Material start = set_.defaults();
      start.reflectance = reflectance;
      start.paths = options_.paths.front();
      const ModelValues values = model_values(observations, start, kExact, workers_);
      Rows rows = make_rows(observations, source, weights, &values, true, workers_);
      const double square =
          rows.constant + Misfit(observations, rows, kExact, workers_).cost(start);
      constexpr double kNear = 0.1;
      if (square <= kNear * kNear * static_cast<double>(rows.values)) return rows;
    }
    return make_rows(observations, source, weights, nullptr, true, workers_);
  }

  double chosen_chi2() const { return results_.empty() ? HUGE_VAL : results_[chosen_].fit.chi2; }

  // Every pair of layer counts on all rows; the chosen fit may change.
  void profile_layers(const FitProblem& problem, ConventionResult& chosen) {
    for (int round = 0; round < 3; ++round) {
      const auto& pairs = chosen.search.layers.pairs();
      if (workers_.progress != nullptr) {
        workers_.progress->begin("comparing layer counts", pairs.size(), "fits");
      }
      const double before = chosen.fit.solution.cost;
      compare_layers(problem, chosen.fit, chosen.search.layers, workers_);
      const auto [warp, weft] = chosen.search.layers.best();
      const Solution& lowest = chosen.search.layers.at(warp, weft);
      if (lowest.cost >= before) return;
      chosen.fit.solution = lowest;
      settle(problem, chosen.fit, workers_);
    }
  }

  void choose() {
    ConventionResult& chosen = results_[chosen_];
    const Observations& observations = *chosen.observations;
    const ValueSource source = table_values(table_, observations);
    const FitProblem problem = this->problem(observations, source);
    profile_layers(problem, chosen);
    report_.one_yarn =
        try_one_yarn(problem, options_, with_phi_h_, chosen.fit, chosen.search.layers, workers_);
    const double estimated =
        std::sqrt(chosen.fit.chi2 / problem.degrees_of_freedom(chosen.fit.rows));
    report_.noise_estimated = !options_.noise;
    report_.noise = problem.noise_of(chosen.fit);
    if (options_.noise && report_.noise > *options_.noise) {
      report_.notes.push_back(
          "the noise as given is less than the file's rounding, which is taken");
    }
    const double unit = report_.noise * report_.noise;
    report_.chi2 = chosen.fit.chi2 / unit;
    report_.residual_rms = estimated;
    report_.converged = chosen.fit.solution.converged;
    report_.termination = chosen.fit.solution.termination;
    report_.message = chosen.fit.solution.message;
    report_.iterations = chosen.fit.solution.iterations;
    report_.rows = chosen.fit.rows.row_count();
    report_.starts = chosen.search.starts;
    report_.starts_at_best = chosen.search.starts_at_best;
    report_.optima = chosen.search.optima;
    for (Optimum& optimum : report_.optima) optimum.chi2 /= unit;
    for (const ConventionResult& r : results_) {
      const bool is_chosen = &r == &chosen;
      report_.conventions.push_back({r.reflectance, r.paths, r.fit.chi2 / unit, is_chosen,
                                     (r.fit.chi2 - chosen.fit.chi2) / unit > kToldApart});
    }
    report_estimates({observations, chosen.fit, chosen.search.layers, set_, options_, with_phi_h_,
                      problem.misses_data(chosen.fit)},
                     workers_, report_);
    take_notes(problem, chosen);
    report_.residuals = residual_regions(observations, source, report_.material, workers_);
  }

  void take_notes(const FitProblem& problem, const ConventionResult& chosen) {
    if (problem.misses_data(chosen.fit)) {
      report_.notes.push_back(
          "the residual is more than the noise: the model does not describe all of this table, or "
          "its bounds or the range of layers leave the right cloth out, or (averages) cells are "
          "too "
          "coarse for it");
    }
    if (report_.starts > 1 && report_.starts_at_best == 1) {
      report_.notes.push_back(
          "one start alone reached the best optimum: with more starts there may be a better one");
    }
    if (report_.material.warp.scatter_limit || report_.material.weft.scatter_limit) {
      report_.notes.push_back("scatter_limit is not fitted: it is kept as the start has it");
    }
    if (!chosen.fit.settled) {
      report_.notes.push_back("the weights, which come from the fit, had not settled at the end");
    }
    std::string shortcuts;
    for (const std::string& word : shortcut_words(table_.spec().provenance.effects)) {
      shortcuts += (shortcuts.empty() ? "" : ", ") + word;
    }
    if (!shortcuts.empty()) {
      report_.notes.push_back("the table was made with " + shortcuts +
                              "; the fit has the effects that these leave out");
    }
    constexpr double kFar = 0.5;
    if (options_.weighting != Weighting::kAbsolute && report_.residual_rms > kFar) {
      report_.notes.push_back("the fit is far off: this is no table of a cloth, or not in 1/sr");
    }
  }

  const Table& table_;
  const FitOptions& options_;
  Workers workers_;
  bool with_phi_h_;
  ParameterSet set_;
  FitReport report_;
  std::vector<ConventionResult> results_;
  std::size_t chosen_ = 0;
  bool overflows_ = false;  // the misfit of some convention
};

}  // namespace

FitReport fit_table(const Table& table, const FitOptions& options, Workers workers) {
  if (options.fewest_layers < 0 || options.most_layers > 64 ||
      options.fewest_layers > options.most_layers) {
    throw InputError("layers: " + std::to_string(options.fewest_layers) + ":" +
                     std::to_string(options.most_layers) +
                     " is not allowed: LOW:HIGH within 0 to 64");
  }
  if (options.noise && !(*options.noise > 0 && std::isfinite(*options.noise))) {
    throw InputError("noise: a number above 0 is needed");
  }
  FitReport report;
  const std::vector<Channel>& channels = table.spec().channels;
  std::optional<Table> without;
  if (std::any_of(channels.begin(), channels.end(),
                  [](const Channel& c) { return c.part != Part::kTotal; })) {
    without.emplace(without_components(table));
  }
  const Table& totals = without ? *without : table;
  with_threads(workers.threads, [&] { report = TableFit(totals, options, workers).run(); });
  return report;
}

}  // namespace clothbrdf
