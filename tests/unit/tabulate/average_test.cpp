#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <thread>

#include "model/reflectance.h"
#include "table/table.h"
#include "tabulate/cubature.h"
#include "tabulate/factor_arc.h"
#include "tabulate/model_producer.h"
#include "tabulate/quadrature.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// A cloth whose evaluation is quick: few lobes.
Material quick_material(RandomInputs& random, double lowest_axis) {
  MaterialRanges ranges;
  ranges.lowest_axis = lowest_axis;
  ranges.most_layers = 3;
  Material material = random.material(ranges);
  material.reflectance = Reflectance::kMicrofacet;
  material.paths = Paths::kSingle;
  return material;
}

// Mean over the part of a half/difference cell above the horizon, by the midpoint rule in the axes'
// own angles with `n` steps each; phi_h is taken at `n_phi` steps of [low, high].
struct BruteForce {
  std::vector<double> mean;
  bool cut;  // by the horizon
};

BruteForce brute_force_mean(const ClothModel<double>& model,
                            const std::array<std::array<double, 2>, 4>& cell, int n, int n_phi) {
  std::vector<double> sum(model.channel_count());
  double measure = 0;
  bool cut = false;
  const auto middle = [&](std::size_t axis, int k, int steps) {
    return cell[axis][0] + (cell[axis][1] - cell[axis][0]) * (k + 0.5) / steps;
  };
  for (int h = 0; h < n; ++h) {
    const SinCos<double> theta_h = sincosd(middle(0, h, n));
    for (int d = 0; d < n; ++d) {
      const SinCos<double> theta_d = sincosd(middle(2, d, n));
      double arc = 0;
      double factors = 0;
      for (int p = 0; p < n; ++p) {
        const IncidenceCosines<double> c =
            incidence_cosines(theta_h, theta_d, sincosd(middle(3, p, n)).cos);
        if (c.i <= 0 || c.o <= 0) {
          cut = true;
          continue;
        }
        arc += 1;
        factors += directional_factor(Reflectance::kMicrofacet, theta_h.cos, theta_d.cos, c.i, c.o);
      }
      const double weight = theta_h.sin * theta_d.sin * theta_d.cos;
      measure += weight * arc;
      if (arc == 0) continue;
      for (int a = 0; a < n_phi; ++a) {
        const SinCos<double> phi = sincosd(middle(1, a, n_phi) - model.material().rotation_deg);
        // A pair whose factor is known: normal incidence on the facet, at the same cos_theta_d.
        const PairGeometry<double> g{
            theta_h.sin * phi.cos, theta_h.sin * phi.sin, theta_h.cos, theta_d.cos, 1, 1};
        const Components f = model.evaluate(g);
        const double there =
            directional_factor(Reflectance::kMicrofacet, g.h_n, g.cos_theta_d, 1.0, 1.0);
        for (std::size_t c = 0; c < sum.size(); ++c) {
          sum[c] += weight *
                    (factors * (f.specular[c] + f.internal[c]) / there + arc * f.diffuse[c]) /
                    n_phi;
        }
      }
    }
  }
  for (double& s : sum) s = measure > 0 ? s / measure : 0;
  return {sum, cut};
}

}  // namespace

TEST_CASE("the closed integral of the directional factor along phi_d equals numerical quadrature") {
  RandomInputs random(seed_from_environment());
  double worst = 0;
  for (int n = 0; n < 400; ++n) {
    const double theta_h = random.uniform(0.01, 1.56);
    // Near theta_h + theta_d = 90 degrees the forms change over.
    const double theta_d = n % 4 == 0 ? std::numbers::pi / 2 - theta_h +
                                            random.log_uniform(1e-12, 1e-2) * (n % 8 == 0 ? 1 : -1)
                                      : random.uniform(0.01, 1.56);
    if (theta_d <= 0 || theta_d >= std::numbers::pi / 2) continue;
    const double chi = random.uniform(0, std::numbers::pi / 2);
    const SinCos<double> h{std::sin(theta_h), std::cos(theta_h)};
    const SinCos<double> d{std::sin(theta_d), std::cos(theta_d)};
    const FactorArc arc(h, d);
    constexpr int kSteps = 20000;
    double factor = 0;
    double length = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double at = chi * (k + 0.5) / kSteps;
      const IncidenceCosines<double> c = incidence_cosines(h, d, std::sin(at));
      if (c.i <= 0 || c.o <= 0) continue;
      factor += directional_factor(Reflectance::kMicrofacet, h.cos, d.cos, c.i, c.o) * chi / kSteps;
      length += chi / kSteps;
    }
    const FactorArc::Integral closed = arc.from_right_angle(FactorArc::Edge(chi));
    // The midpoint rule errs by a step at the horizon.
    const double edge = 2 * chi / kSteps / length;
    INFO("theta_h " << theta_h << " theta_d " << theta_d << " chi " << chi);
    CHECK(std::abs(closed.factor / factor - 1) <= 1e-6 + edge);
    CHECK(std::abs(closed.length / length - 1) <= 1e-6 + edge);
    CHECK(arc.from_right_angle(FactorArc::Edge(-chi)).factor == -closed.factor);
    worst = std::max(worst, std::abs(closed.factor / factor - 1));
  }
  std::cout << "factor along phi_d: worst difference from the midpoint rule " << worst << '\n';
}

