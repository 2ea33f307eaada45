#include "formats/alta_parametrisation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "formats/json_text.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Vector = Vector3<double>;
using Coordinates = std::span<const double>;
using Pair = std::optional<DirectionPair>;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr SinCos<double> kRightAngle = {1, 0};

// Files are written with few digits, too: what misses a range, or the length 1, by less is meant to
// lie in it.
constexpr double kSlack = 1e-4;

Vector unit_vector(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Vectors need not have length 1.
Pair pair_of(const Vector& light, const Vector& view) {
  const auto theta = [](const Vector& v) {
    return std::atan2(std::hypot(v[0], v[1]), v[2]) * kDegrees;
  };
  const auto phi = [](const Vector& v) { return std::atan2(v[1], v[0]) * kDegrees; };
  return DirectionPair{theta(light), phi(light), theta(view), phi(view)};
}

Pair pair_of_angles(double theta_l, double phi_l, double theta_v, double phi_v) {
  const auto allowed = [](double theta) {
    return theta >= 0 && theta <= std::numbers::pi + kSlack;
  };
  if (!allowed(theta_l) || !allowed(theta_v)) return std::nullopt;
  return DirectionPair{theta_l * kDegrees, phi_l * kDegrees, theta_v * kDegrees, phi_v * kDegrees};
}

Pair pair_of_half_angles(double theta_h, double phi_h, double theta_d, double phi_d) {
  const auto to_cloth = [&](const Vector& v) {
    const Vector leaning = {v[0] * std::cos(theta_h) + v[2] * std::sin(theta_h), v[1],
                            v[2] * std::cos(theta_h) - v[0] * std::sin(theta_h)};
    return turned(leaning, SinCos<double>{std::sin(phi_h), std::cos(phi_h)});
  };
  const Vector view = unit_vector(theta_d, phi_d);
  return pair_of(to_cloth({-view[0], -view[1], view[2]}), to_cloth(view));
}

std::optional<double> angle_of(double cosine) {
  if (std::abs(cosine) > 1 + kSlack) return std::nullopt;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// sqrt(1 - a^2 - b^2); none where that is no length.
std::optional<double> rest_of_unit(double a, double b) {
  const double square = 1 - a * a - b * b;
  if (square < -kSlack) return std::nullopt;
  return std::sqrt(std::max(square, 0.0));
}

bool has_unit_length(Coordinates v) { return std::abs(std::hypot(v[0], v[1], v[2]) - 1) <= kSlack; }

Pair cos_th(Coordinates x) {
  const auto theta_h = angle_of(x[0]);
  return theta_h ? pair_of_half_angles(*theta_h, 0, 0, 0) : std::nullopt;
}

Pair cos_tk(Coordinates x) {
  const auto theta_k = angle_of(x[0]);
  return theta_k ? pair_of_angles(*theta_k, 0, *theta_k, std::numbers::pi) : std::nullopt;
}

Pair cos_tlv(Coordinates x) {
  const auto theta = angle_of(x[0]);
  return theta ? pair_of_angles(0, 0, *theta, 0) : std::nullopt;
}

Pair cos_th_td(Coordinates x) {
  const auto theta_h = angle_of(x[0]);
  const auto theta_d = angle_of(x[1]);
  return theta_h && theta_d ? pair_of_half_angles(*theta_h, 0, *theta_d, 0) : std::nullopt;
}

Pair rusin_th_td(Coordinates x) { return pair_of_half_angles(x[0], 0, x[1], std::numbers::pi / 2); }
Pair rusin_th_td_pd(Coordinates x) { return pair_of_half_angles(x[0], 0, x[1], x[2]); }
Pair rusin_th_ph_td_pd(Coordinates x) { return pair_of_half_angles(x[0], x[1], x[2], x[3]); }

Pair rusin_vh(Coordinates x) {
  if (!has_unit_length(x)) return std::nullopt;
  return pair_of({x[0], x[1], x[2]}, {x[0], x[1], x[2]});
}

// K = (Lx - Vx, Ly - Vy, Lz + Vz) / length.
Pair schlick_vk(Coordinates x) {
  if (!has_unit_length(x)) return std::nullopt;
  return pair_of({x[0], x[1], x[2]}, {-x[0], -x[1], x[2]});
}

Pair isotropic_tv_tl_dphi(Coordinates x) { return pair_of_angles(x[1], x[2], x[0], 0); }

// An angle and its azimuth as a vector of that length.
Vector projected(double along, double across) {
  return unit_vector(std::hypot(along, across), std::atan2(across, along));
}

Pair isotropic_tv_proj_dphi(Coordinates x) { return pair_of({0, 0, 1}, projected(x[0], x[1])); }
Pair isotropic_tl_tv_proj_dphi(Coordinates x) {
  return pair_of(unit_vector(x[0], 0), projected(x[1], x[2]));
}

// K halves the way from V to the mirror image of L.
Pair schlick_tl_tk_proj_dphi(Coordinates x) {
  const Vector light = unit_vector(x[0], 0);
  const Vector k = projected(x[1], x[2]);
  const double cosine = light[2] * k[2] - light[0] * k[0];
  return pair_of(light,
                 {2 * cosine * k[0] + light[0], 2 * cosine * k[1], 2 * cosine * k[2] - light[2]});
}

// V around L; azimuth 0 leads to the normal.
Pair retro_tl_tvl_proj_dphi(Coordinates x) {
  const Vector light = unit_vector(x[0], 0);
  const Vector to_normal = {-light[2], 0, light[0]};
  const Vector v = projected(x[1], x[2]);
  return pair_of(
      light, {v[2] * light[0] + v[0] * to_normal[0], v[1], v[2] * light[2] + v[0] * to_normal[2]});
}

// L = H + B, V = H - B, neither of unit length, with H B = 0: x = |H in the plane|, |B|, phi_B -
// phi_H.
Pair stark(double h, double b, const SinCos<double>& phi) {
  const auto h_z = rest_of_unit(h, b);
  if (!h_z || h < 0 || b < 0) return std::nullopt;
  const double across = std::hypot(*h_z, h * phi.cos);
  // H lies flat, at a right angle to B's azimuth.
  const bool flat = !(across > 0);
  const double level = flat ? b : b * *h_z / across;
  const double rise = flat ? 0 : -b * h * phi.cos / across;
  const Vector back = {level * phi.cos, level * phi.sin, rise};
  return pair_of({h + back[0], back[1], *h_z + back[2]}, {h - back[0], -back[1], *h_z - back[2]});
}

Pair stark_2d(Coordinates x) { return stark(x[0], x[1], kRightAngle); }
Pair stark_3d(Coordinates x) { return stark(x[0], x[1], {std::sin(x[2]), std::cos(x[2])}); }

// The same of the projections of H and B.
Pair neumann(double h, double b, const SinCos<double>& phi) {
  const double along = b * phi.cos;
  const double across = b * phi.sin;
  const auto light_z = rest_of_unit(h + along, across);
  const auto view_z = rest_of_unit(h - along, across);
  if (!light_z || !view_z || h < 0 || b < 0) return std::nullopt;
  return pair_of({h + along, across, *light_z}, {h - along, -across, *view_z});
}

Pair neumann_2d(Coordinates x) { return neumann(x[0], x[1], kRightAngle); }
Pair neumann_3d(Coordinates x) { return neumann(x[0], x[1], {std::sin(x[2]), std::cos(x[2])}); }

Pair spherical(Coordinates x) { return pair_of_angles(x[0], x[1], x[2], x[3]); }

Pair stereographic(Coordinates x) {
  const auto from_plane = [](double a, double b) {
    return Vector{2 * a, 2 * b, 1 - a * a - b * b};
  };
  return pair_of(from_plane(x[2], x[3]), from_plane(x[0], x[1]));
}

Pair cartesian(Coordinates x) {
  if (!has_unit_length(x.first(3)) || !has_unit_length(x.subspan(3))) return std::nullopt;
  return pair_of({x[3], x[4], x[5]}, {x[0], x[1], x[2]});
}

constexpr std::string_view kNoDifference = "theta_d, phi_d are not in the file: taken as 0";
constexpr std::string_view kNoLight = "theta_l is not in the file: taken as 0";
constexpr std::string_view kNoAzimuth =
    "phi_d is not in the file: taken as 90 degrees, as ALTA does";
constexpr std::string_view kNoBackAzimuth =
    "the azimuth of the back vector is not in the file: taken as 90 degrees from the half vector, "
    "as ALTA does";
constexpr std::string_view kMirrored =
    "only the back vector is in the file: light and eye taken as each other's mirror image";

constexpr AltaParametrisation kAll[] = {
    {"COS_TH", 1, true, kNoDifference, cos_th},
    {"COS_TK", 1, true, kMirrored, cos_tk},
    {"COS_TLV", 1, true, kNoLight, cos_tlv},
    {"RUSIN_TH_TD", 2, true, kNoAzimuth, rusin_th_td},
    {"COS_TH_TD", 2, true, "phi_d is not in the file: taken as 0", cos_th_td},
    {"ISOTROPIC_TV_PROJ_DPHI", 2, true, kNoLight, isotropic_tv_proj_dphi},
    {"STARK_2D", 2, true, kNoBackAzimuth, stark_2d},
    {"NEUMANN_2D", 2, true, kNoBackAzimuth, neumann_2d},
    {"RUSIN_TH_TD_PD", 3, true, "", rusin_th_td_pd},
    {"ISOTROPIC_TV_TL_DPHI", 3, true, "", isotropic_tv_tl_dphi},
    {"RUSIN_VH", 3, false, kNoDifference, rusin_vh},
    {"SCHLICK_VH", 3, false, kMirrored, schlick_vk},
    {"ISOTROPIC_TL_TV_PROJ_DPHI", 3, true, "", isotropic_tl_tv_proj_dphi},
    {"SCHLICK_TL_TK_PROJ_DPHI", 3, true, "", schlick_tl_tk_proj_dphi},
    {"RETRO_TL_TVL_PROJ_DPHI", 3, true, "", retro_tl_tvl_proj_dphi},
    {"STARK_3D", 3, true, "", stark_3d},
    {"NEUMANN_3D", 3, true, "", neumann_3d},
    {"RUSIN_TH_PH_TD_PD", 4, false, "", rusin_th_ph_td_pd},
    {"SPHERICAL_TL_PL_TV_PV", 4, false, "", spherical},
    {"STEREOGRAPHIC", 4, false, "", stereographic},
    {"CARTESIAN", 6, false, "", cartesian},
};

}  // namespace

const AltaParametrisation& alta_parametrisation(std::string_view wanted, const std::string& name) {
  const auto found = std::find_if(std::begin(kAll), std::end(kAll),
                                  [&](const AltaParametrisation& p) { return p.name == wanted; });
  if (found != std::end(kAll)) return *found;
  if (wanted == "COS_TLR") {
    throw InputError(name + ": #PARAM_IN: COS_TLR is not read: ALTA gives its sign in two ways");
  }
  std::string known;
  for (const AltaParametrisation& p : kAll) {
    known += (known.empty() ? "" : ", ") + std::string(p.name);
  }
  throw InputError(name + ": #PARAM_IN: '" + one_line(wanted) + "' is not known; known: " + known);
}

}  // namespace clothbrdf
