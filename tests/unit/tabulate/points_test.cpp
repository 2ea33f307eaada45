#include <algorithm>
#include <cmath>
#include <iostream>
#include <tuple>

#include "model/reflectance.h"
#include "support/errors.h"
#include "table/table.h"
#include "tabulate/model_producer.h"
#include "tests/catch.h"
#include "tests/support/part_of.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

// Vectors from the grid's node to the model's exact input lose 2 eps / (axis * cos_theta_d); sums
// over lobes in another order a few eps.
constexpr double kSameToRounding = 2e-13;
// Of in/out points, which are evaluated in batches: what these promise at axes of 0.1 and more,
// whose condition number stays below 10 / cos_theta_d.
constexpr double kSameInBatches = 1e-12;

double relative_error(double value, double exact) {
  return exact == 0 ? std::abs(value) : std::abs(value / exact - 1);
}

Material random_material(RandomInputs& random, Reflectance reflectance) {
  MaterialRanges ranges;
  ranges.lowest_axis = 0.1;
  Material material = random.material(ranges);
  material.reflectance = reflectance;
  return material;
}

}  // namespace

TEST_CASE("point values are those of the model at the nodes, component by component") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  double worst_in_batches = 0;
  int compared = 0;
  for (int n = 0; n < 24; ++n) {
    const Reflectance reflectance = n % 2 == 0 ? Reflectance::kMicrofacet : Reflectance::kPaper;
    const Material material = random_material(random, reflectance);
    const Effects effects = n < 4 ? Effects{} : random.effects();
    const ClothModel<double> model(material, effects);
    const double turn = reflectance == Reflectance::kPaper ? 360 : 180;
    for (const Grid& grid : {halfdiff4d(5, 4, 6, 8, turn), inout(4, 6, 3, 4), inout(3, 6, 3, 6),
                             inout(2, 17, 2, 13)}) {
      const Table table =
          collect(*make_producer(material_spec(material, effects, grid, {}, true), 2), 2);
      for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
        const Directions d = grid.directions(cell);
        const Components f = model.evaluate(pair_geometry(d.wi, d.wo, material.rotation_deg));
        for (std::size_t c = 0; c < table.spec().channels.size(); ++c) {
          const double exact = part_of(f, table.spec().channels[c]);
          // A node on the horizon may fall on either side of it.
          if (std::min(std::abs(d.wi[2]), std::abs(d.wo[2])) < 1e-12) continue;
          const double error = relative_error(table.value(cell, c), exact);
          const bool in_batches = grid.kind == GridKind::kInOut;
          double& largest = in_batches ? worst_in_batches : worst;
          largest = std::max(largest, error);
          ++compared;
          if (error > (in_batches ? kSameInBatches : kSameToRounding)) {
            INFO(grid.description()
                 << " cell " << cell << " channel " << full_name(table.spec().channels[c]));
            CHECK(table.value(cell, c) == exact);
          }
        }
      }
    }
  }
  std::cout << "point values against the model: worst relative error " << worst << ", in/out "
            << worst_in_batches << ", of " << compared << " (seed " << seed << ")\n";
  CHECK(worst <= kSameToRounding);
  CHECK(worst_in_batches <= kSameInBatches);
}

TEST_CASE("a grid without phi_h holds the mean over phi_h") {
  RandomInputs random(seed_from_environment());
  for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
    const Material material = random_material(random, reflectance);
    const double turn = reflectance == Reflectance::kPaper ? 360 : 180;
    const Table mean =
        collect(*make_producer(material_spec(material, {}, halfdiff3d(6, 5, 8, turn)), 1), 1);
    // The trapezoid rule converges geometrically for a periodic function.
    constexpr int kAzimuths = 720;
    const Grid fine = halfdiff4d(6, kAzimuths, 5, 8, turn);
    const Table all = collect(*make_producer(material_spec(material, {}, fine), 1), 1);
    for (std::size_t cell = 0; cell < mean.spec().cell_count(); ++cell) {
      const std::size_t row = cell / 40;
      double sum = 0;
      for (std::size_t p = 0; p < kAzimuths; ++p)
        sum += all.value((row * kAzimuths + p) * 40 + cell % 40, 0);
      CHECK(relative_error(sum / kAzimuths, mean.value(cell, 0)) <= 1e-12);
    }
  }
}

