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
#include "fit/residual_regions.h"
#include "fit/search.h"
#include "fit/solve.h"
#include "fit/table_values.h"
#include "fit/uncertainty.h"
#include "support/errors.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

// Where a search looks: so many distinct cos_theta_d and groups of cells.
constexpr std::size_t kSearchedX = 16;
constexpr std::size_t kSearchedGroups = 400;

// Of the noise: no weights, no values and no sums are exact to more.
constexpr double kLeastNoise = 1e-13;

// Rounds of weights from the current fit.
constexpr int kMostRounds = 12;

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
  Solution solution;
  Rows rows;
  double chi2 = kInfinity;  // not yet over the noise
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
        with_phi_h_(!table.spec().has_grid() ||
                    table.spec().grid().kind != GridKind::kHalfDifference3d),
        set_(options, table.spec().channels.size(), with_phi_h_) {}

  FitReport run() {
    const auto started = std::chrono::steady_clock::now();
    describe_table();
    if (report_.failure.empty()) {
      for (const Reflectance reflectance : options_.reflectances) fit_conventions(reflectance);
      if (results_.empty()) {
        report_.failure = overflows_
                              ? "no cloth comes near these values: squares of what is left overflow"
                              : "averaged cells can be fitted with the microfacet convention only";
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

  RowWeights weights(double noise) const {
    return {options_.weighting, options_.loss, options_.noise.value_or(noise)};
  }

  void fit_conventions(Reflectance reflectance) {
    const TableSpec& spec = table_.spec();
    if (spec.cells.average && reflectance == Reflectance::kPaper) return;
    const Observations observations = observe(spec, reflectance, workers_);
    const ValueSource source = table_values(table_, observations);
    // Robust losses begin once there is a fit to be robust about.
    RowWeights first = weights(0);
    first.loss = Loss::kSquared;
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
      ConventionResult result{reflectance,
                              paths,
                              search(searched, set_, options_, reflectance, paths, workers_),
                              {},
                              {}};
      const auto [warp, weft] = result.search.layers.best();
      result.solution = result.search.layers.at(warp, weft);
      settle(observations, source, rows, result);
      if (!std::isfinite(result.chi2)) {
        overflows_ = true;
        continue;
      }
      if (result.chi2 < chosen_chi2()) {
        if (!observations_ || observations_reflectance_ != reflectance) {
          observations_ = observations;
          observations_reflectance_ = reflectance;
        }
        chosen_ = results_.size();
      }
      results_.push_back(std::move(result));
    }
  }

  double chosen_chi2() const { return results_.empty() ? kInfinity : results_[chosen_].chi2; }

  // Fits all rows, their weights from the fit, until both settle.
  void settle(const Observations& observations, const ValueSource& source, const Rows& first,
              ConventionResult& result) const {
    result.rows = first;
    double noise = 0;
    for (int round = 0; round < kMostRounds; ++round) {
      const Material before = result.solution.material;
      if (round > 0) {
        const ModelValues fit = model_values(observations, before, kExact, workers_);
        result.rows = make_rows(observations, source, weights(noise), &fit, true, workers_);
      }
      const Misfit misfit(observations, result.rows, kExact, workers_);
      const Material start = result.solution.start;
      const int iterations = result.solution.iterations;
      result.solution = solve(misfit, set_, before, to_the_end(result.rows, noise), workers_);
      result.solution.start = start;
      result.solution.iterations += round > 0 ? iterations : 0;
      result.chi2 = result.rows.constant + result.solution.cost;
      if (!std::isfinite(result.chi2)) return;
      noise = std::sqrt(result.chi2 / degrees_of_freedom(result.rows));
      if (round > 0 && moved(before, result.solution.material, misfit, noise) < kSettled) break;
    }
  }
  // Standard errors by which a further round may still move a parameter.
  static constexpr double kSettled = 1e-3;

  // Until a step changes chi2 by next to nothing: of the order of kSettled squared. Before there is
  // an estimate of the noise, the weights are about to change anyway.
  static SolveLimits to_the_end(const Rows& rows, double noise) {
    if (!(noise > 0)) return {.function_tolerance = 1e-6, .rounds = 1};
    return {.function_tolerance = kSettled * kSettled / static_cast<double>(rows.row_count())};
  }

  double degrees_of_freedom(const Rows& rows) const {
    return std::max(1.0,
                    static_cast<double>(rows.values) - static_cast<double>(set_.free().size()));
  }

  // How far apart two fits are: the change of the table over the noise.
  double moved(const Material& a, const Material& b, const Misfit& misfit, double noise) const {
    const std::vector<double> from = set_.coordinates(a);
    const std::vector<double> to = set_.coordinates(b);
    const Eigen::MatrixXd products = misfit.products(b, set_);
    const auto count = static_cast<Eigen::Index>(from.size());
    Eigen::VectorXd step(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      step[k] = to[static_cast<std::size_t>(k)] - from[static_cast<std::size_t>(k)];
    }
    const double square = step.dot(products.topLeftCorner(count, count) * step);
    return std::sqrt(std::max(square, 0.0)) / std::max(noise, kLeastNoise);
  }

  // Every pair of layer counts on all rows; the chosen fit may change.
  void profile_layers(ConventionResult& chosen, const ValueSource& source) {
    const auto& pairs = chosen.search.layers.pairs();
    for (int round = 0; round < 3; ++round) {
      const Misfit rough(*observations_, chosen.rows, kSearching, Workers(1, workers_.progress));
      const Misfit exact(*observations_, chosen.rows, kExact, Workers(1, workers_.progress));
      const Solution best = chosen.solution;
      if (workers_.progress != nullptr) {
        workers_.progress->begin("comparing layer counts", pairs.size(), "fits");
      }
      std::vector<Solution> fits(pairs.size());
      run_parallel(pairs.size(), workers_, [&](std::size_t k) {
        const auto [warp, weft] = pairs[k];
        if (warp == best.material.warp.layers && weft == best.material.weft.layers) {
          fits[k] = best;
        } else {
          fits[k] = compare_counts(rough, exact, chosen, warp, weft);
        }
        workers_.advance(1);
      });
      std::size_t lowest = 0;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        chosen.search.layers.at(pairs[k].first, pairs[k].second) = fits[k];
        if (fits[k].cost < fits[lowest].cost) lowest = k;
      }
      if (fits[lowest].cost >= best.cost) return;
      chosen.solution = fits[lowest];
      const Rows rows = chosen.rows;
      settle(*observations_, source, rows, chosen);
    }
  }

  // A cloth of one yarn, where that fits as well: the simpler one is reported, and what sets the
  // yarns apart shows as what cannot be told.
  void try_one_yarn(ConventionResult& chosen) {
    FitOptions options = options_;
    options.wishes.push_back({ParameterWish::Kind::kTie, "weft", {}, {}, {}});
    for (std::size_t i = 0; i < set_.parameters().size(); ++i) {
      const FitParameter& p = set_.parameters()[i];
      if (p.of_yarn && set_.state(i) != ParameterSet::State::kFree) return;
    }
    if (set_.layers_fixed(0) || set_.layers_fixed(1) || set_.layers_tied()) return;
    Material start = chosen.solution.material;
    (start.warp_fraction >= 0.5 ? start.weft : start.warp) =
        start.warp_fraction >= 0.5 ? start.warp : start.weft;
    if (!with_phi_h_) {  // then the share has no effect
      const bool free = std::any_of(set_.free().begin(), set_.free().end(), [&](std::size_t i) {
        return set_.parameters()[i].column == kFraction;
      });
      if (free) {
        start.warp_fraction = 0.5;
        options.wishes.push_back({ParameterWish::Kind::kFix, "warp_fraction", 0.5, {}, {}});
      }
    }
    const ParameterSet tied(options, set_.channels(), with_phi_h_);
    const Misfit misfit(*observations_, chosen.rows, kExact, workers_);
    const Solution one =
        solve(misfit, tied, start, to_the_end(chosen.rows, noise_of(chosen)), workers_);
    const double noise = options_.noise.value_or(std::max(noise_of(chosen), kLeastNoise));
    if ((one.cost - chosen.solution.cost) / (noise * noise) > kToldApart) return;
    const Material first = chosen.solution.start;
    chosen.solution = one;
    chosen.solution.start = first;
    chosen.solution.at_bound.clear();
    chosen.chi2 = chosen.rows.constant + one.cost;
    chosen.search.layers.at(one.material.warp.layers, one.material.weft.layers) = chosen.solution;
    report_.one_yarn = true;
  }

  double noise_of(const ConventionResult& result) const {
    return std::sqrt(result.chi2 / degrees_of_freedom(result.rows));
  }

  // One pair of counts: roughly, and to the end where it comes near the best.
  Solution compare_counts(const Misfit& rough, const Misfit& exact, const ConventionResult& chosen,
                          int warp, int weft) const {
    const Solution& from = chosen.search.layers.at(warp, weft);
    constexpr SolveLimits kLook{
        .iterations = 5, .function_tolerance = 1e-2, .parameter_tolerance = 1e-6, .rounds = 0};
    const Workers single(1, workers_.progress);
    Solution solution = solve(rough, set_, from.material, kLook, single);
    const double freedom = degrees_of_freedom(chosen.rows);
    const double unit = std::max(chosen.chi2 / freedom, kLeastNoise * kLeastNoise);
    // What is near is fitted until a step changes chi2 by a hundredth.
    constexpr double kNear = 10;
    constexpr double kEnough = 0.01;
    if (solution.cost - chosen.solution.cost < kNear * kToldApart * unit) {
      const SolveLimits limits{
          .iterations = 50,
          .function_tolerance =
              kEnough * unit /
              std::max(solution.cost, static_cast<double>(chosen.rows.row_count()) * unit),
          .parameter_tolerance = 1e-9,
          .rounds = 1};
      solution = solve(exact, set_, solution.material, limits, single);
    }
    solution.start = from.start;
    return solution;
  }

  void choose() {
    ConventionResult& chosen = results_[chosen_];
    const ValueSource source = table_values(table_, *observations_);
    profile_layers(chosen, source);
    try_one_yarn(chosen);
    const double freedom = degrees_of_freedom(chosen.rows);
    const double estimated = std::sqrt(chosen.chi2 / freedom);
    const double stored = table_.precision().relative / std::sqrt(3.0);
    report_.noise_estimated = !options_.noise;
    report_.noise = std::max(options_.noise.value_or(estimated), std::max(kLeastNoise, stored));
    const double unit = report_.noise * report_.noise;
    report_.chi2 = chosen.chi2 / unit;
    report_.residual_rms = estimated;
    report_.converged = chosen.solution.converged;
    report_.termination = chosen.solution.termination;
    report_.message = chosen.solution.message;
    report_.iterations = chosen.solution.iterations;
    report_.rows = chosen.rows.row_count();
    report_.starts = chosen.search.starts;
    report_.starts_at_best = chosen.search.starts_at_best;
    report_.optima = chosen.search.optima;
    for (const ConventionResult& r : results_) {
      const bool is_chosen = &r == &chosen;
      report_.conventions.push_back({r.reflectance, r.paths, r.chi2 / unit, is_chosen,
                                     (r.chi2 - chosen.chi2) / unit > kToldApart});
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
    const Material& found = chosen.solution.material;
    const std::vector<Relabelling> equivalents = find_equivalents(places, found, set_);
    relabelling_ = canonical(equivalents, found, with_phi_h_);
    report_.material = relabelling_.apply(found);
    for (const auto& [warp, weft] : chosen.search.layers.pairs()) {
      const Solution& fit = chosen.search.layers.at(warp, weft);
      const double above = (fit.cost - chosen.solution.cost) / (report_.noise * report_.noise);
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
    Material marked = chosen.solution.material;
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
      const double chi2 = (chosen.rows.constant + fit.cost) / unit;
      profile.fits.push_back({exchanged ? weft : warp, exchanged ? warp : weft, chi2,
                              chi2 - report_.chi2 > kToldApart});
    }
    std::sort(profile.fits.begin(), profile.fits.end(), [](const LayerFit& a, const LayerFit& b) {
      return std::pair(a.warp, a.weft) < std::pair(b.warp, b.weft);
    });
  }

  void estimate(const ConventionResult& chosen) {
    // The bounds hold the parameters of the solution as it was found; find them again.
    const Misfit misfit(*observations_, chosen.rows, kExact, workers_);
    ParameterSet inner = set_;
    std::vector<bool> at_bound(set_.parameters().size(), false);
    for (const std::size_t i : chosen.solution.at_bound) {
      const std::size_t there = relabelled(i, chosen.solution.material);
      at_bound[there] = true;
      inner = inner.with_fixed(there);
    }
    const Uncertainty found = uncertainty(misfit.triangle(report_.material, inner), inner,
                                          report_.material, report_.noise);
    report_.blind = found.blind;
    report_.condition = found.condition;
    const Material start = relabelling_.apply(chosen.solution.start);
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
  bool overflows_ = false;                    // the misfit of some convention
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
