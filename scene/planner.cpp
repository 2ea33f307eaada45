#include "scene/planner.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/parameters.h"
#include "scene/brightest.h"
#include "scene/candidates.h"
#include "support/errors.h"
#include "support/threads.h"
#include "table/grid.h"
#include "table/reached_cells.h"

namespace clothbrdf {
namespace {

using Kind = Quantity::Kind;

// More than all roundings of a bound together, relative to it and to the brightest value.
constexpr double kRelativeRounding = 1e-9;
constexpr double kRounding = 1e-12;

// The mean incidence cosine of pairs spread evenly over the ranges of all boxes.
double mean_cosine(const LitBoxes& lit) {
  constexpr int kPairs = 64;
  // Of the generalised golden ratio in four dimensions: evenly spread, without a seed.
  constexpr std::array<double, 4> kSteps = {0.8566748838545029, 0.7338918566271260,
                                            0.6287067210378087, 0.5385972572236101};
  double sum = 0;
  for (const LitBox& box : lit.boxes()) {
    for (int k = 0; k < kPairs; ++k) {
      std::array<double, 4> shares;
      for (std::size_t a = 0; a < 4; ++a) shares[a] = std::fmod(0.5 + k * kSteps[a], 1.0);
      sum += pair_geometry(pair_in(box.box, shares), 0.0).cos_theta_d;
    }
  }
  const double mean = sum / (kPairs * static_cast<double>(lit.boxes().size()));
  constexpr double kDigits = 1000;
  return std::round(mean * kDigits) / kDigits;
}

// The share of a grid's cells above the horizon that a scene reaches.
double reached_share(const Grid& grid, const Reach& reach) {
  std::vector<std::uint8_t> cells = grid.above_horizon(CellPart::kNode);
  const auto all = std::count(cells.begin(), cells.end(), 1);
  ReachedCells(grid, reach).restrict(cells);
  return static_cast<double>(std::count(cells.begin(), cells.end(), 1)) / static_cast<double>(all);
}

// What is left of the cells of a table, as seen on the default grids.
struct CellsLeft {
  explicit CellsLeft(const Reach& reach)
      : anisotropic(reached_share(halfdiff4d(), reach)),
        isotropic(kCellsWithoutAnisotropy * reached_share(halfdiff3d(), reach)) {}
  double anisotropic;
  double isotropic;
};

// A choice: of each effect none or one of its candidates.
struct Choice {
  std::vector<const Candidate*> left_out;
  double cost = 0;
};

class MaterialPlanner {
 public:
  MaterialPlanner(const Material& material, const LitBoxes& lit, const CellsLeft& cells_left,
                  double brightest, double tolerance, const Workers& workers)
      : material_(material),
        lit_(lit),
        cells_left_(cells_left),
        budget_(tolerance * brightest),
        rounding_(kRounding * brightest),
        workers_(workers),
        effects_(candidates(material, mean_cosine(lit))) {}

  MaterialPlan plan() {
    MaterialPlan plan;
    plan.material = material_;
    estimate();
    std::vector<double> bounds;
    Choice choice = cheapest();
    // An effect's bound depends on what else is left out: what was chosen is proven as a whole, and
    // chosen anew where that is too much.
    while (true) {
      bounds = proven(choice);
      double sum = 0;
      for (const double bound : bounds) sum += bound;
      if (sum <= budget_) break;
      for (std::size_t k = 0; k < bounds.size(); ++k) {
        double& estimate = estimates_[index_of(*choice.left_out[k])];
        // At least a little more than it was, so that this ends.
        estimate = std::max(bounds[k], 1.05 * estimate);
      }
      choice = cheapest();
    }
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      leave_out(plan.effects, *choice.left_out[k]);
      plan.left_out.push_back({choice.left_out[k]->effect, choice.left_out[k]->what, bounds[k]});
      plan.bound += bounds[k];
    }
    // What has nothing to do in what is left: never had, or no more.
    const auto left = candidates(apply_effects(material_, plan.effects), 1);
    for (std::size_t k = 0; k < effects_.size(); ++k) {
      if (left[k].front().changes) continue;
      const std::string& name = effects_[k].front().effect;
      const bool named =
          std::any_of(choice.left_out.begin(), choice.left_out.end(), [&](const Candidate* out) {
            return out->quantity.kind == effects_[k].front().quantity.kind;
          });
      if (!named) plan.left_out.push_back({name, effects_[k].front().what + ": nothing of it", 0});
    }
    plan.kept = kept(choice, left);
    const double full = evaluation_cost(material_, {});
    const double evaluation = evaluation_cost(material_, plan.effects) / full;
    const double cells = plan.effects.anisotropy ? cells_left_.anisotropic : cells_left_.isotropic;
    plan.saving = {1 - evaluation, 1 - cells, 1 - evaluation * cells};
    return plan;
  }

 private:
  // Of a model, how much a candidate takes away at most.
  double bound(const ClothModel<double>& model, const Candidate& candidate) const {
    Contribution contribution(model, candidate.quantity);
    Enough enough;
    enough.negligible = 1e-3 * budget_;
    enough.too_much = budget_;
    const BoxBounds bounds = [&](const LitBox& lit) { return contribution(lit.box, lit.radiance); };
    const double most = maximum(bounds, lit_.boxes(), enough, workers_).value.high;
    return most * (1 + kRelativeRounding) + rounding_;
  }

