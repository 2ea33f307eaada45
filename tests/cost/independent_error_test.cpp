
#include <algorithm>
#include <cmath>
#include <random>

#include "cost/file_order.h"
#include "cost/measure.h"
#include "cost/plan.h"
#include "cost/prediction.h"
#include "model/reflectance.h"
#include "support/threads.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

constexpr std::size_t kPairs = 1'000'000;
constexpr double kDegree = 3.14159265358979323846 / 180;

// Straight from the definition: pairs uniform on the hemisphere, f by the formulas of the model.
struct Uniform {
  std::vector<Directions> pairs;
  std::vector<double> cloth;  // [pair][channel]
  std::vector<double> mean;
};

Uniform uniform_pairs(const Material& material, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> share(0, 1);
  const double low = std::cos(85 * kDegree);
  const auto draw = [&] {
    const double cosine = low + (1 - low) * share(engine);
    const double phi = 360 * kDegree * share(engine);
    const double sine = std::sqrt(1 - cosine * cosine);
    return Vector3<double>{sine * std::cos(phi), sine * std::sin(phi), cosine};
  };
  Uniform uniform;
  for (std::size_t k = 0; k < kPairs; ++k) {
    const Vector3<double> wi = draw();
    uniform.pairs.push_back({wi, draw()});
  }
  const ClothModel<double> model(material, {});
  uniform.cloth.resize(3 * kPairs);
  with_threads(2, [&] {
    run_parallel(kPairs, 2, [&](std::size_t k) {
      const auto& [wi, wo] = uniform.pairs[k];
      const Components f = model.evaluate(pair_geometry(wi, wo, material.rotation_deg));
      for (std::size_t c = 0; c < 3; ++c) {
        uniform.cloth[3 * k + c] = channel_value(f, {"", Part::kTotal, c});
      }
    });
  });
  // In closed form; tests of its own hold it to means over rotations.
  uniform.mean.resize(3 * kPairs);
  fill_all_pairs(*make_producer(material_spec(material, {}, AnyPairs{true}), 2), 2, uniform.pairs,
                 uniform.mean);
  return uniform;
}

TableError plain_error(const Uniform& uniform, const std::vector<double>& f,
                       const std::vector<double>& read) {
  double mean = 0;
  for (const double value : f) mean += value / static_cast<double>(f.size());
  double squares = 0;
  double all = 0;
  std::vector<double> relative;
  for (std::size_t k = 0; k < f.size(); ++k) {
    const auto& [wi, wo] = uniform.pairs[k / 3];
    const double w = std::pow(wi[2] * wo[2], 2);
    squares += w * std::pow(read[k] - f[k], 2);
    all += w * f[k] * f[k];
    relative.push_back(std::abs(read[k] - f[k]) / (f[k] + 0.001 * mean));
  }
  const auto p99 = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() * 99 / 100);
  std::nth_element(relative.begin(), p99, relative.end());
  return {std::sqrt(squares / all), *p99, *std::max_element(relative.begin(), relative.end())};
}

// What a reader does, without read_pairs.
std::vector<double> plain_read(const Table& table, Reader reader,
                               const std::vector<Directions>& pairs) {
  std::vector<double> values(3 * pairs.size());
  with_threads(2, [&] {
    run_parallel(pairs.size(), 2, [&](std::size_t p) {
      if (reader == Reader::kInterpolated) {
        table.interpolate(pairs[p], std::span(values).subspan(3 * p, 3));
        return;
      }
      const auto cell = table.spec().grid().cell_of(pairs[p].wi, pairs[p].wo);
      for (std::size_t c = 0; cell && c < 3; ++c) values[3 * p + c] = table.value(*cell, c);
    });
  });
  return values;
}

}  // namespace

TEST_CASE("errors that cost states agree with a plain measurement on a million other pairs") {
  const Material silk = read_material(preset("silk"));
  const Uniform uniform = uniform_pairs(silk, 77);
  const TemporaryFolder folder;
  std::size_t settings = 0;
  double worst_rms = 0;
  double worst_p99 = 0;
  for (const bool isotropic : {true, false}) {
    const auto model = make_producer(material_spec(silk, {}, AnyPairs{isotropic}), 2);
    const Exact exact = exact_values(*model, kCostPairs, kCostSeed, 2);
    const ChosenNodes nodes(*model, exact.sampled, exact.values, Metric::kRms, 2);
    for (const PlannedFile& file : isotropic ? isotropic_files(nodes, silk.reflectance)
                                             : anisotropic_files(nodes, silk.reflectance)) {
      // Those that take longest to make or to read are left to `cost`.
      const Grid* const grid = std::get_if<Grid>(&file.samples);
      if (file.cells.average || (grid != nullptr && grid->cell_count() > 1'000'000)) continue;
      if (grid == nullptr && file.bytes != 3'000'000 && file.bytes != 5'000'000) continue;
      FileOrder order{silk,
                      {},
                      false,
                      find_format("x" + file.ending),
                      {.half = file.half},
                      isotropic,
                      (folder / ("x" + file.ending)).string()};
      if (file.bytes > 0) order.options.bytes = file.bytes;
      const Table table = written_and_read(order, {file.samples, file.cells, order.options}, 2);
      for (const Reader reader : file.readers) {
        const TableError stated = error_of(table, reader, exact, 2);
        const TableError plain = plain_error(uniform, isotropic ? uniform.mean : uniform.cloth,
                                             plain_read(table, reader, uniform.pairs));
        INFO((isotropic ? "3-D " : "4-D ")
             << file.dial << ' ' << table.spec().description() << ' ' << reader_name(table, reader)
             << ", seed 77: rms " << stated.rms << " and " << plain.rms << ", p99 " << stated.p99
             << " and " << plain.p99);
        CHECK(std::abs(stated.rms / plain.rms - 1) < 0.1);
        CHECK(std::abs(stated.p99 / plain.p99 - 1) < 0.1);
        worst_rms = std::max(worst_rms, std::abs(stated.rms / plain.rms - 1));
        worst_p99 = std::max(worst_p99, std::abs(stated.p99 / plain.p99 - 1));
        ++settings;
        // The same bits again, on one thread.
        CHECK(error_of(table, reader, exact, 1) == stated);
      }
    }
  }
  WARN(settings << " settings, differences up to " << 100 * worst_rms << " % of rms and "
                << 100 * worst_p99 << " % of p99");
  CHECK(settings >= 20);
}

}  // namespace clothbrdf::test
