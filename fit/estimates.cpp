#include "fit/estimates.h"

#include <algorithm>

#include "fit/doubts.h"
#include "fit/equivalents.h"
#include "fit/one_yarn.h"
#include "fit/uncertainty.h"

namespace clothbrdf {
namespace {

class Estimates {
 public:
  Estimates(const ChosenFit& chosen, Workers workers, FitReport& report)
      : chosen_(chosen),
        set_(chosen.set),
        report_(report),
        misfit_(chosen.observations, chosen.fit.rows, kExact, workers) {}

  void fill() {
    relabel();
    report_layers();
    if (report_.one_yarn) tied_ = one_yarn_set(set_, chosen_.options, chosen_.with_phi_h);
    const std::vector<std::size_t> at_bound = held_by_bounds(misfit_, set_, report_.material);
    ParameterSet inner = set_;
    for (const std::size_t i : at_bound) inner = inner.with_fixed(i);
    const Uncertainty found = uncertainty_of(inner);
    if (tied_) shared_ = uncertainty_of(*tied_);
    report_.blind = found.blind;
    report_.condition = found.condition;
    const std::vector<Doubt> doubt =
        doubts(misfit_, set_, report_.material, alternatives_, report_.noise);
    const Material start = relabelling_.apply(chosen_.fit.solution.start);
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
        const auto place = static_cast<std::size_t>(free - inner.free().begin());
        judge(p, found.standard_errors[place], doubt[i], estimate);
      } else if (set_.state(i) == ParameterSet::State::kTied) {
        estimate.verdict = Verdict::kTied;
      } else if (set_.state(i) == ParameterSet::State::kFree) {
        estimate.verdict = Verdict::kAtBound;
        estimate.reason = "the best value lies at or beyond its bound";
      }
      report_.parameters.push_back(estimate);
    }
  }

 private:
  void relabel() {
    constexpr std::size_t kPlacesX = 6;
    constexpr std::size_t kPlaces = 40;
    const Observations places = thinned(chosen_.observations, kPlacesX, kPlaces);
    const Material& found = chosen_.fit.solution.material;
    equivalents_ = find_equivalents(places, found, set_);
    relabelling_ = canonical(equivalents_, found, chosen_.with_phi_h);
    report_.material = relabelling_.apply(found);
    for (const Relabelling& other : find_equivalents(places, report_.material, set_)) {
      if (other.exchanges == 0 && other.turn_deg == 0) continue;
      report_.equivalents.push_back({other.words, other.apply(report_.material)});
    }
    for (const auto& [warp, weft] : chosen_.layers.pairs()) {
      const Solution& fit = chosen_.layers.at(warp, weft);
      if (above_chosen(fit) > kToldApart) continue;
      const Material other = nearest(equivalents_, fit.material, report_.material, set_);
      if (other.warp.layers == report_.material.warp.layers &&
          other.weft.layers == report_.material.weft.layers) {
        equivalent_.emplace_back(warp, weft);
      } else {
        alternatives_.push_back(other);
      }
    }
    add_simpler_cloths();
  }

  // Cloths with less to them, where they fit as well: of one yarn alone, and of two that are the
  // same turned by a right angle.
  void add_simpler_cloths() {
    std::size_t share = set_.parameters().size();
    for (const std::size_t i : set_.free()) {
      if (set_.parameters()[i].column == kFraction) share = i;
    }
    if (share == set_.parameters().size()) return;
    for (const double only : {0.0, 1.0}) {
      Material start = report_.material;
      set_parameter(start, set_.parameters()[share], only);
      // A few steps show whether it comes anywhere near.
      constexpr SolveLimits kGlance{
          .iterations = 3, .function_tolerance = 1e-3, .parameter_tolerance = 1e-9, .rounds = 0};
      constexpr SolveLimits kLook{
          .iterations = 20, .function_tolerance = 1e-6, .parameter_tolerance = 1e-9, .rounds = 0};
      constexpr double kNowhereNear = 1000;
      const ParameterSet others = set_.with_fixed(share);
      Solution one = solve(misfit_, others, start, kGlance, Workers(1));
      if (above_chosen(one) > kNowhereNear * kToldApart) continue;
      one = solve(misfit_, others, one.material, kLook, Workers(1));
      if (above_chosen(one) > kToldApart) continue;
      add_alternative(one.material);
      Material crossed = one.material;
      Yarn& gone = only > 0.5 ? crossed.weft : crossed.warp;
      gone = only > 0.5 ? crossed.warp : crossed.weft;
      std::swap(gone.lobe_axes[0], gone.lobe_axes[1]);
      crossed.warp_fraction = 0.5;
      Solution both;
      both.cost = misfit_.cost(crossed);
      if (above_chosen(both) <= kToldApart) add_alternative(crossed);
    }
  }

