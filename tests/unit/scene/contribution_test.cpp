#include "scene/contribution.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/candidates.h"
#include "scene/lit_boxes.h"
#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// More than roundings of sums of a few hundred terms.
constexpr double kSumRounding = 1e-9;

double in_radians(double degrees) { return degrees * pi<double>() / 180; }

AngleBox random_box(RandomInputs& draw, double size) {
  AngleBox box;
  for (std::size_t a = 0; a < 4; ++a) {
    const bool theta = a % 2 == 0;
    const double low = theta ? draw.uniform(0, in_radians(88)) : draw.uniform(-4, 4);
    const double width = size * draw.unit() * (theta ? 0.5 : 1);
    box.angles[a] = {low, theta ? std::min(low + width, in_radians(89)) : low + width};
  }
  return box;
}

struct LoosestBound {
  double outside = -1;  ///< how far a value is beyond its bounds, relative
  double loosest = 0;   ///< upper bound over value, of point boxes
  int compared = 0;
};

// What a candidate takes away at pairs of a box, against the bounds of it.
void compare(const Material& material, const Effects& before, const Candidate& candidate,
             const AngleBox& box, RandomInputs& draw, LoosestBound& worst) {
  const ClothModel<double> with(material, before);
  Effects effects = before;
  leave_out(effects, candidate);
  const ClothModel<double> without(material, effects);
  Contribution contribution(with, candidate.quantity);
  const std::vector<double> radiance = {0.3, 1, 2.5};
  const Interval bounds = contribution(box, radiance);
  for (int n = 0; n < 8; ++n) {
    const DirectionPair pair = pair_in(box, {draw.unit(), draw.unit(), draw.unit(), draw.unit()});
    const PairGeometry<double> g = pair_geometry(pair, 0.0);
    const Components f = with.evaluate(g);
    const Components less = without.evaluate(g);
    double value = 0;
    double whole = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      value = std::max(value, radiance[c] * g.cos_theta_i * std::abs(f.total(c) - less.total(c)));
      whole = std::max(whole, radiance[c] * g.cos_theta_i * std::max(f.total(c), less.total(c)));
    }
    ++worst.compared;
    const double rounding = kSumRounding * whole;
    worst.outside = std::max({worst.outside, (value - rounding - bounds.high) / whole,
                              (bounds.low - value - rounding) / whole});
    INFO(candidate.effect << ": " << value << " of " << whole << " in " << bounds.low << " to "
                          << bounds.high);
    REQUIRE(value <= bounds.high + rounding);
    REQUIRE(value >= bounds.low - rounding);
  }
}

TEST_CASE("what an effect takes away lies within the bounds of a box, for boxes of any size") {
  RandomInputs draw(seed_from_environment());
  LoosestBound worst;
  for (int n = 0; n < soak_cases(150); ++n) {
    MaterialRanges ranges;
    ranges.most_layers = draw.chance(0.1) ? 20 : 6;
    const Material material = draw.material(ranges);
    Effects before;
    for (const std::vector<Candidate>& effect : candidates(material, draw.unit())) {
      const Candidate& candidate =
          effect[static_cast<std::size_t>(draw.integer(0, static_cast<int>(effect.size()) - 1))];
      if (!candidate.changes) continue;
      for (const double size : {1e-9, 0.01, 0.3, 2.0}) {
        compare(material, before, candidate, random_box(draw, size), draw, worst);
      }
      if (draw.chance(0.3)) leave_out(before, candidate);
    }
  }
  INFO("compared " << worst.compared << ", farthest outside " << worst.outside);
  CHECK(worst.compared > 20000);
}

}  // namespace
}  // namespace clothbrdf::test
