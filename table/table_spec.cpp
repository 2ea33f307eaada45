#include "table/table_spec.h"

#include <algorithm>
#include <charconv>

#include "model/parameters.h"

namespace clothbrdf {

void add_note(std::string& note, std::string_view more) {
  if (more.empty()) return;
  if (!note.empty()) note += "; ";
  note += more;
}

std::string wavelength_name(double wavelength_nm) {
  std::string name = number_text(wavelength_nm) + "nm";
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::vector<Channel> material_channels(const Material& material, bool with_components) {
  static const char* const kRgb[] = {"R", "G", "B"};
  std::vector<Channel> channels;
  for (const Part part : {Part::kTotal, Part::kSpecular, Part::kInternal, Part::kDiffuse}) {
    for (std::size_t c = 0; c < material.channel_count(); ++c) {
      channels.push_back(
          {material.wavelengths_nm.empty() ? kRgb[c] : wavelength_name(material.wavelengths_nm[c]),
           part, c});
    }
    if (!with_components) break;
  }
  return channels;
}

const std::vector<Channel>& rgb_channels() {
  static const std::vector<Channel> kChannels = {
      {"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}, {"B", Part::kTotal, 2}};
  return kChannels;
}

bool TableSpec::isotropic() const {
  if (has_pairs()) return std::get<PairList>(samples).isotropic;
  if (!has_grid()) return std::get<AnyPairs>(samples).isotropic;
  return grid().kind == GridKind::kHalfDifference3d ||
         (grid().kind == GridKind::kInOut && grid().axes[1].size == 1);
}

std::size_t TableSpec::row_count() const {
  if (has_grid()) return grid().row_count();
  return has_pairs() ? pairs().size() : 0;
}

Directions TableSpec::directions(std::size_t cell) const {
  if (has_grid()) return grid().directions(cell);
  const DirectionPair& pair = pairs()[cell];
  return {direction(pair.theta_i, pair.phi_i), direction(pair.theta_o, pair.phi_o)};
}

bool TableSpec::node_above_horizon(std::size_t cell) const {
  return has_grid() ? grid().node_above_horizon(cell) : directions(cell).above_horizon();
}

std::string TableSpec::place(std::size_t cell) const {
  if (has_grid()) return grid().place(cell);
  const DirectionPair& pair = pairs()[cell];
  return "theta_i " + number_text(pair.theta_i) + " phi_i " + number_text(pair.phi_i) +
         " theta_o " + number_text(pair.theta_o) + " phi_o " + number_text(pair.phi_o);
}

std::string TableSpec::description() const {
  if (has_grid()) return grid().description();
  const std::string what = has_pairs() ? std::to_string(pairs().size()) + " pairs" : "any pairs";
  return what + (isotropic() ? ", isotropic" : "");
}

std::optional<double> named_wavelength(const std::string& channel_name) {
  std::string text = channel_name;
  std::replace(text.begin(), text.end(), '_', '.');
  double wavelength = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, wavelength);
  if (error != std::errc() || std::string_view(next, end) != "nm") return std::nullopt;
  return wavelength;
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
