#include "scene/brightest.h"

#include <algorithm>
#include <cmath>

#include "scene/contribution.h"

namespace clothbrdf {
namespace {

using Shares = std::array<double, 4>;

// What is stated of the brightest value: it is within 0.1 % of the maximum.
constexpr double kClose = 1.001;

// f_r cos(theta_i) radiance of one lit box, by shares of its ranges.
class Climb {
 public:
  Climb(const ClothModel<double>& model, const LitBox& within) : model_(model), within_(within) {}

  double value(const Shares& shares) const {
    DirectionPair pair = pair_in(within_.box, shares);
    // On the horizon itself f is 0.
    pair.theta_i = std::min(pair.theta_i, kHighestTheta);
    pair.theta_o = std::min(pair.theta_o, kHighestTheta);
    const PairGeometry<double> g = pair_geometry(pair, 0.0);
    const Components f = model_.evaluate(g);
    double largest = 0;
    for (std::size_t c = 0; c < within_.radiance.size(); ++c)
      largest = std::max(largest, within_.radiance[c] * f.total(c));
    return largest * g.cos_theta_i;
  }

  // From a start uphill, first by steps of the given size: along each axis and along pairs of them,
  // since ridges run where light and eye move together.
  double climb(Shares at, double step) const {
    double best = value(at);
    for (; step > kFinestStep; step /= 2) {
      for (bool better = true; better;) {
        const double before = best;
        for (std::size_t a = 0; a < 4; ++a) {
          for (std::size_t b = a; b < 4; ++b) {
            for (const auto& [along_a, along_b] : kSigns) {
              if (a == b && along_a != along_b) continue;
              Shares next = at;
              next[a] = std::clamp(next[a] + along_a * step, 0.0, 1.0);
              if (b != a) next[b] = std::clamp(next[b] + along_b * scale(a, b) * step, 0.0, 1.0);
              if (next == at) continue;
              if (const double there = value(next); there > best) {
                best = there;
                at = next;
              }
            }
          }
        }
        better = best > before * (1 + kLeastGain);
      }
    }
    return best;
  }

 private:
  static constexpr double kHighestTheta = 89.9999;
  static constexpr double kFinestStep = 1e-6;
  static constexpr double kLeastGain = 1e-5;
  static constexpr std::array<std::pair<double, double>, 4> kSigns = {
      {{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

  // Both by the same angle.
  double scale(std::size_t a, std::size_t b) const {
    const double of_b = within_.box.angles[b].width();
    return of_b > 0 ? within_.box.angles[a].width() / of_b : 0;
  }

  const ClothModel<double>& model_;
  const LitBox& within_;
};

// The shares at which the middle of a part of a box is.
Shares middle_of(const AngleBox& part, const AngleBox& whole) {
  Shares shares;
  for (std::size_t a = 0; a < 4; ++a) {
    const Interval& range = whole.angles[a];
    shares[a] = range.width() > 0
                    ? std::clamp((part.angles[a].middle() - range.low) / range.width(), 0.0, 1.0)
                    : 0;
  }
  return shares;
}

// The largest share of a box's ranges that a part of it takes.
double widest_share(const AngleBox& part, const AngleBox& whole) {
  double widest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const double range = whole.angles[a].width();
    if (range > 0) widest = std::max(widest, part.angles[a].width() / range);
  }
  return widest;
}

bool holds(const AngleBox& whole, const AngleBox& part) {
  for (std::size_t a = 0; a < 4; ++a) {
    if (part.angles[a].low < whole.angles[a].low || part.angles[a].high > whole.angles[a].high)
      return false;
  }
  return true;
}

}  // namespace

Brightest brightest(const ClothModel<double>& model, const LitBoxes& scene,
                    const Workers& workers) {
  Contribution whole(model, {});
  const BoxBounds bounds = [&](const LitBox& lit) { return whole(lit.box, lit.radiance); };
  // First roughly, to learn from where to climb; then as closely as is worth it.
  Brightest found;
  for (const Enough& enough :
       {Enough{.ratio = 1.3, .most_boxes = 50000}, Enough{.ratio = kClose, .most_boxes = 200000}}) {
    Enough known = enough;
    known.reached = found.reached;
    const Maximum range = maximum(bounds, scene.boxes(), known, workers);
    for (const Maximum::Start& start : range.best) {
      if (start.high <= kClose * found.reached) break;
      for (const LitBox& lit : scene.boxes()) {
        if (lit.radiance.data() != start.lit.radiance.data() || !holds(lit.box, start.lit.box))
          continue;
        workers.check();
        found.reached = std::max(found.reached, Climb(model, lit)
                                                    .climb(middle_of(start.lit.box, lit.box),
                                                           widest_share(start.lit.box, lit.box)));
        break;
      }
    }
    found.at_most = std::max(found.reached, range.value.high);
    if (found.at_most <= kClose * found.reached) break;
  }
  return found;
}

}  // namespace clothbrdf
