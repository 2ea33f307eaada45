#include "cost/nodes.h"

#include <algorithm>
#include <cmath>

namespace clothbrdf {
namespace {

constexpr std::size_t kBins = 90;
// Steps are at most so many times as wide as the narrowest: directions that the error's definition
// leaves out, or hardly weighs, are looked at as well.
constexpr double kWidest = 8;
// Nodes beyond the angles at which errors are counted, on top of those that errors ask for. f grows
// as 1/cos^2 theta_d there: a single node would overstate what lies before it, and one at 90
// degrees would lie on the horizon.
std::vector<double> outer_nodes(const Axis& axis) {
  if (axis.mirrored) return {};
  return axis.name == "theta_d" ? std::vector<double>{86, 87, 88} : std::vector<double>{88};
}

// The axes that a weave's symmetries leave.
std::vector<Axis> symmetric_axes(const TableSpec& spec) {
  const Material& material = spec.provenance.material.value();
  const double around = material.reflectance == Reflectance::kPaper ? 180 : 90;
  const double beyond = std::fmod(material.rotation_deg, 90);  // exact, whatever its size
  const double turn = beyond < 0 ? beyond + 90 : beyond;
  std::vector<Axis> axes = {{"theta_h", Spacing::kListed, 0, 0, 90, false, false}};
  if (!spec.isotropic()) {
    axes.push_back({"phi_h", Spacing::kListed, 0, turn, turn + 90, false, true});
  }
  axes.push_back({"theta_d", Spacing::kListed, 0, 0, 90, false, false});
  axes.push_back({"phi_d", Spacing::kListed, 0, 0, around, false, true});
  return axes;
}

// What an error counts at one value, so that the sum of squares is that of the metric.
double weight_of(const Directions& pair, double share, double exact, double mean, Metric metric) {
  if (metric == Metric::kP99) return share / ((exact + 1e-3 * mean) * (exact + 1e-3 * mean));
  const double cosines = pair.wi[2] * pair.wo[2];
  return share * cosines * cosines;
}

std::vector<double> smoothed(const std::vector<double>& values) {
  constexpr std::ptrdiff_t kReach = 2;
  std::vector<double> result(values.size());
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, k - kReach);
    const std::ptrdiff_t to = std::min(size, k + kReach + 1);
    for (std::ptrdiff_t n = from; n < to; ++n) {
      result[static_cast<std::size_t>(k)] +=
          values[static_cast<std::size_t>(n)] / static_cast<double>(to - from);
    }
  }
  return result;
}

}  // namespace

