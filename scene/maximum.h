#pragma once

#include <functional>
#include <span>
#include <vector>

#include "scene/angle_box.h"
#include "support/progress.h"

namespace clothbrdf {

/// A box of directions and the radiance, one a channel, of the light in it.
struct LitBox {
  AngleBox box;
  std::span<const double> radiance;
};

/// Bounds of a quantity over a lit box, as Contribution states them.
using BoxBounds = std::function<Interval(const LitBox&)>;

/// When it is enough to know that a maximum lies in a range.
struct Enough {
  double ratio = 1.25;      ///< high over low
  double reached = 0;       ///< a value that is known to be reached
  double negligible = 0;    ///< or high is no more than this
  double too_much = 1e300;  ///< or low is more than this
  std::size_t most_boxes = 60000;
};

/// The largest value over all boxes: proven to lie in a range.
struct Maximum {
  struct Start {
    double high;
    LitBox lit;
  };
  Interval value;
  std::vector<Start> best;  ///< some boxes that may still hold it, the most promising first
};

/// Branch and bound: the box with the largest upper bound is halved until enough is known. Stops at
/// most_boxes with what is proven by then. Throws Cancelled.
Maximum maximum(const BoxBounds& bounds, std::span<const LitBox> boxes, const Enough& enough,
                const Workers& workers);

}  // namespace clothbrdf
