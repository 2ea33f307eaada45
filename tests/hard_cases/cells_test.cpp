#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "formats/format.h"
#include "support/errors.h"
#include "table/reading.h"
#include "tabulate/batch.h"
#include "tabulate/batch_kernel.h"
#include "tabulate/model_producer.h"
#include "tabulate/precision_check.h"
#include "tests/catch.h"
#include "tests/hard_cases/accuracy_table.h"
#include "tests/hard_cases/hard_materials.h"
#include "tests/hard_cases/trapped.h"
#include "tests/reference/reference_model.h"
#include "tests/support/lobe_condition.h"
#include "tests/support/make_table.h"
#include "tests/support/part_of.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

// Grids of one cell, and of a few, where most cells are the first or the last one of an axis.
std::vector<Grid> small_grids() {
  return {halfdiff3d(1, 1, 1),    halfdiff3d(2, 2, 2),    halfdiff3d(3, 2, 3, 360),
          halfdiff4d(1, 1, 1, 1), halfdiff4d(2, 2, 2, 2), halfdiff4d(2, 3, 2, 3, 360),
          inout(1, 1, 1, 1),      inout(2, 3, 2, 3)};
}

/// f_r of a cell's node: by the reference in 50 digits where it takes the grid's angles, else by
/// the model from vectors.
double exact_value(const Material& material, const Grid& grid, std::size_t cell,
                   const Channel& channel) {
  const std::array<int, 4> index = grid.indices(cell);
  const auto node = [&](std::size_t axis) { return grid.axes[axis].node_deg(index[axis]); };
  if (grid.kind == GridKind::kHalfDifference4d) {
    const Directions d = grid.directions(cell);
    return part_of(
        ClothModel<double>(material).evaluate(pair_geometry(d.wi, d.wo, material.rotation_deg)),
        channel);
  }
  const ReferenceValues values =
      grid.kind == GridKind::kInOut
          ? reference_values(material, {node(0), node(1), node(2), node(3)})
          : reference_azimuthal_mean(material, node(0), node(1), node(2));
  const ReferenceComponents& f = values.of(material.reflectance, material.paths);
  return static_cast<double>(f.specular[channel.colour] + f.internal[channel.colour] +
                             f.diffuse[channel.colour]);
}

/// Whether the mean over the azimuth takes the reference seconds; of others it takes minutes.
bool quick_to_integrate(const Material& material) {
  return material.warp.layers <= 6 && material.warp.scatter > 1e-9;
}

struct CellErrors {
  double relative = 0;
  double share = 0;  ///< of what is promised
  long compared = 0;
};

/// The first cell, the last one and some between, against the exact values.
void check_cells(const Material& material, const Grid& grid, CellErrors& worst) {
  const TableSpec spec = material_spec(material, {}, grid);
  const Table table = [&] {
    const Trapped trapped;
    return collect(*make_producer(spec, 1), 1);
  }();
  // 50 digits take their time.
  const std::size_t stride = (grid.cell_count() + 3) / 4;
  std::set<std::size_t> cells = {grid.cell_count() - 1};
  for (std::size_t cell = 0; cell < grid.cell_count(); cell += stride) cells.insert(cell);
  for (const std::size_t cell : cells) {
    if (!table.valid(cell)) continue;
    const Directions d = grid.directions(cell);
    const double cos_theta_d = pair_geometry(d.wi, d.wo, material.rotation_deg).cos_theta_d;
    const double promised =
        1e-13 + std::numeric_limits<double>::epsilon() * 4 * lobe_condition(material, cos_theta_d);
    for (const std::size_t c : {std::size_t{0}, spec.channels.size() - 1}) {
      const double exact = exact_value(material, grid, cell, spec.channels[c]);
      const double value = table.value(cell, c);
      ++worst.compared;
      // Parts of it can be subnormal.
      const bool tiny = exact < 1e-290;
      if (tiny) CHECK((value >= 0 && value <= 2e-290));
      const double relative = tiny ? 0 : std::abs(value / exact - 1);
      const double share = relative / promised;
      INFO(grid.description() << " at " << grid.place(cell) << ": " << value << " for " << exact);
      if (!(share <= 1)) CHECK(share <= 1);
      worst.relative = std::max(worst.relative, relative);
      worst.share = std::max(worst.share, share);
    }
  }
}

}  // namespace

