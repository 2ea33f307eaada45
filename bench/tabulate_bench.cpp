// The kernels on one core, without files; bench/run says which limits they have. "cells" is a rate:
// cells, or pairs of directions, per second of processor time.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bench/fit_bench.h"
#include "bench/peak.h"
#include "formats/material_json.h"
#include "model/degrees.h"
#include "model/reflectance.h"
#include "table/producer.h"
#include "tabulate/batch.h"
#include "tabulate/batch_kernel.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

Material preset(const std::string& name) {
  return read_material(CLOTHBRDF_SOURCE_DIR "/materials/" + name + ".json");
}

/// Two different yarns of 6 layers, one reflection a path.
Material two_yarns() {
  Material material = preset("tamamushi");
  material.paths = Paths::kSingle;
  material.warp.layers = 6;
  material.weft.layers = 6;
  return material;
}

Material two_yarns_all() {
  Material material = two_yarns();
  material.paths = Paths::kAll;
  return material;
}

/// A rate of so many cells an iteration.
void count_cells(benchmark::State& state, std::size_t cells) {
  state.counters["cells"] = {static_cast<double>(cells),
                             benchmark::Counter::kIsIterationInvariantRate};
}

/// Directions uniform over the hemisphere.
std::vector<DirectionPair> random_pairs(std::size_t count) {
  std::mt19937_64 generator(20240501);
  std::uniform_real_distribution<double> cosine(0.0, 1.0);
  std::uniform_real_distribution<double> azimuth(0.0, 360.0);
  const auto theta = [&] { return std::acos(cosine(generator)) * 180.0 / pi<double>(); };
  std::vector<DirectionPair> pairs;
  for (std::size_t k = 0; k < count; ++k) {
    pairs.push_back({theta(), azimuth(generator), theta(), azimuth(generator)});
  }
  return pairs;
}

/// The model itself: what `eval` does for each pair, and the half vector that it needs.
void evaluate(benchmark::State& state, const Material& material) {
  const ClothModel<double> model(material);
  const std::vector<DirectionPair> pairs = random_pairs(1024);
  for (auto _ : state) {
    for (const DirectionPair& pair : pairs) {
      benchmark::DoNotOptimize(model.evaluate(pair_geometry(pair, material.rotation_deg)));
    }
  }
  count_cells(state, pairs.size());
}

/// Arrays of directions for the batch evaluator.
template <class T>
struct Batch {
  explicit Batch(std::size_t count) {
    for (const DirectionPair& pair : random_pairs(count)) {
      const Vector3<double> wi = direction(pair.theta_i, pair.phi_i);
      const Vector3<double> wo = direction(pair.theta_o, pair.phi_o);
      for (std::size_t k = 0; k < 3; ++k) {
        in[k].push_back(static_cast<T>(wi[k]));
        in[3 + k].push_back(static_cast<T>(wo[k]));
      }
    }
  }
  std::array<std::vector<T>, 6> in;
};

/// The batch evaluator, with one of batch_targets().
template <class T>
void batch(benchmark::State& state, const Material& material, std::size_t target) {
  const ClothModel<double> model(material);
  BatchEvaluator<T> evaluator(model, material_channels(material, false), 1);
  evaluator.choose_target(target);
  constexpr std::size_t kPairs = 4096;
  const Batch<T> pairs(kPairs);
  std::array<std::vector<T>, 3> f;
  std::array<T*, 3> to{};
  for (std::size_t c = 0; c < 3; ++c) {
    f[c].resize(kPairs);
    to[c] = f[c].data();
  }
  for (auto _ : state) {
    evaluator.evaluate({{pairs.in[0].data(), pairs.in[1].data(), pairs.in[2].data()},
                        {pairs.in[3].data(), pairs.in[4].data(), pairs.in[5].data()},
                        kPairs},
                       to);
    benchmark::DoNotOptimize(f);
    benchmark::ClobberMemory();
  }
  state.counters["multiply_adds"] = static_cast<double>(evaluator.multiply_adds());
  count_cells(state, kPairs);
}

/// Preparing a batch evaluator.
template <class T>
void batch_setup(benchmark::State& state, const Material& material) {
  const ClothModel<double> model(material);
  for (auto _ : state) {
    benchmark::DoNotOptimize(BatchEvaluator<T>(model, material_channels(material, false), 1));
  }
}

/// The machine's own limits: float multiply-adds, and bytes written to memory.
void peak_multiply_adds(benchmark::State& state) {
  constexpr std::size_t kSteps = 100000;
  for (auto _ : state) benchmark::DoNotOptimize(multiply_add_loop(kSteps));
  count_cells(state, kSteps * multiply_adds_a_step());
}

