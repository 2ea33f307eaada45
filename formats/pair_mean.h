#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "formats/direction_rule.h"
#include "table/producer.h"

namespace clothbrdf {

// Internal to formats/.

/// R, G and B.
using Rgb = std::array<double, 3>;

/// The mean of a producer's f_r over the pairs of two sets of directions, by their rules. The
/// producer has three channels. Not for several threads at once.
class PairSum {
 public:
  explicit PairSum(const Producer& producer) : producer_(producer) {}

  Rgb operator()(const DirectionRule& light, const DirectionRule& eye);

 private:
  const Producer& producer_;
  std::vector<Directions> pairs_;
  std::vector<double> values_;
};

/// Means of f_r over a region of directions to the light and one to the eye, by adaptive
/// quadrature: rules of 3 and of 4 nodes an axis are compared, and the part where they differ the
/// most is cut into 16, until the sum of the differences is at most `tolerance` of the mean, in
/// each channel, or the budget is spent. The difference is the error of the lesser rule; the value
/// is the better one's.
///
/// A region has `DirectionRule rule(std::size_t nodes) const`, `std::array<Region, 4> quarters()
/// const` and `double measure() const`, whose unit is free.
template <class Region>
class AdaptivePairMean {
 public:
  AdaptivePairMean(const Producer& producer, double tolerance)
      : sum_(producer), tolerance_(tolerance) {}

  /// A region with its two rules, which many pairs share.
  struct Ruled {
    explicit Ruled(const Region& of) : region(of), lesser(of.rule(3)), better(of.rule(4)) {}
    Region region;
    DirectionRule lesser;
    DirectionRule better;
  };

  /// A first estimate, to be refined.
  struct Estimate {
    Rgb mean{};
    Rgb error{};
    bool good = false;
  };

  Estimate estimate(const Ruled& light, const Ruled& eye) {
    const Part whole = part(light, eye, 1);
    return {whole.mean, whole.error, close(whole.mean, whole.error)};
  }

  /// Cuts at most `cuts` times; takes what it used from `cuts`.
  Rgb refine(const Ruled& light, const Ruled& eye, std::size_t& cuts) {
    parts_.clear();
    total_ = {};
    add(part(light, eye, 1));
    while (cuts > 0 && !close(total_.mean, total_.error)) {
      --cuts;
      cut(take_worst());
    }
    Rgb mean{};
    for (const Part& p : parts_) {
      for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += p.mean[c];
    }
    return mean;
  }

 private:
  // A pair of regions; its contributions to the mean and to the error of the whole.
  struct Part {
    Region light;
    Region eye;
    double share;
    Rgb mean;
    Rgb error;
    double urgency = 0;
  };

  Part part(const Ruled& light, const Ruled& eye, double share) {
    Part result{light.region, eye.region, share, sum_(light.better, eye.better), {}};
    const Rgb lesser = sum_(light.lesser, eye.lesser);
    for (std::size_t c = 0; c < lesser.size(); ++c) {
      result.error[c] = std::abs(result.mean[c] - lesser[c]) * share;
      result.mean[c] *= share;
    }
    return result;
  }

  bool close(const Rgb& mean, const Rgb& error) const {
    for (std::size_t c = 0; c < mean.size(); ++c) {
      // Not a number is not refined: it would stay one.
      if (error[c] > tolerance_ * std::abs(mean[c])) return false;
    }
    return true;
  }

  // The parts are a heap by their errors, relative to the whole as known when they were added.
  static bool less_urgent(const Part& a, const Part& b) { return a.urgency < b.urgency; }

  void add(Part p) {
    for (std::size_t c = 0; c < p.mean.size(); ++c) {
      total_.mean[c] += p.mean[c];
      total_.error[c] += p.error[c];
    }
    for (std::size_t c = 0; c < p.mean.size(); ++c) {
      const double whole = std::abs(total_.mean[c]);
      if (whole > 0) p.urgency = std::max(p.urgency, p.error[c] / whole);
    }
    parts_.push_back(p);
    std::push_heap(parts_.begin(), parts_.end(), less_urgent);
  }

  Part take_worst() {
    std::pop_heap(parts_.begin(), parts_.end(), less_urgent);
    const Part taken = parts_.back();
    parts_.pop_back();
    for (std::size_t c = 0; c < taken.mean.size(); ++c) {
      total_.mean[c] -= taken.mean[c];
      total_.error[c] -= taken.error[c];
    }
    return taken;
  }

  void cut(const Part& whole) {
    std::vector<Ruled> lights;
    std::vector<Ruled> eyes;
    for (const Region& quarter : whole.light.quarters()) lights.emplace_back(quarter);
    for (const Region& quarter : whole.eye.quarters()) eyes.emplace_back(quarter);
    const double total = whole.light.measure() * whole.eye.measure();
    for (const Ruled& light : lights) {
      for (const Ruled& eye : eyes) {
        const double share = light.region.measure() * eye.region.measure() / total * whole.share;
        add(part(light, eye, share));
      }
    }
  }

  PairSum sum_;
  double tolerance_;
  std::vector<Part> parts_;
  Estimate total_;  // of the parts
};

}  // namespace clothbrdf
