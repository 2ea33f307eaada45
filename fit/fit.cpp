#include "fit/fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "fit/equivalents.h"
#include "fit/misfit.h"
#include "fit/parallel.h"
#include "fit/remedies.h"
#include "fit/residual_regions.h"
#include "fit/search.h"
#include "fit/settle.h"
#include "fit/solve.h"
#include "fit/table_values.h"
#include "fit/uncertainty.h"
#include "support/errors.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  Reflectance reflectance;
  Paths paths;
  Search search;
  SettledFit fit;
};

std::string short_text(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return {text.data(), end.ptr};
}

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
      if (results_.empty()) {
        report_.failure = "averaged cells can be fitted with the microfacet convention only";
      } else {
        choose();
      }
    }
    report_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(report_);
  }

 private:
  void describe_table() {
    const TableSpec& spec = table_.spec();
    report_.grid = spec.has_grid() ? spec.grid().description()
                                   : std::to_string(spec.pairs().size()) + " pairs";
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
    return {observations, source, set_, options_.weighting, options_.loss, options_.noise};
  }

  void fit_conventions(Reflectance reflectance) {
    const TableSpec& spec = table_.spec();
    if (spec.cells.average && reflectance == Reflectance::kPaper) return;
    const Observations observations = observe(spec, reflectance, workers_);
    const ValueSource source = table_values(table_, observations);
    // Robust losses begin once there is a fit to be robust about.
    const RowWeights first = {options_.weighting, Loss::kSquared, 0};
    const Rows rows = make_rows(observations, source, first, nullptr, true, workers_);
    report_.below_horizon = observations.below_horizon;
    report_.masked = rows.masked;
    report_.values = rows.values;
    if (rows.values <= set_.free().size()) {
      report_.failure = std::to_string(rows.values) + " values cannot settle " +
                        std::to_string(set_.free().size()) + " free parameters";
    }
    const Observations few = thinned(observations, kSearchedX, kSearchedGroups);
    const ValueSource few_source = table_values(table_, few);
    const Rows few_rows = make_rows(few, few_source, first, nullptr, true, Workers(1));
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
          reflectance, paths, search(searched, set_, options_, reflectance, paths, workers_), {}};
      const auto [warp, weft] = result.search.layers.best();
      result.fit.solution = result.search.layers.at(warp, weft);
      result.fit.rows = rows;
      settle(problem(observations, source), result.fit, workers_);
      if (result.fit.chi2 < chosen_chi2()) {
        if (!observations_ || observations_reflectance_ != reflectance) {
          observations_ = observations;
          observations_reflectance_ = reflectance;
        }
        chosen_ = results_.size();
      }
      results_.push_back(std::move(result));
    }
  }

  double chosen_chi2() const { return results_.empty() ? kInfinity : results_[chosen_].fit.chi2; }

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

  // The weft tied to the warp, where both are free; without phi_h the share then has no effect.
  std::optional<ParameterSet> one_yarn_set() const {
    FitOptions options = options_;
    options.wishes.push_back({ParameterWish::Kind::kTie, "weft", {}, {}, {}});
    for (std::size_t i = 0; i < set_.parameters().size(); ++i) {
      const FitParameter& p = set_.parameters()[i];
      const bool free = set_.state(i) == ParameterSet::State::kFree;
      if (p.of_yarn && !free) return std::nullopt;
      if (p.column == kFraction && free && !with_phi_h_) {
        options.wishes.push_back({ParameterWish::Kind::kFix, p.name, 0.5, {}, {}});
      }
    }
    if (set_.layers_fixed(0) || set_.layers_fixed(1) || set_.layers_tied()) return std::nullopt;
    return ParameterSet(options, set_.channels(), with_phi_h_);
  }

  // A cloth of one yarn, where that fits as well: the simpler one is reported, and what sets the
  // yarns apart shows as what cannot be told.
  void try_one_yarn(const FitProblem& problem, ConventionResult& chosen) {
    const std::optional<ParameterSet> tied = one_yarn_set();
    if (!tied) return;
    Material start = chosen.fit.solution.material;
    (start.warp_fraction >= 0.5 ? start.weft : start.warp) =
        start.warp_fraction >= 0.5 ? start.warp : start.weft;
    if (!with_phi_h_) start.warp_fraction = tied->defaults().warp_fraction;
    const Misfit misfit(*observations_, chosen.fit.rows, kExact, workers_);
    const double noise = problem.noise_of(chosen.fit);
    const Solution one = solve(misfit, *tied, start, to_the_end(chosen.fit.rows, noise), workers_);
    if ((one.cost - chosen.fit.solution.cost) / (noise * noise) > kToldApart) return;
    const Material first = chosen.fit.solution.start;
    chosen.fit.solution = one;
    chosen.fit.solution.start = first;
    chosen.fit.solution.at_bound.clear();
    chosen.fit.chi2 = chosen.fit.rows.constant + one.cost;
    chosen.search.layers.at(one.material.warp.layers, one.material.weft.layers) =
        chosen.fit.solution;
    report_.one_yarn = true;
  }

  void choose() {
    ConventionResult& chosen = results_[chosen_];
    const ValueSource source = table_values(table_, *observations_);
    const FitProblem problem = this->problem(*observations_, source);
    profile_layers(problem, chosen);
    try_one_yarn(problem, chosen);
    const double estimated =
        std::sqrt(chosen.fit.chi2 / problem.degrees_of_freedom(chosen.fit.rows));
    const double stored = table_.precision().relative / std::sqrt(3.0);
    report_.noise_estimated = !options_.noise;
    report_.noise = std::max(options_.noise.value_or(estimated), std::max(kLeastNoise, stored));
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
    for (const ConventionResult& r : results_) {
      const bool is_chosen = &r == &chosen;
      report_.conventions.push_back({r.reflectance, r.paths, r.fit.chi2 / unit, is_chosen,
                                     (r.fit.chi2 - chosen.fit.chi2) / unit > kToldApart});
    }
    relabel(chosen);
    report_layers(chosen, unit);
    estimate(chosen);
    report_.residuals = residual_regions(*observations_, source, report_.material, workers_);
  }

  void relabel(const ConventionResult& chosen) {
    constexpr std::size_t kPlacesX = 6;
    constexpr std::size_t kPlaces = 40;
    const Observations places = thinned(*observations_, kPlacesX, kPlaces);
    const Material& found = chosen.fit.solution.material;
    const std::vector<Relabelling> equivalents = find_equivalents(places, found, set_);
    relabelling_ = canonical(equivalents, found, with_phi_h_);
    report_.material = relabelling_.apply(found);
    for (const auto& [warp, weft] : chosen.search.layers.pairs()) {
      const Solution& fit = chosen.search.layers.at(warp, weft);
      const double above = (fit.cost - chosen.fit.solution.cost) / (report_.noise * report_.noise);
      if (above > kToldApart) continue;
      alternatives_.push_back(
          canonical(equivalents, fit.material, with_phi_h_).apply(fit.material));
    }
    for (const Relabelling& other : find_equivalents(places, report_.material, set_)) {
      if (other.exchanges == 0 && other.turn_deg == 0) continue;
      report_.equivalents.push_back({other.words, other.apply(report_.material)});
    }
  }

  void report_layers(const ConventionResult& chosen, double unit) {
    const Material& m = report_.material;
    // Relabelled as the material is: are its layers exchanged?
    Material marked = chosen.fit.solution.material;
    marked.warp.layers = 0;
    marked.weft.layers = 1;
    const bool exchanged = relabelling_.apply(marked).warp.layers == 1;
    LayerProfile& profile = report_.layers;
    profile.fewest = options_.fewest_layers;
    profile.most = options_.most_layers;
    profile.warp = m.warp.layers;
    profile.weft = m.weft.layers;
    for (const auto& [warp, weft] : chosen.search.layers.pairs()) {
      const Solution& fit = chosen.search.layers.at(warp, weft);
      const double chi2 = (chosen.fit.rows.constant + fit.cost) / unit;
      profile.fits.push_back({exchanged ? weft : warp, exchanged ? warp : weft, chi2,
                              chi2 - report_.chi2 > kToldApart});
    }
    std::sort(profile.fits.begin(), profile.fits.end(), [](const LayerFit& a, const LayerFit& b) {
      return std::pair(a.warp, a.weft) < std::pair(b.warp, b.weft);
    });
  }

  void estimate(const ConventionResult& chosen) {
    // The bounds hold the parameters of the solution as it was found; find them again.
    const Misfit misfit(*observations_, chosen.fit.rows, kExact, workers_);
    ParameterSet inner = set_;
    std::vector<bool> at_bound(set_.parameters().size(), false);
    for (const std::size_t i : chosen.fit.solution.at_bound) {
      const std::size_t there = relabelled(i, chosen.fit.solution.material);
      at_bound[there] = true;
      inner = inner.with_fixed(there);
    }
    const Uncertainty found = uncertainty(misfit.triangle(report_.material, inner), inner,
                                          report_.material, report_.noise);
    report_.blind = found.blind;
    report_.condition = found.condition;
    const std::optional<ParameterSet> tied = report_.one_yarn ? one_yarn_set() : std::nullopt;
    Uncertainty shared;
    if (tied) {
      shared = uncertainty(misfit.triangle(report_.material, *tied), *tied, report_.material,
                           report_.noise);
    }
    const Material start = relabelling_.apply(chosen.fit.solution.start);
    for (std::size_t i = 0; i < set_.parameters().size(); ++i) {
      const FitParameter& p = set_.parameters()[i];
      ParameterEstimate estimate;
      estimate.name = p.name;
      estimate.unit = p.unit;
      estimate.value = parameter_value(report_.material, p);
      estimate.start = parameter_value(start, p);
      estimate.lowest = p.lowest;
      estimate.highest = p.highest;
      const auto free = std::find(inner.free().begin(), inner.free().end(), i);
      if (free != inner.free().end()) {
        estimate.standard_error =
            found.standard_errors[static_cast<std::size_t>(free - inner.free().begin())];
        estimate.verdict = verdict_of(p, estimate.value, estimate.standard_error);
        if (estimate.verdict != Verdict::kIdentifiable) {
          estimate.reason = reason_of(p, report_.blind);
        }
        look_at_alternatives(p, estimate);
        if (tied && p.of_yarn && estimate.verdict != Verdict::kIdentifiable) {
          say_shared(p, *tied, shared, estimate);
        }
      } else if (at_bound[i]) {
        estimate.verdict = Verdict::kAtBound;
        estimate.reason = "the best value lies at or beyond its bound";
      } else {
        estimate.verdict =
            set_.state(i) == ParameterSet::State::kTied ? Verdict::kTied : Verdict::kFixed;
      }
      report_.parameters.push_back(estimate);
    }
  }

  // Of a yarn that stands for both.
  static void say_shared(const FitParameter& p, const ParameterSet& tied, const Uncertainty& shared,
                         ParameterEstimate& estimate) {
    for (std::size_t k = 0; k < tied.free().size(); ++k) {
      const FitParameter& both = tied.parameters()[tied.free()[k]];
      if (both.of_yarn && both.column == p.column && both.channel == p.channel &&
          shared.standard_errors[k]) {
        estimate.reason += "; if the yarns are equal, its standard error is " +
                           short_text(*shared.standard_errors[k]);
      }
    }
  }

  // What layer counts that the table cannot tell apart have to say: standard errors know only the
  // neighbourhood of one of them.
  void look_at_alternatives(const FitParameter& p, ParameterEstimate& estimate) const {
    double low = estimate.value;
    double high = estimate.value;
    for (const Material& other : alternatives_) {
      const double value = parameter_value(other, p);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    const double spread = std::max(high - estimate.value, estimate.value - low);
    const Verdict verdict = verdict_of(p, estimate.value, spread);
    if (verdict <= estimate.verdict) return;
    estimate.verdict = verdict;
    estimate.reason = "layer counts that fit as well have values from " + short_text(low) + " to " +
                      short_text(high);
  }

  // Where the relabelling takes a parameter.
  std::size_t relabelled(std::size_t parameter, const Material& found) const {
    constexpr double kMark = 0.123456789;
    Material marked = found;
    for (const FitParameter& p : set_.parameters()) set_parameter(marked, p, 0.5);
    const FitParameter& from = set_.parameters()[parameter];
    set_parameter(marked, from, kMark);
    const Material moved = relabelling_.apply(marked);
    for (std::size_t i = 0; i < set_.parameters().size(); ++i) {
      const FitParameter& p = set_.parameters()[i];
      if (p.column != from.column && (p.column > kAcross || from.column > kAcross)) continue;
      const double value = parameter_value(moved, p);
      if (value == kMark || (p.column == kFraction && std::abs(value - (1 - kMark)) < 1e-12) ||
          p.column == kRotation) {
        return i;
      }
    }
    return parameter;
  }

  const Table& table_;
  const FitOptions& options_;
  Workers workers_;
  bool with_phi_h_;
  ParameterSet set_;
  FitReport report_;
  std::vector<ConventionResult> results_;
  std::size_t chosen_ = 0;
  std::optional<Observations> observations_;  // of the chosen convention
  Reflectance observations_reflectance_ = Reflectance::kMicrofacet;
  Relabelling relabelling_;
  std::vector<Material> alternatives_;  // of layer counts that are not told apart
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
  const Table totals = without_components(table);
  with_threads(workers.threads, [&] { report = TableFit(totals, options, workers).run(); });
  return report;
}

}  // namespace clothbrdf
