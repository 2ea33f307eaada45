#include "bench/fit_bench.h"

#include <benchmark/benchmark.h>

#include "fit/misfit.h"
#include "fit/solve.h"
#include "fit/table_values.h"
#include "formats/material_json.h"
#include "table/table.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

void fit_merl(benchmark::State& state, bool reduce) {
  const Material truth = read_material(CLOTHBRDF_SOURCE_DIR "/materials/tamamushi.json");
  const Table table = collect(*make_producer(material_spec(truth, {}, halfdiff3d()), 1), 1);
  const Observations observations = observe(table.spec(), truth.reflectance, 1);
  const ValueSource source = table_values(table, observations);
  const ParameterSet set({}, truth.channel_count(), false);
  Material start = truth;
  start.warp.lobe_axes[0] *= 1.1;
  start.weft.scatter *= 0.9;
  start.warp_fraction *= 0.9;
  constexpr SolveLimits kLimits{.iterations = 10};
  for (auto _ : state) {
    const Rows rows = make_rows(observations, source, {}, nullptr, reduce, 1);
    const Misfit misfit(observations, rows, kExact, 1);
    benchmark::DoNotOptimize(solve(misfit, set, start, kLimits, 1));
  }
}

}  // namespace

void register_fit_benchmarks() {
  for (const bool reduce : {true, false}) {
    benchmark::RegisterBenchmark(reduce ? "fit/reduced_rows" : "fit/all_cells", fit_merl, reduce)
        ->UseRealTime()
        ->Iterations(1)
        ->Repetitions(3)
        ->DisplayAggregatesOnly()
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace clothbrdf
