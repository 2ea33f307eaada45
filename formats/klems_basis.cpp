#include "formats/klems_basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "formats/window_xml.h"

namespace clothbrdf {
namespace {

constexpr KlemsBasis::Band kFull[] = {{5, 1},   {15, 8},  {25, 16}, {35, 20}, {45, 24},
                                      {55, 24}, {65, 24}, {75, 16}, {90, 12}};
constexpr KlemsBasis::Band kHalf[] = {{6.5, 1},   {19.5, 8},  {32.5, 12}, {46.5, 16},
                                      {61.5, 20}, {76.5, 12}, {90, 4}};
constexpr KlemsBasis::Band kQuarter[] = {{9, 1}, {27, 8}, {46, 12}, {66, 12}, {90, 8}};

}  // namespace

DirectionRule KlemsPatch::rule(std::size_t nodes) const {
  const GaussLegendre gauss = gauss_legendre(nodes);
  DirectionRule rule;
  for (std::size_t t = 0; t < nodes; ++t) {
    const double theta = theta_low + gauss.nodes[t] * (theta_high - theta_low);
    const SinCos<double> at = sincosd(theta);
    for (std::size_t p = 0; p < nodes; ++p) {
      const double phi = phi_low + gauss.nodes[p] * (phi_high - phi_low);
      rule.add(direction(theta, phi), gauss.weights[t] * at.sin * at.cos * gauss.weights[p]);
    }
  }
  rule.normalise();
  return rule;
}

std::array<KlemsPatch, 4> KlemsPatch::quarters() const {
  const double theta = (theta_low + theta_high) / 2;
  const double phi = (phi_low + phi_high) / 2;
  return {{{theta_low, theta, phi_low, phi},
           {theta_low, theta, phi, phi_high},
           {theta, theta_high, phi_low, phi},
           {theta, theta_high, phi, phi_high}}};
}

double KlemsPatch::measure() const {
  const double low = sincosd(theta_low).sin;
  const double high = sincosd(theta_high).sin;
  return (high - low) * (high + low) / 2 * degrees_to_radians(phi_high - phi_low);
}

const std::array<KlemsBasis, 3>& KlemsBasis::all() {
  static const std::array<KlemsBasis, 3> kAll = {KlemsBasis("LBNL/Klems Full", kFull),
                                                 KlemsBasis("LBNL/Klems Half", kHalf),
                                                 KlemsBasis("LBNL/Klems Quarter", kQuarter)};
  return kAll;
}

const KlemsBasis& KlemsBasis::full() { return all().front(); }

const KlemsBasis* KlemsBasis::find(std::string_view name) {
  for (const KlemsBasis& basis : all()) {
    if (same_word(basis.name(), name)) return &basis;
  }
  return nullptr;
}

std::size_t KlemsBasis::size() const {
  std::size_t patches = 0;
  for (const Band& band : bands_) patches += band.patches;
  return patches;
}

KlemsPatch KlemsBasis::patch(std::size_t index) const {
  double theta_low = 0;
  for (const Band& band : bands_) {
    if (index < band.patches) {
      const double width = 360.0 / static_cast<double>(band.patches);
      const double phi = width * static_cast<double>(index);
      return {theta_low, band.theta_high, phi - width / 2, phi + width / 2};
    }
    index -= band.patches;
    theta_low = band.theta_high;
  }
  throw std::out_of_range("KlemsBasis: no such patch");
}

std::size_t KlemsBasis::index_of(const Vector3<double>& direction) const {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double theta = std::acos(std::clamp(direction[2], 0.0, 1.0)) * kDegrees;
  double phi = std::atan2(direction[1], direction[0]) * kDegrees;
  if (phi < 0) phi += 360;
  std::size_t before = 0;
  std::size_t band = 0;
  for (; band + 1 < bands_.size() && bands_[band].theta_high <= theta; ++band) {
    before += bands_[band].patches;
  }
  const std::size_t patches = bands_[band].patches;
  const auto nearest =
      static_cast<std::size_t>(std::lround(phi / 360 * static_cast<double>(patches)));
  return before + nearest % patches;
}

}  // namespace clothbrdf
