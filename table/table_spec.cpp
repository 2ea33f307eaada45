#include "table/table_spec.h"

#include <charconv>

namespace clothbrdf {
namespace {

std::string shortest(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

std::vector<Channel> material_channels(const Material& material, bool with_components) {
  static const char* const kRgb[] = {"R", "G", "B"};
  std::vector<Channel> channels;
  for (const Part part : {Part::kTotal, Part::kSpecular, Part::kInternal, Part::kDiffuse}) {
    for (std::size_t c = 0; c < material.channel_count(); ++c) {
      channels.push_back(
          {material.wavelengths_nm.empty() ? kRgb[c] : shortest(material.wavelengths_nm[c]) + "nm",
           part, c});
    }
    if (!with_components) break;
  }
  return channels;
}

std::string full_name(const Channel& channel) {
  switch (channel.part) {
    case Part::kSpecular: return "specular." + channel.name;
    case Part::kInternal: return "internal." + channel.name;
    case Part::kDiffuse: return "diffuse." + channel.name;
    case Part::kTotal: break;
  }
  return channel.name;
}

}  // namespace clothbrdf
