#include "fit/observations.h"

#include <iostream>

#include "fit/misfit.h"
#include "fit/table_values.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/fit_cases.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

// Largest and root mean square difference of what is observed from a table, relative.
struct Difference {
  double worst = 0;
  double rms = 0;
  std::size_t values = 0;
};

Difference difference(const Table& table, const Material& material) {
  const Observations o = observe(table.spec(), material.reflectance, 1);
  const ModelValues fit = model_values(o, material, kExact, 1);
  const ValueSource source = table_values(table, o);
  Difference d;
  double square = 0;
  std::vector<double> values;
  for (std::size_t g = 0; g < o.groups.size(); ++g) {
    const Observations::Group& group = o.groups[g];
    values.resize(group.samples);
    for (std::size_t c = 0; c < o.channels; ++c) {
      source(g, c, values);
      for (std::size_t k = 0; k < group.samples; ++k) {
        double sum = 0;
        bool above = false;
        for (std::size_t s = 0; s < group.sites; ++s) {
          const double factor = o.factors[group.first_factor + s * group.samples + k];
          above = above || factor > 0;
          sum += factor * fit.site[(group.first_site + s) * o.channels + c];
        }
        if (!above) continue;
        const double error = (sum + fit.diffuse[c]) / values[k] - 1;
        ++d.values;
        square += error * error;
        if (!(std::abs(error) <= d.worst)) d.worst = std::abs(error);
      }
    }
  }
  d.rms = std::sqrt(square / static_cast<double>(d.values));
  return d;
}

}  // namespace

TEST_CASE("the fit's model values are those of tables, at every kind of point cell") {
  // Two ways to the same sums, each good to about 1e-13.
  constexpr double kPoints = 1e-12;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  for (int n = 0; n < soak_cases(24); ++n) {
    Material m = random_cloth(random, n % 4 == 0 ? 5 : 3, 8);
    m.reflectance = n % 2 == 0 ? Reflectance::kMicrofacet : Reflectance::kPaper;
    m.paths = n / 2 % 2 == 0 ? Paths::kAll : Paths::kSingle;
    if (n % 5 == 0) m.warp.layers = 0;
    if (n % 7 == 0) m.weft.scatter = n % 2;
    if (n % 6 == 0) m.weft.absorption[0] = 0;
    const Grid grid = n % 3 == 0   ? halfdiff3d(12, 10, 9)
                      : n % 3 == 1 ? halfdiff4d(8, 5, 6, 7, n % 2 == 0 ? 180 : 360)
                                   : inout(4, 6, 4, 6);
    const Difference d = difference(table_of(m, grid), m);
    INFO(grid.description() << " material " << n << " seed " << seed);
    CHECK(d.worst <= kPoints);
    CHECK(d.values > 100);
    worst = std::max(worst, d.worst);
  }
  std::cout << "fit's values against tables, points: worst " << worst << " (seed " << seed << ")\n";
}

TEST_CASE("the fit's values of averaged cells are those of tables to the quadrature's error") {
  // Measured on the presets: at most 1e-4, but where V-cavity shadow begins in a cell.
  constexpr double kRms = 5e-4;
  constexpr double kWorst = 2e-2;
  // Well below both; the tightest takes minutes.
  constexpr double kTable = 1e-5;
  const auto check = [&](const char* name, const Grid& grid) {
    const Material m = read_material(preset(name));
    const Difference d = difference(table_of(m, grid, {true, kTable}), m);
    std::cout << "fit's values against tables, averages, " << name << ' ' << grid.description()
              << ": rms " << d.rms << ", worst " << d.worst << '\n';
    CHECK(d.rms <= kRms);
    CHECK(d.worst <= kWorst);
  };
  check("silk", halfdiff3d(24, 24, 24));
  check("tamamushi", halfdiff3d(24, 24, 24));
  check("tamamushi", halfdiff4d(8, 6, 8, 6));
}

TEST_CASE("averaged cells are observed where the horizon does not cut them") {
  const Grid grid = halfdiff3d(12, 10, 8);
  const Observations o =
      observe({grid, {{"R", Part::kTotal, 0}}, {true, 1e-3}, {}}, Reflectance::kMicrofacet, 1);
  std::size_t seen = 0;
  for (const Observations::Group& group : o.groups) {
    for (std::size_t k = 0; k < group.samples; ++k) {
      if (!(o.factors[group.first_factor + k] > 0)) continue;
      ++seen;
      const std::array<int, 4> index = grid.indices(group.first_value + k);
      // The corners are above it, all of them.
      for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {
        const auto at = [&](std::size_t axis) {
          return sincosd(grid.axes[axis].edge_deg(index[axis] + (corner >> axis & 1)));
        };
        const IncidenceCosines<double> c = incidence_cosines(at(0), at(1), at(2).cos);
        CHECK(std::min(c.i, c.o) > 0);
      }
    }
  }
  CHECK(seen + o.below_horizon == grid.cell_count());
  CHECK(seen > grid.cell_count() / 2);
}

TEST_CASE("averages of the paper's convention are refused") {
  const TableSpec spec{halfdiff3d(4, 4, 4), {{"R", Part::kTotal, 0}}, {true, 1e-3}, {}};
  CHECK_THROWS_AS(observe(spec, Reflectance::kPaper, 1), InputError);
}

}  // namespace clothbrdf::test