ChosenNodes::ChosenNodes(const Producer& model, const SampledPairs& sampled,
                         std::span<const double> exact, Metric metric, const Workers& workers) {
  const std::size_t channels = model.spec().channels.size();
  const bool isotropic = model.spec().isotropic();
  const Grid angles = {isotropic ? GridKind::kHalfDifference3d : GridKind::kHalfDifference4d,
                       symmetric_axes(model.spec())};
  double mean = 0;
  for (std::size_t v = 0; v < exact.size(); ++v) {
    mean += sampled.shares[v / channels] * exact[v] / static_cast<double>(channels);
  }
  std::vector<double> weights(exact.size());
  double all = 0;
  for (std::size_t v = 0; v < exact.size(); ++v) {
    const std::size_t p = v / channels;
    weights[v] = weight_of(sampled.pairs[p], sampled.shares[p], exact[v], mean, metric);
    all += metric == Metric::kRms ? weights[v] * exact[v] * exact[v] : sampled.shares[p];
  }
  std::vector<Directions> moved(2 * sampled.pairs.size());
  std::vector<double> values(2 * exact.size());
  for (std::size_t a = 0; a < angles.axes.size(); ++a) {
    ChosenAxis chosen{angles.axes[a], angles.axes[a].highest_deg, {}, 0};
    if (!chosen.axis.mirrored) chosen.last_deg = kSampledTheta;
    const double step = chosen.axis.name == "theta_h" ? 0.5 : 1;
    std::vector<double> at(sampled.pairs.size());
    for (std::size_t p = 0; p < sampled.pairs.size(); ++p) {
      std::array<double, 4> angle = angles.angles(sampled.pairs[p].wi, sampled.pairs[p].wo);
      at[p] = chosen.axis.folded_deg(angle[a]);
      for (const double side : {-1.0, 1.0}) {
        std::array<double, 4> there = angle;
        there[a] += side * step;
        const std::size_t d = isotropic ? 1 : 2;
        moved[2 * p + (side > 0 ? 1 : 0)] =
            from_half_difference(sincosd(there[0]), sincosd(isotropic ? 0.0 : there[1]),
                                 direction(there[d], there[d + 1]));
      }
    }
    fill_all_pairs(model, workers, moved, values);
    const double width = (chosen.last_deg - chosen.axis.lowest_deg) / kBins;
    std::vector<double> squares(kBins);
    for (std::size_t p = 0; p < sampled.pairs.size(); ++p) {
      if (!moved[2 * p].above_horizon() || !moved[2 * p + 1].above_horizon()) continue;
      const double place = (at[p] - chosen.axis.lowest_deg) / width;
      const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(std::max(0.0, place)));
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t v = p * channels + c;
        const double second =
            (values[2 * p * channels + c] + values[(2 * p + 1) * channels + c] - 2 * exact[v]) /
            (step * step);
        squares[bin] += weights[v] * second * second;
      }
    }
    std::vector<double> density = smoothed(squares);
    for (double& d : density) d = std::pow(d, 0.2);
    const double highest = *std::max_element(density.begin(), density.end());
    double sum = 0;
    for (double& d : density) sum += d = highest > 0 ? std::max(d, highest / kWidest) : 1;
    chosen.cumulative.push_back(0);
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const double wide = width * sum / density[bin];  // of one step in all
      // A step's mean of (t (1 - t) / 2)^2 is 1/120.
      chosen.error += squares[bin] * wide * wide * wide * wide / (120 * all);
      chosen.cumulative.push_back(chosen.cumulative.back() + density[bin] / sum);
    }
    chosen.error = std::sqrt(chosen.error);
    axes_.push_back(std::move(chosen));
  }
}

Grid ChosenNodes::grid(std::span<const int> sizes) const {
  Grid grid{axes_.size() == 4 ? GridKind::kHalfDifference4d : GridKind::kHalfDifference3d, {}};
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const ChosenAxis& chosen = axes_[a];
    Axis axis = chosen.axis;
    axis.size = sizes[a];
    const double range = chosen.last_deg - axis.lowest_deg;
    std::vector<double> outer = outer_nodes(axis);
    // Never without nodes at both ends of what errors are counted for.
    outer.resize(std::min(outer.size(), static_cast<std::size_t>(std::max(0, axis.size - 2))));
    const int inner = axis.size - static_cast<int>(outer.size());
    for (int k = 0; k < inner; ++k) {
      const double share = static_cast<double>(k) / (inner - 1);
      const auto above =
          std::upper_bound(chosen.cumulative.begin() + 1, chosen.cumulative.end() - 1, share);
      const double low = *(above - 1);
      const double bin = static_cast<double>(above - 1 - chosen.cumulative.begin()) +
                         std::min(1.0, (share - low) / (*above - low));
      axis.listed_deg.push_back(axis.lowest_deg + range * (bin / kBins));
    }
    axis.listed_deg.back() = chosen.last_deg;
    axis.listed_deg.insert(axis.listed_deg.end(), outer.begin(), outer.end());
    grid.axes.push_back(std::move(axis));
  }
  return grid;
}

std::vector<int> ChosenNodes::sizes(double error) const {
  std::vector<int> sizes;
  const double of_axis = error / std::sqrt(static_cast<double>(axes_.size()));
  for (const ChosenAxis& chosen : axes_) {
    const double steps = std::sqrt(chosen.error / of_axis);
    const int inner = 1 + std::max(1, static_cast<int>(std::lround(std::min(steps, 1e5))));
    sizes.push_back(inner + static_cast<int>(outer_nodes(chosen.axis).size()));
  }
  return sizes;
}

}  // namespace clothbrdf
