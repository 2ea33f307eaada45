#include "cost/verified.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

constexpr double kTolerance = 0.003;

FileOrder silk_order(const TemporaryFolder& folder) {
  return {read_material(preset("silk")), {}, false, find_format("silk.exr"), {}, false,
          (folder / "silk.exr").string()};
}

// Axes of n cells even in angle, or squared in theta_h as MERL's; the other angles over the whole
// range or over what symmetry leaves.
Grid even_grid(const std::array<int, 4>& n, bool squared, bool mirrored) {
  Grid grid = halfdiff4d(n[0], n[1], n[2], n[3]);
  if (!squared) {
    grid.axes[0].spacing = Spacing::kUniform;
  }
  for (const std::size_t phi : {std::size_t{1}, std::size_t{3}}) {
    if (!mirrored) continue;
    grid.axes[phi].highest_deg = 90;
    grid.axes[phi].periodic = false;
    grid.axes[phi].mirrored = true;
  }
  return grid;
}

}  // namespace

// Every setting that is tried has at most 1 / 1.5 of the chosen file's bytes; none may meet the
// tolerance. Errors are those of 40,000 pairs, within about 4 %, so the bound is tried at 1.04 of
// it.
TEST_CASE("no setting found by brute force is 1.5 times smaller than the chosen one") {
  const TemporaryFolder folder;
  const FileOrder order = silk_order(folder);
  const VerifiedSetting chosen = choose_verified(order, {.tolerance = kTolerance}, 2);
  CHECK(chosen.error.error.rms <= kTolerance);
  const Table table = written_and_read(order, chosen.setting, 2);
  const PairModel model(order, false, 2);
  const Exact others = exact_values(model.get(), 200000, 991, 2);
  const double fresh = error_of(table, Reader::kInterpolated, others, 2).rms;
  CHECK(fresh <= 1.03 * kTolerance);  // the noise of either measurement is 2 %

  const auto bytes = [](const Grid& grid, bool half) {
    return static_cast<double>(grid.cell_count() * 3 * (half ? 2 : 4));
  };
  const double chosen_bytes =
      bytes(std::get<Grid>(chosen.setting.samples), chosen.setting.options.half);
  const Exact exact = exact_values(model.get(), 40000, 5, 2);
  const ChosenNodes nodes(model.get(), exact.sampled, exact.values, Metric::kRms, 2);
  std::size_t tried = 0;
  double least_error = 1;
  std::string best;
  const auto attempt = [&](const Grid& grid) {
    const StoredPrecision half = {0x1p-11, 0x1p-24};
    // Not much smaller ones: they would err more still.
    if (bytes(grid, true) > chosen_bytes / 1.5 || bytes(grid, true) < chosen_bytes / 4) return;
    ++tried;
    const double rms =
        error_of(PointCells(model.get(), grid, Reader::kInterpolated, half), exact, 2).rms;
    if (rms < least_error) {
      least_error = rms;
      best = grid.sizes();
    }
  };
  // About the chosen sizes, all four axes on their own.
  const Grid& centre = std::get<Grid>(chosen.setting.samples);
  for (const double a : {0.6, 0.8, 1.0, 1.2}) {
    for (const double b : {0.6, 0.8, 1.0, 1.2}) {
      for (const double c : {0.6, 0.8, 1.0, 1.2}) {
        for (const double d : {0.6, 0.8, 1.0, 1.2}) {
          const std::array<double, 4> scale = {a, b, c, d};
          std::array<int, 4> sizes{};
          for (std::size_t k = 0; k < 4; ++k) {
            sizes[k] = std::max(2, static_cast<int>(std::lround(scale[k] * centre.axes[k].size)));
          }
          attempt(nodes.grid(sizes));
          attempt(even_grid(sizes, true, true));
        }
      }
    }
  }
  for (const int n : {15, 20, 25, 30, 35}) {
    for (const bool squared : {false, true}) {
      attempt(even_grid({n, n, n, n}, squared, false));
      attempt(even_grid({n, n / 2, 2 * n, n / 2}, squared, true));
    }
  }
  WARN(tried << " settings of at most 1/1.5 of " << chosen_bytes / 1e6 << " MB; the best, " << best
             << ", errs " << least_error << " rms; on fresh pairs the chosen one errs " << fresh);
  CHECK(tried > 150);
  CHECK(least_error > 1.04 * kTolerance);
}

TEST_CASE("chosen nodes need three times fewer cells than axes uniform in angle") {
  const TemporaryFolder folder;
  const FileOrder order = silk_order(folder);
  const PairModel model(order, false, 2);
  const Exact exact = exact_values(model.get(), 60000, 6, 2);
  const auto rms = [&](const Grid& grid) {
    return error_of(PointCells(model.get(), grid, Reader::kInterpolated, {}), exact, 2).rms;
  };
  const ChosenNodes nodes(model.get(), exact.sampled, exact.values, Metric::kRms, 2);
  for (const bool mirrored : {false, true}) {
    const std::array<int, 4> sizes = {90, mirrored ? 36 : 72, 90, mirrored ? 23 : 45};
    const Grid uniform = even_grid(sizes, false, mirrored);
    const double wanted = rms(uniform);
    double aim = wanted;
    Grid grid = nodes.grid(nodes.sizes(aim));
    for (int trial = 0; trial < 8 && rms(grid) > wanted; ++trial) {
      aim *= 0.95;
      grid = nodes.grid(nodes.sizes(aim));
    }
    const double fewer =
        static_cast<double>(uniform.cell_count()) / static_cast<double>(grid.cell_count());
    WARN(grid.sizes() << " for " << uniform.sizes() << (mirrored ? ", mirrored" : "") << ": "
                      << fewer << " times fewer cells, rms " << rms(grid) << " and " << wanted);
    CHECK(rms(grid) <= wanted);
    CHECK(fewer >= 3);
  }
}

}  // namespace clothbrdf::test
