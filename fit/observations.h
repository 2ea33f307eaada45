#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fit/lobe_basis.h"
#include "support/progress.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// Where a table was sampled, in the shape that makes the model linear: the value of a cell in a
/// channel is
///
///     sum over its sites of factor * B(site, channel) + D(channel)
///
/// with B the sum over lobes at a site (a half vector and a cos_theta_d) and D the diffuse term. A
/// point cell has one site; an average has the nodes of a quadrature. Cells that share their sites
/// form a group: all phi_d of a half/difference grid, or one cell.
struct Observations {
  struct Site {
    std::uint32_t half;  ///< index into halves
    std::uint32_t x;     ///< index into cos_theta_d
  };
  struct Group {
    std::size_t first_site;
    std::size_t sites;
    std::size_t first_factor;  ///< factors[first_factor + site * samples + sample]
    std::size_t samples;
    std::size_t first_value;  ///< of channel 0 in the table's values
  };
  /// Groups in a row, and the half vectors that they need.
  struct Bundle {
    std::size_t first_group;
    std::size_t end_group;
    std::size_t first_half;
    std::size_t end_half;
  };

  std::vector<HalfVector> halves;
  std::vector<double> cos_theta_d;  ///< distinct
  std::vector<Site> sites;
  std::vector<Group> groups;
  std::vector<Bundle> bundles;
  std::vector<double> factors;       ///< 0 below the horizon
  std::vector<float> lower_cosines;  ///< min(cos theta_i, cos theta_o), about; as `factors`
  std::size_t value_stride = 1;      ///< from a channel to the next in the table's values
  std::size_t channels = 0;
  std::size_t below_horizon = 0;  ///< cells
};

/// Quadrature nodes along each angle of an averaged cell (azimuths of half/difference cells are
/// integrated in closed form). Averaged cells that the horizon cuts are left out.
inline constexpr int kCellNodes = 3;

/// Of a longer list of pairs, so many are observed, evenly spread over it: all of them would tell
/// little more, and fill the memory.
inline constexpr double kMostPairs = 20000;

/// Of a table's samples, for one convention. phi_d up to 180 degrees: the paper's convention is the
/// mean over both orders of the directions. Averages are those of the microfacet convention: the
/// paper's diverge (InputError).
Observations observe(const TableSpec& spec, Reflectance reflectance, Workers workers);

/// Some of the groups, with few distinct cos_theta_d, spread over the whole table: what a search
/// needs.
Observations thinned(const Observations& all, std::size_t most_x, std::size_t most_groups);

}  // namespace clothbrdf
