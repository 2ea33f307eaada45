#include "tabulate/kernel.h"

#include <algorithm>

namespace clothbrdf {

bool floats_do(const ClothModel<double>& model) {
  constexpr double kNarrow = 0.01;
  return narrowest_axis(model) >= kNarrow;
}

double narrowest_axis(const ClothModel<double>& model) {
  double narrowest = 1;
  for (const PreparedYarn<double>& y : model.yarns()) {
    for (const double axis : y.yarn.lobe_axes) narrowest = std::min(narrowest, axis);
  }
  return narrowest;
}

ChannelSums::ChannelSums(const ClothModel<double>& model, std::size_t count)
    : count_(count), specular_(count), internal_(count * model.channel_count()) {
  for (std::size_t c = 0; c < model.channel_count(); ++c) diffuse_.push_back(model.diffuse(c));
}

double ChannelSums::directional(const Channel& channel, std::size_t k) const {
  const double internal = internal_[channel.colour * count_ + k];
  switch (channel.part) {
    case Part::kTotal: return specular_[k] + internal;
    case Part::kSpecular: return specular_[k];
    case Part::kInternal: return internal;
    case Part::kDiffuse: break;
  }
  return 0;
}

double ChannelSums::constant(const Channel& channel) const {
  return channel.part == Part::kTotal || channel.part == Part::kDiffuse ? diffuse_[channel.colour]
                                                                        : 0;
}

}  // namespace clothbrdf