TEST_CASE("the components' sum equals the total to rounding, whichever are on") {
  RandomInputs random(seed_from_environment());
  const Material material = random_material(random, Reflectance::kMicrofacet);
  double worst_in_out = 0;
  for (const Grid& grid : {halfdiff3d(9, 8, 10), halfdiff4d(5, 4, 6, 8), inout(4, 6, 4, 6)}) {
    // In/out points interpolate their weights, to 1e-12, and not in the same pieces for all parts.
    const double rounding = grid.kind == GridKind::kInOut ? 1e-12 : 4e-16;
    std::vector<Table> tables;
    for (const Effects& effects :
         {Effects{}, Effects{true, false, false}, Effects{false, true, false},
          Effects{false, false, true}, Effects{true, true, false}}) {
      tables.push_back(collect(*make_producer(material_spec(material, effects, grid), 1), 1));
    }
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      const double total = tables[0].value(cell, 1);
      const double all =
          tables[1].value(cell, 1) + tables[2].value(cell, 1) + tables[3].value(cell, 1);
      const double two = tables[4].value(cell, 1) + tables[3].value(cell, 1);
      CHECK(std::abs(all - total) <= rounding * total);
      CHECK(std::abs(two - total) <= rounding * total);
      if (grid.kind == GridKind::kInOut && total > 0) {
        worst_in_out = std::max(worst_in_out, std::abs(all / total - 1));
      }
    }
  }
  std::cout << "in/out components against their total: worst " << worst_in_out << '\n';
}

TEST_CASE("a non-reciprocal table that stops at 180 degrees holds the mean of both orders") {
  RandomInputs random(seed_from_environment());
  const Material material = random_material(random, Reflectance::kPaper);
  const Table folded =
      collect(*make_producer(material_spec(material, {}, halfdiff3d(5, 6, 4, 180)), 1), 1);
  const Table whole =
      collect(*make_producer(material_spec(material, {}, halfdiff3d(5, 6, 8, 360)), 1), 1);
  int compared = 0;
  for (std::size_t row = 0; row < 30; ++row) {
    for (std::size_t p = 0; p < 4; ++p) {
      const double mean = (whole.value(row * 8 + p, 2) + whole.value(row * 8 + p + 4, 2)) / 2;
      CHECK(relative_error(folded.value(row * 4 + p, 2), mean) <= 1e-14);
      if (mean > 0) ++compared;
    }
  }
  CHECK(compared > 30);
}

TEST_CASE("the same bits for any number of threads and any grouping of rows") {
  RandomInputs random(seed_from_environment());
  const Material material = random_material(random, Reflectance::kMicrofacet);
  for (const auto& [grid, cells] :
       {std::pair{halfdiff3d(30, 20, 40), CellRule{}},
        std::pair{halfdiff4d(9, 8, 10, 12), CellRule{}}, std::pair{inout(5, 12, 5, 12), CellRule{}},
        std::pair{halfdiff3d(7, 6, 8), CellRule{true, 1e-3}}}) {
    const TableSpec spec = material_spec(material, {}, grid, cells, true);
    const Table one = collect(*make_producer(spec, 1), 1);
    const Table three = collect(*make_producer(spec, 3), 3);
    CHECK(std::equal(one.values().begin(), one.values().end(), three.values().begin(),
                     three.values().end()));
    std::vector<double> row(spec.row_values());
    make_producer(spec, 1)->fill_rows(spec.row_count() - 1, row);
    CHECK(std::equal(row.begin(), row.end(),
                     one.values().end() - static_cast<std::ptrdiff_t>(row.size())));
  }
}

