#include "fit/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clothbrdf {
namespace {

// Of a group: its mean in each channel.
struct GroupMean {
  std::vector<double> values;  // [channel]; none where a channel has no value
  double tan_theta_h = 0;
  double cos_theta_d = 0;
};

class Look {
 public:
  Look(const Observations& observations, const ValueSource& source)
      : channels_(observations.channels),
        floor_(channels_, std::numeric_limits<double>::infinity()) {
    std::vector<double> samples;
    for (std::size_t g = 0; g < observations.groups.size(); ++g) {
      const Observations::Group& group = observations.groups[g];
      const Observations::Site& site = observations.sites[group.first_site];
      const HalfVector& half = observations.halves[site.half];
      GroupMean mean{{}, half.sin_theta / half.cos_theta, observations.cos_theta_d[site.x]};
      samples.resize(group.samples);
      for (std::size_t c = 0; c < channels_; ++c) {
        source(g, c, samples);
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t k = 0; k < group.samples; ++k) {
          const bool above = observations.factors[group.first_factor + k] > 0;
          if (!above || !std::isfinite(samples[k]) || samples[k] < 0) continue;
          sum += samples[k];
          ++count;
        }
        if (count == 0) break;
        mean.values.push_back(sum / static_cast<double>(count));
      }
      if (mean.values.size() < channels_) continue;
      for (std::size_t c = 0; c < channels_; ++c) floor_[c] = std::min(floor_[c], mean.values[c]);
      means_.push_back(mean);
    }
  }

  const std::vector<double>& floor() const { return floor_; }
  bool empty() const { return means_.empty(); }

  // Lowest and highest tan(theta_h) at half the height of the light above the floor.
  std::pair<double, double> half_widths() const {
    constexpr double kCloseTogether = 0.9;  // cos_theta_d
    double peak = 0;
    for (const GroupMean& mean : means_) {
      if (mean.cos_theta_d >= kCloseTogether) peak = std::max(peak, excess(mean));
    }
    constexpr double kLow = 0.35;
    constexpr double kHigh = 0.65;
    std::pair<double, double> widths{std::numeric_limits<double>::infinity(), 0};
    for (const GroupMean& mean : means_) {
      const double height = excess(mean) / peak;
      if (mean.cos_theta_d < kCloseTogether || !(height > kLow && height < kHigh)) continue;
      widths.first = std::min(widths.first, mean.tan_theta_h);
      widths.second = std::max(widths.second, mean.tan_theta_h);
    }
    return widths;
  }

 private:
  double excess(const GroupMean& mean) const {
    double sum = 0;
    for (std::size_t c = 0; c < channels_; ++c) sum += mean.values[c] - floor_[c];
    return sum;
  }

  std::size_t channels_;
  std::vector<double> floor_;
  std::vector<GroupMean> means_;
};

}  // namespace

Material estimate_from_table(const Observations& observations, const ValueSource& source,
                             const ParameterSet& set) {
  Material estimate = set.defaults();
  const Look look(observations, source);
  if (look.empty()) return estimate;
  const auto put = [&](const FitParameter& p, double value) {
    if (std::isfinite(value)) set_parameter(estimate, p, std::clamp(value, p.lowest, p.highest));
  };
  const auto [narrow, wide] = look.half_widths();
  const double brightest = *std::max_element(look.floor().begin(), look.floor().end());
  for (std::size_t i = 0; i < set.parameters().size(); ++i) {
    const FitParameter& p = set.parameters()[i];
    if (set.has_start(i) || set.state(i) != ParameterSet::State::kFree) continue;
    if (p.column == kAlong && wide > 0) put(p, narrow);
    if (p.column == kAcross && wide > 0) put(p, wide);
    if (p.column == kDiffuse) put(p, brightest * pi<double>());
    if (p.column == kAbsorption) {
      // The brightest channel is not clear either.
      constexpr double kLeast = 0.05;
      put(p, kLeast + std::log(brightest / look.floor()[p.channel]) / estimate.diffuse_path);
    }
  }
  return set.material(set.coordinates(estimate), estimate);
}

}  // namespace clothbrdf
