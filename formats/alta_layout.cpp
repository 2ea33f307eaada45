#include "formats/alta_layout.h"

#include <algorithm>
#include <cmath>

#include "model/degrees.h"

namespace clothbrdf {
namespace {

// Nodes are written to all digits; this is far less than any step of a grid.
constexpr double kSameNode = 1e-9;

std::string_view parametrisation_of(const TableSpec& spec) {
  if (!spec.has_grid()) {
    return spec.isotropic() ? "ISOTROPIC_TV_TL_DPHI" : "SPHERICAL_TL_PL_TV_PV";
  }
  switch (spec.grid().kind) {
    case GridKind::kHalfDifference3d: return "RUSIN_TH_TD_PD";
    case GridKind::kHalfDifference4d: return "RUSIN_TH_PH_TD_PD";
    case GridKind::kInOut: break;
  }
  return "SPHERICAL_TL_PL_TV_PV";
}

}  // namespace

AltaLayout::AltaLayout(const TableSpec& spec)
    : spec_(spec),
      parametrisation_(parametrisation_of(spec)),
      dimension_(spec.has_grid() ? spec.grid().axes.size() : (spec.isotropic() ? 3 : 4)) {}

std::string_view AltaLayout::output() const {
  const auto same = [](const Channel& a, const Channel& b) {
    return a.name == b.name && a.part == b.part;
  };
  const bool rgb = std::equal(spec_.channels.begin(), spec_.channels.end(), rgb_channels().begin(),
                              rgb_channels().end(), same);
  return rgb ? "RGB_COLOR" : "INV_STERADIAN";
}

bool AltaLayout::holds(std::size_t cell) const {
  if (!spec_.has_grid()) return true;
  return spec_.cells.average ? spec_.grid().any_above_horizon(cell)
                             : spec_.grid().node_above_horizon(cell);
}

std::array<double, 4> AltaLayout::coordinates(std::size_t cell) const {
  std::array<double, 4> result{};
  if (!spec_.has_grid()) {
    const DirectionPair& p = spec_.pairs()[cell];
    if (!spec_.isotropic()) {
      return {p.theta_i * kRadian, p.phi_i * kRadian, p.theta_o * kRadian, p.phi_o * kRadian};
    }
    const double phi = reduce_turns(p.phi_i) - reduce_turns(p.phi_o);
    return {p.theta_o * kRadian, p.theta_i * kRadian, reduce_turns(phi) * kRadian, 0};
  }
  const std::array<int, 4> index = spec_.grid().indices(cell);
  for (std::size_t a = 0; a < dimension_; ++a) result[a] = coordinate(a, index[a]);
  return result;
}

double AltaLayout::coordinate(std::size_t axis, int k) const {
  const Grid& grid = spec_.grid();
  const Axis& a = grid.axes[axis];
  // From the light's difference vector to the eye's; a value of both orders is that of either.
  const bool turned =
      grid.kind != GridKind::kInOut && axis + 1 == dimension_ && a.highest_deg > 180;
  return (a.node_deg(k) - (turned ? 180 : 0)) * kRadian;
}

std::optional<std::size_t> AltaLayout::cell_at(std::span<const double> coordinates) const {
  std::size_t cell = 0;
  for (std::size_t a = 0; a < dimension_; ++a) {
    const Axis& axis = spec_.grid().axes[a];
    const double offset = coordinate(a, 0) - axis.node_deg(0) * kRadian;
    const double k = std::round(axis.coordinate((coordinates[a] - offset) / kRadian));
    if (!(k >= 0 && k < axis.size)) return std::nullopt;
    if (!(std::abs(coordinate(a, static_cast<int>(k)) - coordinates[a]) < kSameNode)) {
      return std::nullopt;
    }
    cell = cell * static_cast<std::size_t>(axis.size) + static_cast<std::size_t>(k);
  }
  return cell;
}

}  // namespace clothbrdf