  void add_alternative(const Material& material) {
    alternatives_.push_back(nearest(equivalents_, material, report_.material, set_));
  }

  double above_chosen(const Solution& fit) const {
    return (fit.cost - chosen_.fit.solution.cost) / (report_.noise * report_.noise);
  }

  void report_layers() {
    // Are the layers exchanged, where the material was relabelled?
    Material marked = chosen_.fit.solution.material;
    marked.warp.layers = 0;
    marked.weft.layers = 1;
    const bool exchanged = relabelling_.apply(marked).warp.layers == 1;
    LayerProfile& profile = report_.layers;
    profile.fewest = chosen_.options.fewest_layers;
    profile.most = chosen_.options.most_layers;
    profile.warp = report_.material.warp.layers;
    profile.weft = report_.material.weft.layers;
    for (const auto& [warp, weft] : chosen_.layers.pairs()) {
      const double above = above_chosen(chosen_.layers.at(warp, weft));
      const bool equivalent = std::find(equivalent_.begin(), equivalent_.end(),
                                        std::pair(warp, weft)) != equivalent_.end();
      profile.fits.push_back({exchanged ? weft : warp, exchanged ? warp : weft,
                              report_.chi2 + above, above > kToldApart, equivalent});
    }
    std::sort(profile.fits.begin(), profile.fits.end(), [](const LayerFit& a, const LayerFit& b) {
      return std::pair(a.warp, a.weft) < std::pair(b.warp, b.weft);
    });
  }

  Uncertainty uncertainty_of(const ParameterSet& set) const {
    return uncertainty(misfit_.triangle(report_.material, set), set, report_.material,
                       report_.noise);
  }

  void judge(const FitParameter& p, const std::optional<double>& standard_error, const Doubt& doubt,
             ParameterEstimate& estimate) const {
    estimate.standard_error = standard_error;
    estimate.verdict = verdict_of(p, estimate.value, standard_error);
    if (estimate.verdict != Verdict::kIdentifiable) estimate.reason = reason_of(p, report_.blind);
    if (chosen_.misses_data && estimate.verdict == Verdict::kIdentifiable) {
      estimate.verdict = Verdict::kWeak;
      estimate.reason = "the model misses the data: its value is that of the nearest cloth";
    }
    if (doubt.verdict > estimate.verdict) {
      estimate.verdict = doubt.verdict;
      estimate.reason = doubt.reason;
    }
    if (tied_ && estimate.verdict != Verdict::kIdentifiable) say_shared(p, estimate);
  }

  // Of a yarn that stands for both.
  void say_shared(const FitParameter& p, ParameterEstimate& estimate) const {
    for (std::size_t k = 0; k < tied_->free().size(); ++k) {
      const FitParameter& both = tied_->parameters()[tied_->free()[k]];
      if (both.of_yarn == p.of_yarn && both.column == p.column && both.channel == p.channel &&
          shared_.standard_errors[k]) {
        estimate.reason += "; if the yarns are equal, its standard error is " +
                           short_text(*shared_.standard_errors[k]);
      }
    }
  }

  const ChosenFit& chosen_;
  const ParameterSet& set_;
  FitReport& report_;
  Misfit misfit_;
  std::vector<Relabelling> equivalents_;  // of the fit as it was found
  Relabelling relabelling_;
  std::vector<Material> alternatives_;           // of layer counts that are not told apart
  std::vector<std::pair<int, int>> equivalent_;  // those that are the chosen fit, relabelled
  std::optional<ParameterSet> tied_;             // where a cloth of one yarn is reported
  Uncertainty shared_;
};

}  // namespace

void report_estimates(const ChosenFit& chosen, Workers workers, FitReport& report) {
  Estimates(chosen, workers, report).fill();
}

}  // namespace clothbrdf
