#include <iostream>

#include "fit/misfit.h"
#include "fit/solve.h"
#include "fit/table_values.h"
#include "tests/catch.h"
#include "tests/support/fit_cases.h"

namespace clothbrdf::test {
namespace {

struct TwoWays {
  Table table;
  Observations observations;
  Rows reduced;
  Rows all;

  TwoWays(const Material& material, const Grid& grid, bool average, const RowWeights& weights,
          std::uint64_t seed)
      : table(noisy(table_of(material, grid, {average, 1e-3}), 0.01, seed)),
        observations(observe(table.spec(), material.reflectance, 1)) {
    const ValueSource source = table_values(table, observations);
    const ModelValues fit = model_values(observations, material, kExact, 1);
    reduced = make_rows(observations, source, weights, &fit, true, 1);
    all = make_rows(observations, source, weights, &fit, false, 1);
  }
};

Material cloth_for(const Grid& grid, RandomInputs& random, Reflectance reflectance, Paths paths) {
  Material m = random_cloth(random, 3, 3);
  m.reflectance = reflectance;
  m.paths = paths;
  if (grid.kind == GridKind::kHalfDifference3d) m.rotation_deg = 0;
  return m;
}

// The last digits of an optimum: where the cost no longer tells materials apart, the gradient does.
Material polished(const Misfit& misfit, const ParameterSet& set, Material material) {
  constexpr int kSteps = 12;  // each leaves a few per cent of the error
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::MatrixXd triangle = misfit.triangle(material, set);
    const Eigen::Index count = triangle.cols() - 1;
    const Eigen::VectorXd step = triangle.topLeftCorner(count, count)
                                     .triangularView<Eigen::Upper>()
                                     .solve(triangle.col(count).head(count));
    std::vector<double> coordinates = set.coordinates(material);
    for (Eigen::Index i = 0; i < count; ++i) coordinates[static_cast<std::size_t>(i)] -= step[i];
    material = set.material(coordinates, material);
  }
  return material;
}

}  // namespace

TEST_CASE("reduced rows have the sum of squares and the gradient of all rows at every material") {
  // Of a sum of thousands of squares, in another order.
  constexpr double kRounding = 1e-10;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst_cost = 0;
  double worst_gradient = 0;
  for (int n = 0; n < 12; ++n) {
    const bool average = n % 4 == 3;
    const Grid grid = n % 2 == 0 ? halfdiff3d(10, 8, 12) : halfdiff4d(6, 5, 5, 8);
    const Reflectance reflectance = n % 4 == 1 ? Reflectance::kPaper : Reflectance::kMicrofacet;
    const Material material =
        cloth_for(grid, random, reflectance, n % 3 == 0 ? Paths::kSingle : Paths::kAll);
    const RowWeights weights{n % 5 == 0 ? Weighting::kAbsolute : Weighting::kRelative,
                             n % 6 == 5 ? Loss::kCauchy : Loss::kSquared, 0.01};
    const TwoWays two(material, grid, average, weights, seed + static_cast<std::uint64_t>(n));
    const ParameterSet set({}, 3, grid.kind != GridKind::kHalfDifference3d);
    const Misfit reduced(two.observations, two.reduced, kExact, 1);
    const Misfit all(two.observations, two.all, kExact, 1);
    for (int k = 0; k < 5; ++k) {
      const Material at = shaken(material, set, k * 0.1, seed + static_cast<std::uint64_t>(k));
      const double whole = all.cost(at) + two.all.constant;
      const double short_one = reduced.cost(at) + two.reduced.constant;
      const Eigen::MatrixXd a = all.products(at, set);
      const Eigen::MatrixXd b = reduced.products(at, set);
      const Eigen::Index last = a.cols() - 1;
      INFO(grid.description() << " material " << n << " shaken " << k << " seed " << seed);
      const double cost_error = std::abs(short_one / whole - 1);
      CHECK(cost_error <= kRounding);
      worst_cost = std::max(worst_cost, cost_error);
      for (Eigen::Index i = 0; i < last; ++i) {
        const double error = std::abs(a(i, last) - b(i, last)) / std::sqrt(a(i, i) * whole);
        CHECK(error <= kRounding);
        worst_gradient = std::max(worst_gradient, error);
      }
    }
    CHECK(two.reduced.values == two.all.values);
    CHECK(two.reduced.row_count() < two.all.row_count());
  }
  std::cout << "reduced against all rows: worst cost " << worst_cost << ", gradient "
            << worst_gradient << " (seed " << seed << ")\n";
}

TEST_CASE("reduced rows have the optimum of all rows") {
  // The promise (model.md 8.4).
  constexpr double kSame = 1e-10;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed + 1);
  double worst = 0;
  std::string where;
  for (int n = 0; n < 4; ++n) {
    const Grid grid = halfdiff4d(8, 6, 6, 8);
    const Material material = cloth_for(
        grid, random, n == 1 ? Reflectance::kPaper : Reflectance::kMicrofacet, Paths::kAll);
    const TwoWays two(material, grid, n == 3, {}, seed + static_cast<std::uint64_t>(n));
    const ParameterSet set({}, 3, true);
    const Misfit reduced(two.observations, two.reduced, kExact, 1);
    const Misfit all(two.observations, two.all, kExact, 1);
    const Material start = shaken(material, set, 0.02, seed);
    const Material a = polished(reduced, set, solve(reduced, set, start, {}, 1).material);
    const Material b = polished(all, set, solve(all, set, start, {}, 1).material);
    for (const FitParameter& p : set.parameters()) {
      const double x = parameter_value(a, p);
      const double y = parameter_value(b, p);
      const double error = std::abs(x - y) / std::max(std::abs(y), 1e-3);
      INFO(p.name << ' ' << x << " and " << y << ", material " << n << " seed " << seed);
      CHECK(error <= kSame);
      if (error > worst) where = p.name;
      worst = std::max(worst, error);
    }
  }
  std::cout << "optimum of reduced against all rows: worst difference " << worst << " in " << where
            << " (seed " << seed << ")\n";
}

TEST_CASE("the number of reduced rows does not grow with the samples of phi_d") {
  RandomInputs random(seed_from_environment());
  const Material material = cloth_for(halfdiff3d(), random, Reflectance::kMicrofacet, Paths::kAll);
  for (const int samples : {40, 400}) {
    const TwoWays two(material, halfdiff3d(8, 6, samples), false, {}, 1);
    // One a channel and half vector and theta_d, of those that the horizon leaves anything of.
    const std::size_t most = two.observations.groups.size() * 3 + 3;
    CHECK(two.reduced.row_count() <= most);
    CHECK(two.reduced.row_count() > most * 8 / 10);
    CHECK(two.all.row_count() > static_cast<std::size_t>(samples) * most / 2);
  }
}

}  // namespace clothbrdf::test
