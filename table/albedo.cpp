#include "table/albedo.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "model/degrees.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr int kAzimuths = 16;
// Azimuths that a symmetry makes equal differ by roundings; the first of them is named.
constexpr double kAzimuthTie = 1e-9;

/// Steps of a rule of midpoints in theta and in phi, degrees.
struct Step {
  double angle;
  double width;
};

// Two steps or more for each cell of the axis, as dense as its cells are.
std::vector<Step> steps_in_cells(const Axis& axis) {
  constexpr int kFewest = 48;  // a coarse grid's horizon is no coarser
  const int each = std::max(2, (kFewest + axis.size - 1) / axis.size);
  std::vector<Step> steps;
  for (int k = 0; k < axis.size; ++k) {
    const double low = axis.edge_deg(k);
    const double width = (axis.edge_deg(k + 1) - low) / each;
    for (int step = 0; step < each; ++step) steps.push_back({low + width * (step + 0.5), width});
  }
  return steps;
}

std::vector<Step> even_steps(double range, int count) {
  std::vector<Step> steps(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    steps[static_cast<std::size_t>(k)] = {range * (k + 0.5) / count, range / count};
  }
  return steps;
}

// The table with f_r cos(theta_i) cos(theta_o) at each node, and that product of cosines as one
// more channel. The quotient of both, interpolated, is the mean of f_r around with nodes near the
// horizon counting little: f_r may grow without bounds there, and an even f_r stays as it is.
Table with_cosines(const Table& table) {
  TableSpec spec = table.spec();
  const std::size_t channels = spec.channels.size();
  const std::size_t columns = spec.column_count();
  spec.channels.push_back({"cosines", Part::kTotal, 0});
  std::vector<double> values(spec.cell_count() * spec.channels.size());
  std::vector<std::uint8_t> valid(spec.cell_count());
  for (std::size_t cell = 0; cell < valid.size(); ++cell) {
    const Directions node = spec.grid().directions(cell);
    valid[cell] = table.valid(cell) && node.above_horizon();
    const double cosines = node.wi[2] * node.wo[2];
    double* const first = values.data() + cell / columns * spec.row_values() + cell % columns;
    for (std::size_t c = 0; c < channels; ++c) first[c * columns] = cosines * table.value(cell, c);
    first[channels * columns] = cosines;
  }
  return {std::move(spec), std::move(values), std::move(valid), table.precision()};
}

// Of a table with cosines; d wo = 4 cos(theta_d) d wh.
void integrate_half_vectors(const Table& table, const Vector3<double>& wi,
                            std::span<double> albedo) {
  const Grid& grid = table.spec().grid();
  constexpr int kIsotropicAzimuths = 120;
  constexpr int kFewestAzimuths = 72;
  int azimuths = kIsotropicAzimuths;
  if (grid.kind == GridKind::kHalfDifference4d) {
    const Axis& phi_h = grid.axes[1];
    azimuths =
        std::max(kFewestAzimuths,
                 2 * phi_h.size *
                     static_cast<int>(std::lround(360 / (phi_h.highest_deg - phi_h.lowest_deg))));
  }
  const std::vector<Step> phis = even_steps(360, azimuths);
  std::vector<double> sample(albedo.size() + 1);
  for (const Step& theta : steps_in_cells(grid.axes[0])) {
    const double area = sincosd(theta.angle).sin * theta.width * phis[0].width * kRadian * kRadian;
    for (const Step& phi : phis) {
      const Vector3<double> wh = direction(theta.angle, phi.angle);
      const double x = wi[0] * wh[0] + wi[1] * wh[1] + wi[2] * wh[2];
      if (x <= 0) continue;
      const Vector3<double> wo = {2 * x * wh[0] - wi[0], 2 * x * wh[1] - wi[1],
                                  2 * x * wh[2] - wi[2]};
      if (!table.interpolate({wi, wo}, sample)) continue;
      const double weight = 4 * x * area * wo[2] / sample.back();
      for (std::size_t c = 0; c < albedo.size(); ++c) albedo[c] += weight * sample[c];
    }
  }
}

