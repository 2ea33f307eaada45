#include "scene/angle_box.h"

#include <limits>

#include "model/scalar.h"

namespace clothbrdf {
namespace {

Interval over(double numerator_low, double numerator_high, double denominator_low,
              double denominator_high) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {denominator_high > 0 ? numerator_low / denominator_high : 0,
          denominator_low > 0 ? numerator_high / denominator_low : kInfinity};
}

Interval quotient(const Interval& a, const Interval& positive) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!(positive.low > 0)) {
    return {a.low < 0 ? -kInfinity : 0, a.high > 0 ? kInfinity : 0};
  }
  return {a.low < 0 ? a.low / positive.low : a.low / positive.high,
          a.high < 0 ? a.high / positive.high : a.high / positive.low};
}

// Of angles in [0, pi/2], never negative by rounding.
Interval cosines_of_theta(const Interval& theta) {
  const auto cosine = [](double angle) { return std::max(0.0, std::cos(angle)); };
  return {cosine(theta.high), cosine(theta.low)};
}

Interval sines_of_theta(const Interval& theta) {
  return {std::sin(theta.low), std::sin(theta.high)};
}

// cos^2(angle / 2) of all angles in a range.
Interval half_cosines2(const Interval& angles) {
  const Interval cosine = cosines({angles.low / 2, angles.high / 2});
  return squared(cosine);
}

GeometryBounds common_bounds(const AngleBox& box) {
  const auto& [theta_i, phi_i, theta_o, phi_o] = box.angles;
  GeometryBounds g;
  g.cos_theta_i = cosines_of_theta(theta_i);
  g.cos_theta_o = cosines_of_theta(theta_o);
  const Interval sin_i = sines_of_theta(theta_i);
  const Interval sin_o = sines_of_theta(theta_o);
  const Interval sum_z = g.cos_theta_i + g.cos_theta_o;

  // cos^2 theta_d = s cos^2((theta_i - theta_o) / 2) + (1 - s) cos^2((theta_i + theta_o) / 2), s =
  // cos^2((phi_i - phi_o) / 2); the first square is never the smaller one.
  const Interval same_side = half_cosines2(phi_i - phi_o);
  const Interval near = half_cosines2(theta_i - theta_o);
  const Interval far = half_cosines2(theta_i + theta_o);
  const auto cosine_d = [](double s, double a, double b) {
    return std::sqrt(std::min(1.0, s * a + (1 - s) * b));
  };
  g.cos_theta_d = {cosine_d(same_side.low, near.low, far.low),
                   cosine_d(same_side.high, near.high, far.high)};

  const Interval cos_phi_i = cosines(phi_i);
  const Interval cos_phi_o = cosines(phi_o);
  const Interval quarter = {pi<double>() / 2, pi<double>() / 2};
  const Interval sin_phi_i = cosines(phi_i - quarter);
  const Interval sin_phi_o = cosines(phi_o - quarter);
  g.slope_weft = quotient(sin_i * cos_phi_i + sin_o * cos_phi_o, sum_z);
  g.slope_warp = quotient(sin_i * sin_phi_i + sin_o * sin_phi_o, sum_z);

  // Twice: from the slopes, and as 1 / h_n^2 - 1.
  const Interval from_slopes = squared(g.slope_weft) + squared(g.slope_warp);
  const Interval inverse =
      over(2 * g.cos_theta_d.low, 2 * g.cos_theta_d.high, sum_z.low, sum_z.high);
  g.slope2 = {std::max({0.0, from_slopes.low, inverse.low * inverse.low - 1}),
              std::max(0.0, std::min(from_slopes.high, inverse.high * inverse.high - 1))};
  g.slope2.low = std::min(g.slope2.low, g.slope2.high);
  return g;
}

}  // namespace

std::pair<AngleBox, AngleBox> AngleBox::halves(std::size_t dimension) const {
  std::pair<AngleBox, AngleBox> both{*this, *this};
  const double middle = angles[dimension].middle();
  both.first.angles[dimension].high = middle;
  both.second.angles[dimension].low = middle;
  return both;
}

GeometryBounds geometry_bounds(const AngleBox& box) {
  GeometryBounds g = common_bounds(box);
  const Interval& i = g.cos_theta_i;
  const Interval& o = g.cos_theta_o;
  const Interval& x = g.cos_theta_d;
  const Interval sum_z = i + o;
  // x / (2 cos_theta_o (cos_theta_i + cos_theta_o)).
  g.unshadowed = over(x.low, x.high, 2 * o.low * sum_z.low, 2 * o.high * sum_z.high);
  // G = min(1, low sum_z / x^2); times the above that is
  // min(x / (low sum_z), 1 / x) cos_theta_i / (2 high), low and high the two incidence cosines.
  const Interval low = {std::min(i.low, o.low), std::min(i.high, o.high)};
  const Interval open = over(x.low, x.high, low.low * sum_z.low, low.high * sum_z.high);
  const Interval closed = over(1, 1, x.low, x.high);
  const Interval share = over(i.low, i.high, o.low, o.high);  // cos_theta_i / high where o is it
  g.shadowed = {std::min(open.low, closed.low) * std::min(1.0, share.low) / 2,
                std::min(open.high, closed.high) * std::min(1.0, share.high) / 2};
  // unshadowed max(0, 1 - G).
  const Interval visible =
      over(low.low * sum_z.low, low.high * sum_z.high, x.low * x.low, x.high * x.high);
  const Interval hidden = {std::max(0.0, 1 - visible.high), std::max(0.0, 1 - visible.low)};
  g.shadow = {g.unshadowed.low * hidden.low, hidden.high > 0 ? g.unshadowed.high * hidden.high : 0};
  return g;
}

GeometryBounds paper_geometry_bounds(const AngleBox& box) {
  GeometryBounds g = common_bounds(box);
  const Interval sum_z = g.cos_theta_i + g.cos_theta_o;
  g.shadowed = over(2 * g.cos_theta_d.low, 2 * g.cos_theta_d.high, sum_z.low, sum_z.high);
  g.unshadowed = g.shadowed;
  g.shadow = {0, 0};
  return g;
}

}  // namespace clothbrdf
