#include "cost/nodes.h"

#include <random>

#include "cost/prediction.h"
#include "formats/table_metadata.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

struct Chosen {
  std::unique_ptr<Producer> model;
  Exact exact;
  ChosenNodes nodes;
};

Chosen chosen(const Material& material, bool isotropic) {
  auto model = make_producer(material_spec(material, {}, AnyPairs{isotropic}), 1);
  Exact exact = exact_values(*model, 20000, 1, 1);
  ChosenNodes nodes(*model, exact.sampled, exact.values, Metric::kRms, 1);
  return {std::move(model), std::move(exact), std::move(nodes)};
}

double rms(const Chosen& c, const Grid& grid) {
  return error_of(PointCells(*c.model, grid, Reader::kInterpolated, {}), c.exact, 1).rms;
}

}  // namespace

TEST_CASE("chosen nodes ascend from end to end and are as many as asked for") {
  for (const char* name : {"silk", "cotton", "tamamushi", "silk_paper"}) {
    for (const bool isotropic : {false, true}) {
      const Material material = read_material(preset(name));
      const Chosen c = chosen(material, isotropic);
      const std::vector<int> sizes = isotropic ? std::vector{5, 9, 2} : std::vector{5, 4, 9, 2};
      const Grid grid = c.nodes.grid(sizes);
      REQUIRE(grid.axes.size() == sizes.size());
      for (std::size_t a = 0; a < sizes.size(); ++a) {
        const Axis& axis = grid.axes[a];
        INFO(name << ' ' << axis.name);
        CHECK(axis.size == sizes[a]);
        REQUIRE(axis.listed_deg.size() == static_cast<std::size_t>(sizes[a]));
        CHECK(axis.listed_deg.front() == axis.lowest_deg);
        CHECK(axis.listed_deg.back() == (axis.mirrored ? axis.highest_deg : 88));
        // The grazing angles at which no error is counted do not spoil those before.
        CHECK((axis.mirrored || std::find(axis.listed_deg.begin(), axis.listed_deg.end(), 85.0) !=
                                    axis.listed_deg.end()));
        CHECK(std::is_sorted(axis.listed_deg.begin(), axis.listed_deg.end()));
      }
      const bool paper = material.reflectance == Reflectance::kPaper;
      CHECK(grid.folds_orders() != paper);
    }
  }
}

TEST_CASE("the nodes for an error come near to it, and err less the more they are") {
  for (const char* name : {"silk", "tamamushi"}) {
    for (const bool isotropic : {false, true}) {
      const Chosen c = chosen(read_material(preset(name)), isotropic);
      double before = 1e9;
      for (const double wanted : {0.01, 0.003}) {
        const double reached = rms(c, c.nodes.grid(c.nodes.sizes(wanted)));
        INFO(name << ", wanted " << wanted << ", reached " << reached);
        CHECK(reached < 1.5 * wanted);
        CHECK(reached > 0.5 * wanted);
        CHECK(reached < before);
        before = reached;
      }
    }
  }
}

// The same axes, uniform between the same ends: what is left of the gain is the density alone.
TEST_CASE("chosen nodes err less than uniform ones between the same ends") {
  const Chosen c = chosen(read_material(preset("silk")), false);
  const std::vector<int> sizes = c.nodes.sizes(0.005);
  const Grid grid = c.nodes.grid(sizes);
  Grid even = grid;
  for (Axis& axis : even.axes) {
    for (int k = 0; k < axis.size; ++k) {
      axis.listed_deg[static_cast<std::size_t>(k)] =
          axis.lowest_deg + (axis.mirrored ? 90 : 88) * k / (axis.size - 1.0);
    }
  }
  const double ratio = rms(c, even) / rms(c, grid);
  INFO("uniform nodes err " << ratio << " times as much");
  CHECK(ratio > 2);
}

TEST_CASE("the description of chosen nodes is read again, whatever the rotation of the weave") {
  Material silk = read_material(preset("silk"));
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> rotation(-720, 720);
  std::vector<double> rotations = {30.1, -30.1, 89.99999999999999, 1e18, -1e300, 5e-324, -5e-324};
  for (int k = 0; k < 100; ++k) rotations.push_back(rotation(engine));
  const SampledPairs sampled = sampled_pairs(100, 1);
  for (const double turn : rotations) {
    silk.rotation_deg = turn;
    const auto model = make_producer(material_spec(silk, {}, AnyPairs{}), 1);
    std::vector<double> exact(3 * sampled.pairs.size());
    model->fill_pairs(sampled.pairs, exact);
    const ChosenNodes nodes(*model, sampled, exact, Metric::kRms, 1);
    const TableSpec spec = material_spec(silk, {}, nodes.grid(std::vector{3, 4, 5, 3}));
    INFO("seed 3, rotation " << turn);
    CHECK(parse_table_metadata(table_metadata(spec), "t.exr") == spec);
  }
}

TEST_CASE("axes begin where the weave lies") {
  Material silk = read_material(preset("silk"));
  for (const auto& [rotation, from] :
       std::vector<std::pair<double, double>>{{0, 0}, {30, 30}, {100, 10}, {-20, 70}}) {
    silk.rotation_deg = rotation;
    const Chosen c = chosen(silk, false);
    const Axis phi_h = c.nodes.grid(std::vector{3, 3, 3, 3}).axes[1];
    INFO(rotation);
    CHECK(phi_h.lowest_deg == from);
    CHECK(phi_h.highest_deg == from + 90);
    // As good as the cloth that is not turned.
    CHECK(rms(c, c.nodes.grid(c.nodes.sizes(0.01))) < 0.015);
  }
}

}  // namespace clothbrdf::test
