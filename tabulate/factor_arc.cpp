#include "tabulate/factor_arc.h"

#include <algorithm>
#include <cmath>

namespace clothbrdf {
namespace {

// asin of a ratio that rounding may push past 1.
double clamped_asin(double numerator, double denominator) {
  return numerator >= denominator ? kRightAngle : std::asin(std::max(0.0, numerator) / denominator);
}

}  // namespace

FactorArc::Edge::Edge(double signed_chi)
    : chi(signed_chi),
      sin(std::sin(std::abs(signed_chi))),
      cos(std::cos(std::abs(signed_chi))),
      tan_half(std::tan((kRightAngle - std::abs(signed_chi)) / 2)) {}

FactorArc::FactorArc(const SinCos<double>& theta_h, const SinCos<double>& theta_d)
    : cos_sum_(theta_h.cos * theta_d.cos - theta_h.sin * theta_d.sin),
      cos_difference_(theta_h.cos * theta_d.cos + theta_h.sin * theta_d.sin),
      a_(theta_h.cos * theta_d.cos),
      k_(std::sqrt(std::abs(cos_sum_) * cos_difference_)),
      shadow_(theta_h.cos / (2 * theta_d.cos)) {
  const double b = theta_h.sin * theta_d.sin;
  chi_horizon_ = clamped_asin(a_, b);
  chi_shadow_ = std::min(chi_horizon_, clamped_asin(a_ - 0.25 / shadow_, b));
  horizon_tan_half_ = Edge(chi_horizon_).tan_half;
  const Edge shadow(chi_shadow_);
  to_shadow_ = unshadowed(shadow);
  phi_shadow_ = over_far_cosine(shadow.tan_half);
}

double FactorArc::unshadowed(const Edge& edge) const {
  if (cos_sum_ > 0) return std::atan2(k_ * edge.sin, a_ * edge.cos) / (4 * a_ * k_);
  if (cos_sum_ < 0) {
    return std::atanh(std::min(k_ * edge.sin / (a_ * edge.cos), 1 - 1e-16)) / (4 * a_ * k_);
  }
  return edge.sin / (4 * a_ * a_ * edge.cos);
}

double FactorArc::over_far_cosine(double tan_half) const {
  const double root = std::sqrt(std::abs(cos_sum_) / cos_difference_);
  if (cos_sum_ > 0) return 2 * std::atan(root * tan_half) / k_;
  if (cos_sum_ < 0) return 2 * std::atanh(root * tan_half) / k_;
  return tan_half / a_;
}

FactorArc::Integral FactorArc::from_right_angle(const Edge& edge) const {
  const double sign = edge.chi < 0 ? -1 : 1;
  const double arc = std::min(std::abs(edge.chi), chi_horizon_);
  double factor = 0;
  if (arc <= chi_shadow_) {
    factor = arc < chi_shadow_ ? unshadowed(edge) : to_shadow_;
  } else {
    const double tan_half = arc < chi_horizon_ ? edge.tan_half : horizon_tan_half_;
    factor = to_shadow_ + shadow_ * (phi_shadow_ - over_far_cosine(tan_half));
  }
  return {sign * factor, sign * arc};
}

}  // namespace clothbrdf
