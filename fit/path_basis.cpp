#include "fit/path_basis.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "fit/incidence_nodes.h"
#include "model/layers.h"
#include "support/threads.h"
#include "tabulate/vectorise.h"

namespace clothbrdf {
namespace {

using PathJet = ceres::Jet<double, 2>;  // by absorption, by refractive index

double value_of(double x) { return x; }
double value_of(const PathJet& x) { return x.a; }

// The shares of each lobe j = 1.. among the basis's nodes, and the slope of its place by the
// scatter.
struct Shares {
  std::size_t nodes = 0;
  std::vector<double> values;  // [j - 1][node]
  std::vector<double> slopes;  // [j - 1]

  Shares(const Yarn& yarn, Paths paths, const LobeBasis& lobes) : nodes(lobes.lanes() - 1) {
    if (nodes == 0) return;
    // A few more lobes than the model keeps where nothing is scattered: they differ in the
    // derivative.
    const int last = paths == Paths::kAll && yarn.scatter == 0
                         ? kLastEvent / 2
                         : std::max(lobe_count(yarn, paths), 2) - 1;
    const int count = paths == Paths::kSingle ? 2 * yarn.layers - 1 : last;
    values.resize(nodes * static_cast<std::size_t>(count));
    for (int j = 1; j <= count; ++j) {
      const double lost = yarn.scatter < 1 ? -std::expm1(log_directionality(yarn.scatter, j)) : 1.0;
      lobes.shares(lost,
                   std::span(values).subspan((static_cast<std::size_t>(j) - 1) * nodes, nodes));
      slopes.push_back(2 * j * std::pow(1 - yarn.scatter, 2 * j - 1) * lobes.lost_slope(lost));
    }
  }
  std::size_t count() const { return slopes.size(); }
};

// Adds the weight of lobe j to the nodes: `to` as [quantity][lane], `moved` by node.
template <class Scalar>
void add(const Shares& shares, std::size_t j, const Scalar& weight, double* to, std::size_t stride,
         double* moved) {
  const double* share = shares.values.data() + (j - 1) * shares.nodes;
  double* value = to + 1;
  if constexpr (kCarriesDerivative<Scalar>) {
    const double slope = value_of(weight) * shares.slopes[j - 1];
    double* by_absorption = value + PathBasis::kByAbsorption * stride;
    double* by_index = value + PathBasis::kByIndex * stride;
    for (std::size_t k = 0; k < shares.nodes; ++k) {
      value[k] += weight.a * share[k];
      by_absorption[k] += weight.v[0] * share[k];
      by_index[k] += weight.v[1] * share[k];
      moved[k] += slope * share[k];
    }
  } else {
    for (std::size_t k = 0; k < shares.nodes; ++k) value[k] += weight * share[k];
  }
}

template <class Scalar>
void walk(const Yarn& yarn, const Shares& shares, const Interface<Scalar>& interface,
          const Scalar& absorption, double tolerance, double* to, std::size_t stride,
          double* moved) {
  constexpr std::size_t kStepsBetweenLooks = 4;
  LayerStack<Scalar> stack(yarn.layers, interface, absorption);
  Scalar left = stack.remaining();
  const double enough = tolerance * (value_of(interface.reflected) + value_of(left));
  for (std::size_t j = 1; j <= shares.count(); ++j) {
    const bool look = j % kStepsBetweenLooks == 0;
    if (look) left = stack.remaining();
    if (j == shares.count() || (look && value_of(left) <= enough)) {
      add(shares, j, look ? left : stack.remaining(), to, stride, moved);
      return;
    }
    add(shares, j, stack.step(), to, stride, moved);
  }
}

template <class Scalar>
void fill(const Yarn& yarn, Paths paths, const LobeBasis& lobes, const Shares& shares, double x,
          std::size_t channel, double tolerance, double* to, std::size_t stride) {
  constexpr bool kSlopes = kCarriesDerivative<Scalar>;
  Scalar index(yarn.refractive_index);
  Scalar absorption(yarn.absorption[channel]);
  if constexpr (kSlopes) {
    absorption.v[0] = 1;
    index.v[1] = 1;
  }
  const Interface<Scalar> interface = fresnel(Scalar(x), index);
  to[0] = value_of(interface.reflected);
  if constexpr (kSlopes) to[PathBasis::kByIndex * stride] = interface.reflected.v[1];
  if (yarn.layers == 0) return;
  std::vector<double> moved(shares.nodes);
  if (paths == Paths::kAll) {
    walk(yarn, shares, interface, absorption, tolerance, to, stride, moved.data());
  } else {
    std::vector<Scalar> weights(shares.count() + 1, Scalar(0));
    single_path_weights(yarn.layers, interface, absorption, std::span<Scalar>(weights));
    for (std::size_t j = 1; j < weights.size(); j += 2) {
      add(shares, j, weights[j], to, stride, moved.data());
    }
  }
  if constexpr (kSlopes) {
    double* by_scatter = to + 1 + PathBasis::kByScatter * stride;
    const std::span<const double> slopes = lobes.node_slopes();
    for (std::size_t i = 0; i < shares.nodes; ++i) {
      for (std::size_t k = 0; k < shares.nodes; ++k) {
        by_scatter[k] += moved[i] * slopes[i * shares.nodes + k];
      }
    }
  }
}

CLOTHBRDF_VECTORISE void add_times(const double* from, double times, std::size_t count,
                                   double* to) {
  for (std::size_t i = 0; i < count; ++i) to[i] += times * from[i];
}

}  // namespace

PathBasis::PathBasis(const Yarn& yarn, Paths paths, const LobeBasis& lobes,
                     std::span<const double> cos_theta_d, double tolerance, bool slopes,
                     Workers workers)
    : channels_(yarn.absorption.size()),
      quantities_(slopes ? kQuantities : 1),
      stride_(padded(lobes.lanes())),
      weights_(cos_theta_d.size() * channels_ * quantities_ * stride_) {
  const Shares shares(yarn, paths, lobes);
  const auto compute = [&](std::span<const double> cosines, double* weights) {
    run_parallel(cosines.size() * channels_, workers, [&](std::size_t k) {
      const double x = cosines[k / channels_];
      const std::size_t channel = k % channels_;
      double* const to = weights + k * quantities_ * stride_;
      if (slopes) {
        fill<PathJet>(yarn, paths, lobes, shares, x, channel, tolerance, to, stride_);
      } else {
        fill<double>(yarn, paths, lobes, shares, x, channel, tolerance, to, stride_);
      }
    });
  };
  if (cos_theta_d.size() <= kMostComputed) {
    compute(cos_theta_d, weights_.data());
    return;
  }
  const IncidenceNodes octaves(cos_theta_d);
  const std::size_t row = channels_ * quantities_ * stride_;
  std::vector<double> at_nodes(octaves.nodes().size() * row);
  compute(octaves.nodes(), at_nodes.data());
  run_parallel(cos_theta_d.size(), workers, [&](std::size_t x) {
    const IncidenceNodes::Place place = octaves.place(cos_theta_d[x]);
    double* const to = weights_.data() + x * row;
    for (std::size_t k = 0; k < IncidenceNodes::kOrder; ++k) {
      add_times(at_nodes.data() + (place.first + k) * row, place.weights[k], row, to);
    }
  });
}

}  // namespace clothbrdf
