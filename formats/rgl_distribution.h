#pragma once

#include <vector>

#include "formats/rgl_layout.h"
#include "table/producer.h"

namespace clothbrdf {

/// What an RGL file tells of half vectors apart from its slices. Readers multiply by the one and
/// divide by the other, so that any positive tables give the right f_r at the nodes: these are
/// chosen for what is left to interpolate.
struct RglDistribution {
  /// D over half vectors, [phi][theta], kNdfSide each: the mean of f_r over the pairs around a half
  /// vector, weighted by cos(theta_i) cos(theta_o). It carries narrow lobes.
  std::vector<float> ndf;
  /// The projected area, [row][theta of the eye]: little more than the eye's cosine.
  std::vector<float> sigma;
};

/// Asks the producer for some million pairs, by the workers. luminance_weights: of each channel.
/// Throws Cancelled.
RglDistribution rgl_distribution(const Producer& producer,
                                 std::span<const double> luminance_weights, Workers workers);

/// The luminance of the values of all channels.
double luminance(std::span<const double> weights, std::span<const double> f);

}  // namespace clothbrdf