TEST_CASE("grids of one cell, and first and last cells of others, hold hard materials exactly") {
  std::vector<std::string> rows;
  for (const Grid& grid : small_grids()) {
    CellErrors worst;
    for (HardMaterial& hard : hard_materials()) {
      Material& material = hard.material;
      // Beyond its 100 digits the reference cannot reduce angles.
      material.rotation_deg = std::remainder(material.rotation_deg, 360);
      if (grid.kind == GridKind::kHalfDifference3d && !quick_to_integrate(material)) continue;
      INFO(hard.name);
      check_cells(material, grid, worst);
    }
    CHECK(worst.compared > 50);
    std::ostringstream row;
    row << "| " << grid.description() << " | " << std::setprecision(2) << worst.relative << " | "
        << std::ceil(100 * worst.share) << " % | " << worst.compared << " |\n";
    std::cout << row.str() << std::flush;
    rows.push_back(row.str());
  }
  check_or_write_rows("| grid |", rows);
}

TEST_CASE("at the ends of every axis and across its seam a pair finds the cell next to it") {
  for (const Grid& grid : small_grids()) {
    INFO(grid.description());
    const Table table = plain_table(grid, [](std::size_t cell) { return 1.0 + double(cell); });
    const auto highest = static_cast<double>(grid.cell_count());
    for (std::size_t a = 0; a < grid.axes.size(); ++a) {
      const Axis& axis = grid.axes[a];
      const double end = axis.highest_deg;
      if (axis.periodic) {
        CHECK(axis.cell_of(end) == axis.cell_of(0));
        CHECK(axis.cell_of(-1e-9) == axis.cell_of(end - 1e-9));
        CHECK(axis.cell_of(std::nextafter(end, 0)).has_value());
        CHECK(axis.cell_of(-5e-324).has_value());
        for (int k = 0; k < axis.size; ++k) {
          CHECK(axis.cell_of(axis.node_deg(k) + 3 * end) == k);
          CHECK(axis.cell_of(axis.node_deg(k) - 3 * end) == k);
        }
      } else {
        CHECK(axis.cell_of(0) == 0);
        CHECK(axis.cell_of(5e-324) == 0);
        if (axis.spacing != Spacing::kNodes) CHECK(axis.cell_of(end) == axis.size - 1);
      }
    }
    std::vector<Directions> pairs;
    for (const double theta_i : {0.0, 1e-300, 1e-9, 45.0, 89.99999999999999}) {
      for (const double theta_o : {0.0, 1e-9, 45.0, 89.99999999999999}) {
        for (const double phi_i :
             {0.0, 5e-324, 1e-15, 179.99999999999997, 180.0, 359.99999999999994}) {
          for (const double phi_o : {0.0, 90.0, 180.0, 359.99999999999994}) {
            pairs.push_back({direction(theta_i, phi_i), direction(theta_o, phi_o)});
          }
        }
      }
    }
    for (const Reader reader : {Reader::kNearest, Reader::kInterpolated}) {
      long found = 0;
      const Trapped trapped;
      for (const double value : read_pairs(table, reader, pairs, 1)) {
        // 0: outside the grid, or nothing around but cells below the horizon.
        const bool allowed = value == 0 || ((value >= 1 - 1e-12 && value <= highest * (1 + 1e-12)));
        INFO(value);
        if (!allowed) CHECK(allowed);
        if (value > 0) ++found;
      }
      CHECK(found > 0);
    }
  }
}

