#pragma once

#include <span>
#include <vector>

#include "table/producer.h"
#include "table/sampled_error.h"

namespace clothbrdf {

/// Which error a table is made for.
enum class Metric { kRms, kP99 };

/// Axes of half/difference grids whose nodes lie where linear reading needs them, for one material.
///
/// Between nodes a step h apart linear reading errs by up to h^2/8 of the second derivative. With
/// that derivative's square, weighted as the error's definition does, as a function m(t) of the
/// angle, the sum of squares for n nodes is least where their density is m^(1/5): then every step
/// adds the same. phi_h and phi_d cover only what the symmetries of a weave leave, and are mirrored
/// at their ends: f is even in phi_d and in phi_h - rotation (and reciprocal, where microfacet).
/// theta_h has one node more beyond 85 degrees, theta_d three: no error is counted there.
class ChosenNodes {
 public:
  /// `model` answers pairs; exact is its values at the sampled ones, [pair][channel]. An isotropic
  /// model gives grids without phi_h.
  ChosenNodes(const Producer& model, const SampledPairs& sampled, std::span<const double> exact,
              Metric metric, const Workers& workers);

  /// A grid of so many nodes on each axis, two or more.
  Grid grid(std::span<const int> sizes) const;

  /// The numbers of nodes that share out the error evenly, so that its rms is about `error` (for
  /// kP99 up to a factor).
  std::vector<int> sizes(double error) const;

 private:
  struct ChosenAxis {
    Axis axis;                       // without nodes
    double last_deg = 0;             // where the bins end
    std::vector<double> cumulative;  // share of the nodes up to each edge of even bins
    double error = 0;                // rms with one step, falls as steps^-2
  };
  std::vector<ChosenAxis> axes_;
};

}  // namespace clothbrdf