  void estimate() {
    const ClothModel<double> model(material_);
    std::vector<const Candidate*> all;
    for (const std::vector<Candidate>& effect : effects_) {
      for (const Candidate& candidate : effect) all.push_back(&candidate);
    }
    estimates_.assign(all.size(), 0.0);
    if (!(budget_ > 0)) return;
    with_threads(workers_.threads, [&] {
      run_parallel(all.size(), workers_, [&](std::size_t k) {
        if (all[k]->changes) estimates_[k] = bound(model, *all[k]);
        workers_.advance(1);
      });
    });
  }

  std::size_t index_of(const Candidate& candidate) const {
    std::size_t index = 0;
    for (const std::vector<Candidate>& effect : effects_) {
      if (&candidate >= effect.data() && &candidate < effect.data() + effect.size())
        return index + static_cast<std::size_t>(&candidate - effect.data());
      index += effect.size();
    }
    return index;
  }

  double cost(const std::vector<const Candidate*>& left_out) const {
    Effects effects;
    for (const Candidate* candidate : left_out) leave_out(effects, *candidate);
    const double cells = effects.anisotropy ? cells_left_.anisotropic : cells_left_.isotropic;
    return evaluation_cost(material_, effects) * cells;
  }

  // Tries all choices whose estimates fit, effect by effect.
  Choice cheapest() const {
    Choice best{{}, cost({})};
    if (!(budget_ > 0)) return best;
    std::vector<const Candidate*> chosen;
    const auto extend = [&](const auto& self, std::size_t effect, double left) -> void {
      if (effect == effects_.size()) {
        const double here = cost(chosen);
        // Of equal ones the first, which leaves out the least.
        if (here < best.cost * (1 - kRelativeRounding)) best = {chosen, here};
        return;
      }
      self(self, effect + 1, left);
      for (const Candidate& candidate : effects_[effect]) {
        const double estimate = estimates_[index_of(candidate)];
        if (!candidate.changes || estimate > left) continue;
        chosen.push_back(&candidate);
        self(self, effect + 1, left - estimate);
        chosen.pop_back();
      }
    };
    extend(extend, 0, budget_);
    return best;
  }

  // One thing taken away after the other: bounds of what each changes in what is left then.
  std::vector<double> proven(const Choice& choice) const {
    std::vector<Effects> before;
    Effects effects;
    for (const Candidate* candidate : choice.left_out) {
      before.push_back(effects);
      leave_out(effects, *candidate);
    }
    std::vector<double> bounds(before.size());
    with_threads(workers_.threads, [&] {
      run_parallel(before.size(), workers_, [&](std::size_t k) {
        bounds[k] = bound(ClothModel<double>(material_, before[k]), *choice.left_out[k]);
      });
    });
    return bounds;
  }

  // Effects that are on: not left out, and with something to do.
  std::vector<std::string> kept(const Choice& choice,
                                const std::vector<std::vector<Candidate>>& left) const {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < effects_.size(); ++k) {
      if (!left[k].front().changes) continue;
      const Kind kind = effects_[k].front().quantity.kind;
      const auto out = std::find_if(choice.left_out.begin(), choice.left_out.end(),
                                    [&](const Candidate* c) { return c->quantity.kind == kind; });
      if (out == choice.left_out.end()) {
        names.push_back(effects_[k].front().effect);
      } else if ((*out)->quantity.kept > 0) {
        names.push_back((*out)->effect);  // with a limit
      }
    }
    return names;
  }

  const Material& material_;
  const LitBoxes& lit_;
  const CellsLeft& cells_left_;
  double budget_;
  double rounding_;
  const Workers& workers_;
  std::vector<std::vector<Candidate>> effects_;
  std::vector<double> estimates_;  // of all candidates, in order
};

}  // namespace

Plan make_plan(const Scene& scene, Workers workers) {
  if (const std::optional<SceneProblem> problem = find_problem(scene)) {
    throw std::invalid_argument(problem->pointer + ": " + problem->value +
                                " is not allowed: " + problem->allowed);
  }
  Plan plan{scene.name, scene.tolerance, 0, 0, 0, {}, scene.reach()};
  std::vector<Brightest> found(scene.materials.size());
  with_threads(workers.threads, [&] {
    run_parallel(found.size(), workers, [&](std::size_t m) {
      found[m] = brightest(ClothModel<double>(scene.materials[m]),
                           LitBoxes(scene, scene.materials[m]), workers);
    });
  });
  for (const Brightest& b : found) {
    plan.brightest = std::max(plan.brightest, b.reached);
    plan.brightest_at_most = std::max(plan.brightest_at_most, b.at_most);
  }
  if (!(plan.brightest > 0)) throw WorkError("nothing in the scene reflects any light");
  const CellsLeft cells(plan.reach);
  for (std::size_t m = 0; m < found.size(); ++m) {
    const LitBoxes lit(scene, scene.materials[m]);
    MaterialPlan of_material =
        MaterialPlanner(scene.materials[m], lit, cells, plan.brightest, scene.tolerance, workers)
            .plan();
    for (LeftOut& out : of_material.left_out) out.bound /= plan.brightest;
    of_material.bound /= plan.brightest;
    of_material.brightest = found[m].reached;
    plan.bound = std::max(plan.bound, of_material.bound);
    plan.materials.push_back(std::move(of_material));
  }
  return plan;
}

}  // namespace clothbrdf
