#include "tabulate/lobe_lanes.h"

#include <algorithm>
#include <utility>

namespace clothbrdf {

LobeLanes::LobeLanes(const ClothModel<double>& model, std::vector<Channel> channels,
                     double tolerance)
    : model_(model), channels_(std::move(channels)) {
  for (const PreparedYarn<double>& yarn : model.yarns()) {
    const auto add = [&](const LobeAxes<double>& axes) {
      const double along = 1 / (axes.along * axes.along);
      const double across = 1 / (axes.across * axes.across);
      weft_.push_back(yarn.warp ? across : along);
      warp_.push_back(yarn.warp ? along : across);
    };
    if (model.equal_yarns() && !few_.empty()) {
      few_.push_back(few_[0]);
    } else {
      few_.push_back(few_lobes(yarn, model.material().reflectance, tolerance));
    }
    if (has_surface()) add(yarn.lobes[0].axes);
    for (const Lobe<double>& lobe : few_.back().lobes) add(lobe.axes);
  }
}

void LobeLanes::weights(double cos_theta_d, std::span<double> weights) const {
  std::size_t first = 0;
  std::vector<double> path;
  std::vector<double> few;
  for (std::size_t y = 0; y < few_.size(); ++y) {
    const PreparedYarn<double>& yarn = model_.yarns()[y];
    const std::size_t surfaces = has_surface() ? 1 : 0;
    const std::size_t count = surfaces + few_[y].lobes.size();
    if (y == 1 && model_.equal_yarns()) {
      scale_copy(weights, count);
      continue;
    }
    const Interface<double> interface =
        fresnel(model_.incidence_cosine(cos_theta_d), yarn.yarn.refractive_index);
    path.resize(yarn.lobes.size());
    few.resize(1 + few_[y].lobes.size());
    for (std::size_t colour = 0; colour < model_.channel_count(); ++colour) {
      path_weights(yarn.yarn, yarn.paths, interface, yarn.yarn.absorption[colour],
                   std::span<double>(path));
      few[0] = path[0];
      few_[y].collapse(std::span(path).subspan(1), std::span(few).subspan(1));
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (channels_[c].colour == colour)
          put(y, channels_[c].part, few, weights.data() + c * size() + first);
      }
    }
    first += count;
  }
}

void LobeLanes::put(std::size_t y, Part part, std::span<const double> few, double* to) const {
  const Weights& k = model_.material().weights;
  const PreparedYarn<double>& yarn = model_.yarns()[y];
  const bool specular = part == Part::kTotal || part == Part::kSpecular;
  const bool internal = part == Part::kTotal || part == Part::kInternal;
  const double share = model_.equal_yarns() ? 1 : yarn.share;  // the copy takes care of it
  if (has_surface()) {
    *to++ = specular ? k.specular * share * few[0] / yarn.lobes[0].norm : 0;
  }
  for (std::size_t l = 1; l < few.size(); ++l) {
    *to++ = internal ? k.internal * share * few[l] / few_[y].lobes[l - 1].norm : 0;
  }
}

void LobeLanes::scale_copy(std::span<double> weights, std::size_t count) const {
  const double shares[] = {model_.yarns()[0].share, model_.yarns()[1].share};
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    double* const row = weights.data() + c * size();
    for (std::size_t l = 0; l < count; ++l) {
      row[count + l] = row[l] * shares[1];
      row[l] *= shares[0];
    }
  }
}

bool LobeLanes::has_internal() const {
  return std::any_of(few_.begin(), few_.end(),
                     [](const FewLobes& few) { return !few.lobes.empty(); });
}

double LobeLanes::constant(std::size_t channel) const {
  return constant_part(model_, channels_[channel]);
}

double constant_part(const ClothModel<double>& model, const Channel& channel) {
  return channel.part == Part::kTotal || channel.part == Part::kDiffuse
             ? model.diffuse(channel.colour)
             : 0;
}

double LobeLanes::error() const {
  double largest = 0;
  for (const FewLobes& few : few_) largest = std::max(largest, few.error);
  return largest;
}

}  // namespace clothbrdf
