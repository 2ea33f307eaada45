#include "fit/residual_regions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fit/misfit.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr const char* kComponents[] = {"specular", "internal", "diffuse"};
constexpr const char* kRegions[] = {"0-45 deg", "45-75 deg", "75-90 deg"};
constexpr std::size_t kParts = std::size(kComponents) * std::size(kRegions);

struct Sums {
  std::size_t values = 0;
  double square = 0;
  double sum = 0;
};

std::size_t region_of(double lower_cosine) {
  constexpr double kCos45 = 0.70710678118654752;
  constexpr double kCos75 = 0.25881904510252074;
  if (lower_cosine >= kCos45) return 0;
  return lower_cosine >= kCos75 ? 1 : 2;
}

// A material's share that makes only one component: B of it, or nothing but D.
ModelValues component(const Observations& observations, Material material, bool specular,
                      Workers workers) {
  (specular ? material.weights.internal : material.weights.specular) = 0;
  return model_values(observations, material, kExact, workers);
}

}  // namespace

std::vector<RegionResidual> residual_regions(const Observations& observations,
                                             const ValueSource& source, const Material& material,
                                             Workers workers) {
  const ModelValues specular = component(observations, material, true, workers);
  const ModelValues internal = component(observations, material, false, workers);
  const std::size_t channels = observations.channels;
  std::vector<std::array<Sums, kParts>> parts(observations.bundles.size());
  run_parallel(parts.size(), workers, [&](std::size_t b) {
    std::vector<double> values;
    const Observations::Bundle& bundle = observations.bundles[b];
    for (std::size_t g = bundle.first_group; g < bundle.end_group; ++g) {
      const Observations::Group& group = observations.groups[g];
      values.resize(group.samples);
      for (std::size_t c = 0; c < channels; ++c) {
        source(g, c, values);
        const double d = specular.diffuse[c];
        for (std::size_t k = 0; k < group.samples; ++k) {
          double from_surface = 0;
          double from_inside = 0;
          for (std::size_t s = 0; s < group.sites; ++s) {
            const double factor = observations.factors[group.first_factor + s * group.samples + k];
            const std::size_t site = (group.first_site + s) * channels + c;
            from_surface += factor * specular.site[site];
            from_inside += factor * internal.site[site];
          }
          const double fitted = from_surface + from_inside + d;
          const bool above = observations.factors[group.first_factor + k] > 0;
          if (!above || !std::isfinite(values[k]) || values[k] < 0 || !(fitted > 0)) continue;
          const std::size_t largest = from_surface >= std::max(from_inside, d) ? 0U
                                      : from_inside >= d                       ? 1U
                                                                               : 2U;
          const double lower = observations.lower_cosines[group.first_factor + k];
          Sums& sums = parts[b][largest * std::size(kRegions) + region_of(lower)];
          const double residual = (values[k] - fitted) / fitted;
          ++sums.values;
          sums.square += residual * residual;
          sums.sum += residual;
        }
      }
    }
  });
  std::vector<RegionResidual> result;
  for (std::size_t k = 0; k < kParts; ++k) {
    Sums total;
    for (const auto& part : parts) {
      total.values += part[k].values;
      total.square += part[k].square;
      total.sum += part[k].sum;
    }
    if (total.values == 0) continue;
    const auto count = static_cast<double>(total.values);
    const double rms = std::sqrt(total.square / count);
    if (!std::isfinite(rms)) continue;
    result.push_back({kComponents[k / std::size(kRegions)], kRegions[k % std::size(kRegions)],
                      total.values, rms, total.sum / count});
  }
  return result;
}

}  // namespace clothbrdf
