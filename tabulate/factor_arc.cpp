#include "tabulate/factor_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clothbrdf {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

// asin of a ratio that rounding may push past 1.
double clamped_asin(double numerator, double denominator) {
  return numerator >= denominator ? kRightAngle : std::asin(std::max(0.0, numerator) / denominator);
}

}  // namespace

FactorArc::FactorArc(double theta_h, double theta_d)
    : cos_sum_(std::cos(theta_h + theta_d)),
      cos_difference_(std::cos(theta_h - theta_d)),
      a_(std::cos(theta_h) * std::cos(theta_d)),
      k_(std::sqrt(std::abs(cos_sum_) * cos_difference_)),
      shadow_(std::cos(theta_h) / (2 * std::cos(theta_d))) {
  const double b = std::sin(theta_h) * std::sin(theta_d);
  chi_horizon_ = clamped_asin(a_, b);
  chi_shadow_ = std::min(chi_horizon_, clamped_asin(a_ - 0.25 / shadow_, b));
  to_shadow_ = unshadowed(chi_shadow_);
  phi_shadow_ = over_far_cosine(kRightAngle - chi_shadow_);
}

double FactorArc::unshadowed(double chi) const {
  const double s = std::sin(chi);
  const double c = std::cos(chi);
  if (cos_sum_ > 0) return std::atan2(k_ * s, a_ * c) / (4 * a_ * k_);
  if (cos_sum_ < 0) return std::atanh(std::min(k_ * s / (a_ * c), 1 - 1e-16)) / (4 * a_ * k_);
  return s / (4 * a_ * a_ * c);
}

double FactorArc::over_far_cosine(double phi) const {
  const double s = std::sin(phi / 2);
  const double c = std::cos(phi / 2);
  const double root = std::sqrt(std::abs(cos_sum_) / cos_difference_);
  if (cos_sum_ > 0) return 2 * std::atan2(root * s, c) / k_;
  if (cos_sum_ < 0) return 2 * std::atanh(root * s / c) / k_;
  return s / (c * a_);
}

FactorArc::Integral FactorArc::from_right_angle(double chi) const {
  const double sign = chi < 0 ? -1 : 1;
  const double arc = std::min(std::abs(chi), chi_horizon_);
  double factor = 0;
  if (arc <= chi_shadow_) {
    factor = unshadowed(arc);
  } else {
    factor = to_shadow_ + shadow_ * (phi_shadow_ - over_far_cosine(kRightAngle - arc));
  }
  return {sign * factor, sign * arc};
}

}  // namespace clothbrdf