// Of the light in direction w, or of the eye there.
void integrate_hemisphere(const Table& table, const Vector3<double>& w, bool of_eye,
                          std::span<double> albedo) {
  constexpr double kWidest = 2;
  // Whole steps to a cell of the axis, where there is a grid.
  const auto fine = [&](std::size_t axis, double range) {
    const int cells = table.spec().has_grid() ? table.spec().grid().axes[axis].size : 1;
    return even_steps(range,
                      cells * std::max(1, static_cast<int>(std::ceil(range / cells / kWidest))));
  };
  const std::vector<Step> phis = fine(3, 360);
  std::vector<double> sample(albedo.size());
  for (const Step& theta : fine(2, 90)) {
    const double area = sincosd(theta.angle).sin * theta.width * phis[0].width * kRadian * kRadian;
    for (const Step& phi : phis) {
      const Vector3<double> other = direction(theta.angle, phi.angle);
      const Directions pair = of_eye ? Directions{other, w} : Directions{w, other};
      if (!table.interpolate(pair, sample)) continue;
      for (std::size_t c = 0; c < albedo.size(); ++c) albedo[c] += other[2] * area * sample[c];
    }
  }
}

// Whether light and eye must be told apart.
bool knows_order(const TableSpec& spec) {
  const std::optional<Material>& material = spec.provenance.material;
  if (material && material->reflectance == Reflectance::kMicrofacet) return false;
  return !spec.has_grid() || spec.grid().kind == GridKind::kInOut;
}

// Whether to integrate over wo; else over half vectors.
bool over_outgoing(const TableSpec& spec) {
  return !spec.has_grid() || spec.grid().kind == GridKind::kInOut;
}

std::vector<double> incident_thetas(const TableSpec& spec) {
  constexpr double kBeyond = 89;
  std::vector<double> thetas;
  for (double theta = 0; theta <= kHighestTheta; theta += 5) thetas.push_back(theta);
  thetas.push_back(kBeyond);
  if (!spec.has_grid()) return thetas;
  const Grid& grid = spec.grid();
  const bool over_wo = grid.kind == GridKind::kInOut;
  const Axis& axis = over_wo ? grid.axes[0] : grid.axes[grid.axes.size() - 2];
  const double steepest = over_wo ? axis.node_deg(axis.size - 1)
                                  : std::max(kHighestTheta, axis.edge_deg(axis.size - 1));
  std::erase_if(thetas, [&](double theta) { return theta > steepest; });
  return thetas;
}

}  // namespace

std::vector<Albedo> albedo_by_theta(const Table& table, const Workers& workers) {
  bool any = false;
  for (std::size_t cell = 0; !any && cell < table.spec().cell_count(); ++cell)
    any = table.valid(cell);
  if (!any || !table.complete()) return {};
  const bool over_wo = over_outgoing(table.spec());
  std::optional<Table> weighted;
  if (!over_wo) weighted = with_cosines(table);
  const std::vector<double> thetas = incident_thetas(table.spec());
  const int azimuths = table.spec().isotropic() ? 1 : kAzimuths;
  const std::size_t roles = knows_order(table.spec()) ? 2 : 1;
  const std::size_t of_theta = roles * static_cast<std::size_t>(azimuths);
  if (workers.progress != nullptr) {
    workers.progress->begin("directional albedo", thetas.size() * of_theta, "directions");
  }
  std::vector<Albedo> all(thetas.size() * of_theta);
  with_threads(workers.threads, [&] {
    run_parallel(all.size(), workers, [&](std::size_t k) {
      Albedo& albedo = all[k];
      albedo.theta_i_deg = thetas[k / of_theta];
      albedo.of_eye = k % roles == 1;
      const std::size_t azimuth = k % of_theta / roles;
      albedo.phi_i_deg = 360.0 * static_cast<double>(azimuth) / azimuths;
      albedo.channels.resize(table.spec().channels.size());
      const Vector3<double> w = direction(albedo.theta_i_deg, albedo.phi_i_deg);
      if (over_wo) {
        integrate_hemisphere(table, w, albedo.of_eye, albedo.channels);
      } else {
        integrate_half_vectors(*weighted, w, albedo.channels);
      }
      const auto largest = std::max_element(albedo.channels.begin(), albedo.channels.end());
      albedo.channel = static_cast<std::size_t>(largest - albedo.channels.begin());
      albedo.value = *largest;
      workers.advance(1);
    });
  });
  std::vector<Albedo> by_theta;
  for (std::size_t t = 0; t < thetas.size(); ++t) {
    const std::span<const Albedo> at_theta = std::span(all).subspan(t * of_theta, of_theta);
    Albedo largest = at_theta.front();
    for (const Albedo& albedo : at_theta) {
      if (albedo.value > largest.value * (1 + kAzimuthTie)) largest = albedo;
    }
    by_theta.push_back(largest);
  }
  return by_theta;
}

}  // namespace clothbrdf
