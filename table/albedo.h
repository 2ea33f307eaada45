#pragma once

#include <span>
#include <vector>

#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// Share of the light from one direction that leaves in all directions: the integral of f_r
/// cos(theta_o) over wo. Or, of the eye, the light that reaches it from an even sky: the integral
/// of f_r cos(theta_i) over wi, which is the same where f_r is reciprocal.
struct Albedo {
  double theta_i_deg = 0;  ///< of the light, or of the eye
  double phi_i_deg = 0;    ///< of the azimuths tried, the one where it is largest
  bool of_eye = false;
  std::size_t channel = 0;  ///< the largest
  double value = 0;
  std::vector<double> channels = {};  ///< of all
};

/// The steepest incidence at which an albedo is judged, degrees.
inline constexpr double kHighestTheta = 85;

/// For theta_i = 0, 5 ... 85 and 89 degrees: the largest albedo over channels and 16 azimuths of
/// the light (one, where the table knows none); over those of the eye too, where neither the grid
/// nor the table's material says that both are the same. In/out tables go to their last node; 89
/// degrees are left out where the last cell of theta_d reaches below.
///
/// Half/difference tables are integrated over half vectors, in steps at most half as wide as their
/// cells; f_r between nodes is their mean weighted by cos(theta_i) cos(theta_o), too: it may grow
/// without bounds towards the horizon. In/out tables are integrated over wo, in steps of at most 2
/// degrees, with f_r interpolated; so are tables without a grid. None where the table does not
/// answer all pairs (Table::complete).
std::vector<Albedo> albedo_by_theta(const Table& table, const Workers& workers);

}  // namespace clothbrdf
