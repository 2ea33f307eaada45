#pragma once

#include "model/degrees.h"

namespace clothbrdf {

/// The microfacet directional factor along phi_d at fixed theta_h and theta_d: its integral is
/// closed, and so is the part of the circle above the horizon. With A = cos theta_h cos theta_d, B
/// = sin theta_h sin theta_d and u = |cos phi_d|, the incidence cosines are A - B u and A + B u; u
/// beyond A / B is below the horizon, and the factor is shadowed, h_n / (2 x (A + B u)), where A -
/// B u < x / (2 h_n), else 1 / (4 (A - B u)(A + B u)).
class FactorArc {
 public:
  /// An angle along phi_d, counted from the right angle towards 0 (chi > 0) or pi (chi < 0), |chi|
  /// <= pi/2, with the functions of it that all arcs need.
  struct Edge {
    explicit Edge(double signed_chi);
    double chi;
    double sin;       ///< of |chi|
    double cos;       ///< of |chi|
    double tan_half;  ///< of half of phi = pi/2 - |chi|
  };

  /// Both angles in (0, pi/2).
  FactorArc(const SinCos<double>& theta_h, const SinCos<double>& theta_d);

  /// Integral of the factor and length of the arc above the horizon, from the right angle to the
  /// edge. Odd in chi.
  struct Integral {
    double factor;
    double length;
  };
  Integral from_right_angle(const Edge& edge) const;

 private:
  double unshadowed(
      const Edge& edge) const;  // integral of 1 / (4 (A^2 - B^2 sin^2)) up to the edge
  double over_far_cosine(double tan_half) const;  // integral of 1 / (A + B cos) from 0 to phi

  double cos_sum_;         // A - B
  double cos_difference_;  // A + B
  double a_;
  double k_;                 // sqrt |A^2 - B^2|
  double shadow_;            // h_n / (2 x)
  double chi_horizon_;       // the arc above the horizon ends here
  double horizon_tan_half_;  // tan(phi / 2) there
  double chi_shadow_;        // the factor is shadowed beyond
  double to_shadow_;         // unshadowed(chi_shadow_)
  double phi_shadow_;        // over_far_cosine where shadow begins
};

}  // namespace clothbrdf