TEST_CASE("averages of half/difference cells equal brute-force means") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  int at_horizon = 0;
  for (int n = 0; n < 6; ++n) {
    const Material material = quick_material(random, 0.1);
    const ClothModel<double> model(material);
    const CellRule rule{true, 1e-4};
    const Grid grid = n % 2 == 0 ? halfdiff3d(8, 7, 9) : halfdiff4d(6, 4, 5, 6);
    const Table table = collect(*make_producer(material_spec(material, {}, grid, rule), 1), 1);
    for (int k = 0; k < 12; ++k) {
      const auto cell =
          static_cast<std::size_t>(random.unit() * static_cast<double>(grid.cell_count()));
      const std::array<int, 4> index = grid.indices(cell);
      std::array<std::array<double, 2>, 4> edges{};
      for (std::size_t a = 0; a < grid.axes.size(); ++a) {
        const std::size_t to = a + (grid.axes.size() == 3 && a > 0 ? 1 : 0);
        edges[to] = {grid.axes[a].edge_deg(index[a]), grid.axes[a].edge_deg(index[a] + 1)};
      }
      if (grid.axes.size() == 3) edges[1] = {0, 180};
      const auto [mean, cut] = brute_force_mean(model, edges, 60, grid.axes.size() == 3 ? 60 : 12);
      if (!grid.any_above_horizon(cell)) {
        CHECK(table.value(cell, 0) == 0);
        continue;
      }
      if (mean[0] == 0) continue;  // a sliver that brute force misses
      if (cut) ++at_horizon;
      // What 60 midpoints a side are good for: 1e-3 inside, a few per cent where the horizon cuts
      // the cell.
      const double allowed = cut ? 0.08 : 0.01;
      for (std::size_t c = 0; c < 3; ++c) {
        INFO(grid.description() << " cell " << cell << " seed " << seed);
        CHECK(std::abs(table.value(cell, c) / mean[c] - 1) <= allowed);
        worst = std::max(worst, std::abs(table.value(cell, c) / mean[c] - 1));
      }
    }
  }
  std::cout << "averages against brute force: worst difference " << worst << ", " << at_horizon
            << " cells cut by the horizon (seed " << seed << ")\n";
}

TEST_CASE("averages keep the tolerance they are asked for") {
  RandomInputs random(seed_from_environment());
  const auto check = [&](double axis, const Grid& grid, double tolerance) {
    const Material material = quick_material(random, axis);
    const auto tabulate = [&](double rel) {
      return collect(*make_producer(material_spec(material, {}, grid, {true, rel}), 2), 2);
    };
    const Table exact = tabulate(tolerance / 100);
    const Table table = tabulate(tolerance);
    double worst = 0;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      if (exact.value(cell, 1) == 0) continue;
      worst = std::max(worst, std::abs(table.value(cell, 1) / exact.value(cell, 1) - 1));
    }
    std::cout << grid.description() << " averages, narrowest axis " << axis << ", tolerance "
              << tolerance << ": worst error " << worst << '\n';
    CHECK(worst <= tolerance);
  };
  check(0.3, halfdiff3d(12, 9, 10), 1e-3);
  check(0.01, halfdiff3d(12, 9, 10), 1e-2);
  check(0.1, halfdiff4d(4, 3, 4, 4), 1e-3);
  check(0.3, inout(3, 4, 3, 4), 1e-2);
}

TEST_CASE(
    "a cell of which only a sliver is visible has a mean, one wholly below the horizon has 0") {
  RandomInputs random(seed_from_environment());
  const Material material = quick_material(random, 0.2);
  const Grid grid = halfdiff3d();
  const TableSpec spec = material_spec(material, {}, grid, {true, 1e-2});
  const Table table = collect(*make_producer(spec, 2), 2);
  std::size_t slivers = 0;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    if (table.valid(cell) != (table.value(cell, 0) > 0)) CHECK(cell == 0);
    if (!std::isfinite(table.value(cell, 0))) CHECK(cell == 0);
    if (table.valid(cell) && !grid.node_above_horizon(cell)) ++slivers;
  }
  CHECK(slivers > 1000);
}