TEST_CASE("half floats overflow by name, and underflow to less than 6e-8 of what was there") {
  const TemporaryFolder folder;
  const Grid grid = inout(1, 4, 2, 2);
  constexpr double kValues[] = {65504,   65503.9,   6.2e-5, 6.097555e-5, 6e-8, 5.9604645e-8,
                                2.98e-8, 2.9803e-8, 1e-8,   1e-300,      0,    5e-324};
  const Table table =
      plain_table(grid, [&](std::size_t cell) { return kValues[cell % std::size(kValues)]; });
  write_table(table, folder / "t.exr", {.half = true});
  const Table back = read_table(folder / "t.exr");
  double worst = 0;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    const double value = table.value(cell, 0);
    const double error = std::abs(back.value(cell, 0) - value);
    CHECK(error <= std::max(0x1p-11 * value, 0x1p-25 * (1 + 1e-7)));
    CHECK(back.value(cell, 0) >= 0);
    if (value < 6e-5) worst = std::max(worst, error);
  }
  std::cout << "half floats: underflow loses " << worst << " at most\n";
  for (const double high : {65504.001, 65519.0, 65520.0, 1e300}) {
    CHECK_THROWS_AS(write_table(with_value(table, 3, 0, high), folder / "t.exr", {.half = true}),
                    WorkError);
  }
  CHECK(read_table(folder / "t.exr").values()[0] == 65504);
}

namespace {

/// Of all materials, the worst share of what the batches of one kernel promise.
template <class T>
double worst_of_kernel(std::size_t target, long& compared) {
  constexpr double kSmallest = sizeof(T) == sizeof(float) ? 1e-36 : 1e-290;
  constexpr double kLargest = sizeof(T) == sizeof(float) ? 1e37 : 1e300;
  double worst = 0;
  for (const HardMaterial& hard : hard_materials()) {
    const Material& material = hard.material;
    const ClothModel<double> model(material);
    const std::vector<Channel> channels = material_channels(material, true);
    BatchEvaluator<T> evaluator(model, channels, 1);
    evaluator.choose_target(target);
    for (const DirectionPair& pair : hard_pairs(material)) {
      // Volatile: g++ 12 leaves out the rounding of neighbours that it puts into one vector.
      std::array<volatile T, 6> rounded{};
      const Vector3<double> wi = direction(pair.theta_i, pair.phi_i);
      const Vector3<double> wo = direction(pair.theta_o, pair.phi_o);
      for (std::size_t k = 0; k < 3; ++k) {
        rounded[k] = static_cast<T>(wi[k]);
        rounded[3 + k] = static_cast<T>(wo[k]);
      }
      std::array<T, 6> at{};
      std::copy(rounded.begin(), rounded.end(), at.begin());
      std::vector<T> values(channels.size());
      std::vector<T*> to;
      for (T& value : values) to.push_back(&value);
      {
        const Trapped trapped;
        evaluator.evaluate({{&at[0], &at[1], &at[2]}, {&at[3], &at[4], &at[5]}, 1}, to);
      }
      const PairGeometry<double> g = pair_geometry<double>(
          {at[0], at[1], at[2]}, {at[3], at[4], at[5]}, material.rotation_deg);
      const Components f = model.evaluate(g);
      const double magnified = lobe_condition(material, g.cos_theta_d);
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const double exact = part_of(f, channels[c]);
        if (!(exact < kLargest)) continue;
        ++compared;
        const auto value = double{values[c]};
        // The last two terms are the model's own, in doubles.
        const double promised = kBatchTolerance<T> * magnified + 3e-13 + 0x1p-51 * magnified;
        const double share = exact < kSmallest
                                 ? (value >= 0 && value <= 2 * kSmallest ? 0 : HUGE_VAL)
                                 : std::abs(value / exact - 1) / promised;
        INFO(hard.name << ", " << full_name(channels[c]) << ": " << value << " for " << exact);
        if (!(share <= 1)) CHECK(share <= 1);
        worst = std::max(worst, share);
      }
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("every width of vector registers keeps the batches' promise in every hard material") {
  for (std::size_t target = 0; target < batch_targets().size(); ++target) {
    long compared = 0;
    const double floats = worst_of_kernel<float>(target, compared);
    const double doubles = worst_of_kernel<double>(target, compared);
    std::cout << batch_targets()[target].name << ": worst share of the promise " << floats
              << " (float), " << doubles << " (double), of " << compared << " values\n";
    CHECK(compared > 10000);
    CHECK(floats > 0);
    CHECK(doubles > 0);
  }
}

}  // namespace clothbrdf::test