TEST_CASE("a producer answers any pairs, listed or asked for, with the model's own values") {
  RandomInputs random(seed_from_environment());
  const Material material = random_material(random, Reflectance::kMicrofacet);
  const ClothModel<double> model(material);
  std::vector<DirectionPair> pairs;
  for (int n = 0; n < 50; ++n) pairs.push_back(random.pair());
  const Table table = collect(*make_producer(material_spec(material, {}, PairList{pairs}), 1), 1);
  const auto any = make_producer(material_spec(material, {}, AnyPairs{}), 1);
  std::vector<double> asked(3);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Directions d = table.spec().directions(p);
    any->fill_pairs(std::span(&d, 1), asked);
    const PairGeometry<double> g = pair_geometry(pairs[p], material.rotation_deg);
    const Components f = model.evaluate(g);
    // Narrow lobes magnify the rounding of the vectors.
    const double rounding = 1e-11 / (narrowest_axis(model) * std::max(g.cos_theta_d, 1e-3));
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(asked[c] == table.value(p, c));
      CHECK(std::abs(asked[c] - f.total(c)) <= rounding * f.total(c));
    }
  }
}

TEST_CASE("isotropic pairs hold the mean over rotations of the cloth") {
  RandomInputs random(seed_from_environment());
  double worst = 0;
  for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
    for (int n = 0; n < 10; ++n) {
      const Material material = random_material(random, reflectance);
      const ClothModel<double> model(material);
      const auto mean = make_producer(material_spec(material, {}, AnyPairs{true}), 1);
      for (int k = 0; k < 10; ++k) {
        const DirectionPair pair = random.pair();
        const Directions d = {direction(pair.theta_i, pair.phi_i),
                              direction(pair.theta_o, pair.phi_o)};
        std::vector<double> closed(3);
        mean->fill_pairs(std::span(&d, 1), closed);
        double sum = 0;
        constexpr int kTurns = 720;
        for (int turn = 0; turn < kTurns; ++turn) {
          sum += model.evaluate(pair_geometry(pair, 360.0 * turn / kTurns)).total(1) / kTurns;
        }
        worst = std::max(worst, relative_error(closed[1], sum));
      }
    }
  }
  std::cout << "closed means over rotations: worst relative error " << worst << '\n';
  CHECK(worst <= 1e-10);
}

TEST_CASE("a table that cannot be made is refused before any work") {
  RandomInputs random(seed_from_environment());
  Material material = random_material(random, Reflectance::kPaper);
  const CellRule average{.average = true};
  CHECK_THROWS_AS(make_producer(material_spec(material, {}, halfdiff3d(), average), 1), InputError);
  TableSpec spec = material_spec(material, {}, halfdiff3d());
  spec.channels.push_back({"fourth", Part::kTotal, 3});
  CHECK_THROWS_AS(make_producer(spec, 1), InputError);
  spec.provenance.material.reset();
  CHECK_THROWS_AS(make_producer(spec, 1), InputError);
  material.warp.scatter = 2;
  CHECK_THROWS_AS(make_producer(material_spec(material, {}, halfdiff3d()), 1),
                  std::invalid_argument);
}

TEST_CASE("what all rows share is given up, too, once the work is cancelled") {
  RandomInputs random(seed_from_environment());
  const Material material = random_material(random, Reflectance::kMicrofacet);
  for (const Grid& grid : {halfdiff3d(), inout()}) {
    for (const bool average : {false, true}) {
      Progress progress;
      const Workers workers(2, &progress);
      progress.cancel();
      const TableSpec spec = material_spec(material, {}, grid, {.average = average});
      std::vector<double> row(spec.row_values());
      CHECK_THROWS_AS(make_producer(spec, workers)->fill_rows(0, row), Cancelled);
    }
  }
}

}  // namespace clothbrdf::test