TEST_CASE("averages shrink to the point value with the cell") {
  RandomInputs random(seed_from_environment());
  const Material material = quick_material(random, 0.3);
  const Grid grid = halfdiff4d(200, 90, 3, 3);
  const TableSpec spec = material_spec(material, {}, grid, {true, 1e-4});
  const TableSpec points = material_spec(material, {}, halfdiff4d(200, 90, 3, 3));
  std::vector<double> averages(spec.row_values());
  const auto producer = make_producer(spec, 1);
  REQUIRE(producer->spec().row_count() == 18000);
  // Only theta_h and phi_h cells are small here; theta_d cells are wide, so compare with a finer
  // theta_d, too.
  const Grid fine = halfdiff4d(200, 90, 300, 301);
  const auto fine_producer = make_producer(material_spec(material, {}, fine, {true, 1e-4}), 1);
  const auto point_producer = make_producer(material_spec(material, {}, fine), 1);
  std::vector<double> mean(fine_producer->spec().row_values());
  std::vector<double> point(mean.size());
  const std::size_t row = 100 * 90 + 17;
  fine_producer->fill_rows(row, mean);
  point_producer->fill_rows(row, point);
  for (const std::size_t d : {10U, 100U, 200U}) {
    const std::size_t at = d * 301 + 150;
    CHECK(std::abs(mean[at] / point[at] - 1) < 1e-3);
  }
}

TEST_CASE("averages of in/out cells find narrow lobes, or say that they cannot") {
  // One yarn with round lobes, reflecting at the surface only, in cells of 45 by 360 degrees: the
  // means come from a separate integration over half vectors.
  Material material;
  material.warp.absorption = {0};
  material.wavelengths_nm = {550};
  material.warp.layers = 1;
  material.warp.refractive_index = 1.55;
  material.weights = {1, 0, 0};
  const auto mean = [&](double axis, double tolerance) {
    material.warp.lobe_axes = {axis, axis};
    material.weft = material.warp;
    const TableSpec spec = material_spec(material, {}, inout(1, 1, 1, 1), {true, tolerance});
    return collect(*make_producer(spec, 1), 1).value(0, 0);
  };
  CHECK(std::abs(mean(1, 1e-3) / 0.0072773 - 1) <= 1e-3);
  CHECK_THROWS_WITH(mean(0.001, 1e-2), ContainsSubstring("too narrow for cells of inout:1x1x1x1"));
}

TEST_CASE("an average is given up amid a cell or a row once the work is cancelled") {
  // At the tightest tolerance, a single cell of all directions and a single row: both take a
  // minute or more.
  const Material silk = read_material(preset("silk"));
  for (const Grid& grid : {inout(1, 1, 1, 1), halfdiff3d(1, 400, 400)}) {
    Progress progress;
    const auto producer =
        make_producer(material_spec(silk, {}, grid, {true, kTightestAverage}), {1, &progress});
    std::vector<double> row(producer->spec().row_values());
    std::thread patience([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      progress.cancel();
    });
    CHECK_THROWS_AS(producer->fill_rows(0, row), Cancelled);
    patience.join();
  }
}

TEST_CASE("adaptive cubature integrates what has a closed form to its tolerance") {
  const Box4 box{{0, 0, 0, 0}, {1, 2, 1, 1}};
  const auto integrand = [](std::span<const Point4> points, std::span<double> values) {
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto& [x0, x1, x2, x3] = points[p];
      values[2 * p] = x0 * x1 * x1 * x2 * x3;  // 1/2 * 8/3 * 1/2 * 1/2
      values[2 * p + 1] =
          1 / (1e-2 + (x0 - 0.3) * (x0 - 0.3)) * std::exp(x1);  // a peak in one variable
    }
  };
  const auto none_coarse = [](const Box4&) -> std::optional<std::size_t> { return std::nullopt; };
  const std::vector<double> integral = integrate4(integrand, box, 2, 1e-6, none_coarse).value();
  const double peak = 10 * (std::atan(7.0) + std::atan(3.0)) * (std::exp(2.0) - 1);
  CHECK(std::abs(integral[0] / (1.0 / 3) - 1) <= 1e-12);
  CHECK(std::abs(integral[1] / peak - 1) <= 1e-6);
}

TEST_CASE("polynomial weights reproduce polynomials, Gauss rules integrate them") {
  for (const double at : {0.0, 0.123, 0.5, 0.77, 1.0}) {
    const PolynomialWeights weights = polynomial_weights(at);
    double value = 0;
    for (std::size_t n = 0; n < kPolynomialNodes; ++n)
      value += weights[n] * std::pow(polynomial_nodes()[n], 5);
    CHECK(std::abs(value - std::pow(at, 5)) < 1e-14);
  }
  for (const double tolerance : {1e-2, 1e-6}) {
    const RulePair& rules = rules_for(tolerance);
    for (const auto* rule : {&rules.weak, &rules.strong}) {
      const int degree = 2 * static_cast<int>(rule->size()) - 1;
      double sum = 0;
      for (const QuadraturePoint& p : *rule) sum += p.weight * std::pow(p.at, degree);
      CHECK(std::abs(sum * (degree + 1) - 1) < 1e-14);
    }
  }
}

}  // namespace clothbrdf::test