void peak_memory_writes(benchmark::State& state) {
  std::vector<char> memory(std::size_t{64} << 20U);
  char value = 0;
  for (auto _ : state) {
    std::memset(memory.data(), ++value, memory.size());
    benchmark::ClobberMemory();
  }
  count_cells(state, memory.size());
}

/// What all rows share.
void setup(benchmark::State& state, const TableSpec& spec) {
  for (auto _ : state) benchmark::DoNotOptimize(make_producer(spec, 1));
}

/// Every `step`-th row, one after the other into the same memory.
void rows(benchmark::State& state, const TableSpec& spec, std::size_t step) {
  const std::unique_ptr<Producer> producer = make_producer(spec, 1);
  std::vector<double> values(spec.row_values());
  for (auto _ : state) {
    for (std::size_t row = 0; row < spec.row_count(); row += step) {
      producer->fill_rows(row, values);
      benchmark::DoNotOptimize(values.data());
      benchmark::ClobberMemory();
    }
  }
  count_cells(state, (spec.row_count() + step - 1) / step * spec.column_count());
}

/// All that `tabulate` computes, as its writers ask for it.
void compute(benchmark::State& state, const TableSpec& spec, int threads, Precision precision) {
  for (auto _ : state) {
    stream_rows(*make_producer(spec, threads, precision), threads,
                [](std::size_t /*first_row*/, std::span<double> values) {
                  benchmark::DoNotOptimize(values.data());
                });
  }
  count_cells(state, spec.cell_count());
}

void register_all() {
  const Material silk = preset("silk");
  const CellRule average = {true, 1e-3};
  // With the time of all threads: work that strayed to another one would not be hidden.
  const auto add = [](const std::string& name, auto function, const auto&... arguments) {
    benchmark::RegisterBenchmark(name.c_str(), function, arguments...)
        ->MeasureProcessCPUTime()
        ->MinTime(0.1)
        ->Repetitions(5)
        ->DisplayAggregatesOnly()
        ->Unit(benchmark::kMicrosecond);
  };
  // `step` leaves 3 to 5 rows of the averages.
  const auto add_rows = [&](const std::string& name, const Material& material, const Grid& grid,
                            const CellRule& cells = {}, std::size_t step = 1) {
    add(name, rows, material_spec(material, {}, grid, cells), step);
  };
  const TableSpec merl = material_spec(silk, {}, halfdiff3d());
  add("evaluate/silk", evaluate, silk);
  add("evaluate/two_yarns_single", evaluate, two_yarns());
  add("setup/silk.binary", setup, merl);
  add_rows("rows/silk.binary", silk, halfdiff3d());
  add("compute/silk.binary", compute, merl, 1, Precision::kDouble);
  add_rows("rows/two_yarns_single.binary", two_yarns(), halfdiff3d());
  add_rows("rows/halfdiff4d", silk, halfdiff4d());
  add_rows("rows/inout", silk, inout());
  add_rows("average/silk.binary", silk, halfdiff3d(), average, 30);
  add_rows("average/halfdiff4d", silk, halfdiff4d(), average, 500);
  add_rows("average/inout", silk, inout(), average, 60);
  for (std::size_t target = 0; target < batch_targets().size(); ++target) {
    const std::string prefix = std::string("batch ") + batch_targets()[target].name;
    add(prefix + "/two_yarns_single", batch<float>, two_yarns(), target);
    add(prefix + "/two_yarns_all", batch<float>, two_yarns_all(), target);
  }
  add("batch/silk", batch<float>, silk, 0);
  add("batch_double/two_yarns_single", batch<double>, two_yarns(), 0);
  add("batch_double/silk", batch<double>, silk, 0);
  add("batch_setup/silk", batch_setup<float>, silk);
  add("batch_setup_double/silk", batch_setup<double>, silk);
  add("peak/multiply_adds", peak_multiply_adds);
  add("peak/memory_writes", peak_memory_writes);
  // Wall-clock time: what a second thread is for.
  const auto add_threads = [&](const std::string& name, const TableSpec& spec,
                               Precision precision) {
    for (const int threads : {1, 2}) {
      benchmark::RegisterBenchmark((name + "/" + std::to_string(threads)).c_str(), compute, spec,
                                   threads, precision)
          ->UseRealTime()
          ->MinTime(0.2)
          ->Repetitions(5)
          ->DisplayAggregatesOnly()
          ->Unit(benchmark::kMicrosecond);
    }
  };
  add_threads("threads_inout", material_spec(silk, {}, inout(24, 48, 24, 48)), Precision::kDouble);
  add_threads("threads_average", material_spec(silk, {}, inout(3, 6, 3, 6), average),
              Precision::kDouble);
}

}  // namespace
}  // namespace clothbrdf

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
#ifdef __clang__
  benchmark::AddCustomContext("compiler", __VERSION__);
#else
  benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
#endif
  clothbrdf::register_all();
  clothbrdf::register_fit_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
