// What it saves to leave effects and cells out: instructions and times of the same work with and
// without them; bench/effects.py says which limits the ratios have.
//
//   effects_bench count CASE [PLAN...]   runs a case once; callgrind counts just its work
//   effects_bench time [PLAN...]         seconds of all cases, taken in turns, and their names
//   effects_bench list [PLAN...]         the cases' names, one a line

#include <valgrind/callgrind.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "formats/material_json.h"
#include "formats/plan_json.h"
#include "model/degrees.h"
#include "model/reflectance.h"
#include "table/reached_cells.h"
#include "tabulate/batch.h"
#include "tabulate/model_producer.h"

namespace clothbrdf {
namespace {

// As many as a row of a table has, so that times are not those of the memory.
constexpr std::size_t kPairs = 4096;

/// Prepares a case; what it returns is the work.
using Prepare = std::function<std::function<void()>()>;

struct Case {
  std::string name;
  Prepare prepare;
};

/// Two different yarns of 6 layers and all paths: the most that an evaluation can cost.
Material whole_cloth() {
  Material material = read_material(CLOTHBRDF_SOURCE_DIR "/materials/tamamushi.json");
  material.paths = Paths::kAll;
  material.warp.layers = 6;
  material.weft.layers = 6;
  return material;
}

Effects effects_of(const std::vector<std::string>& words) {
  std::string problem;
  return *effects_from_words(words, problem);
}

const DirectionRange kAll = {{0, 90}, {0, 360}};

/// Pairs of a reach, spread by solid angle.
std::vector<Directions> pairs_of(const Reach& reach) {
  std::mt19937_64 generator(20260101);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  const auto any_of = [&](const auto& list) {
    return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(generator)];
  };
  const auto drawn = [&](const DirectionRange& range, double rotation_deg) {
    const double cosine =
        uniform(sincosd(range.theta_deg.high).cos, sincosd(range.theta_deg.low).cos);
    const double theta = std::acos(std::min(1.0, cosine)) * 180 / pi<double>();
    return direction(theta, uniform(range.phi_deg.low, range.phi_deg.high) - rotation_deg);
  };
  std::vector<Directions> pairs(kPairs);
  for (Directions& pair : pairs) {
    const double rotation = any_of(reach.rotations_deg);
    pair.wi = drawn(any_of(reach.lights), rotation);
    pair.wo = drawn(any_of(reach.eyes), rotation);
  }
  return pairs;
}

/// The batch evaluator in floats.
Prepare batch(const Material& material, const Effects& effects, const Reach& reach) {
  return [=] {
    struct State {
      State(const Material& material, const Effects& effects)
          : model(material, effects), evaluator(model, material_channels(material, false), 1) {}
      ClothModel<double> model;
      BatchEvaluator<float> evaluator;
      std::array<std::vector<float>, 6> in;
      std::vector<std::vector<float>> f;
    };
    const auto state = std::make_shared<State>(material, effects);
    for (const Directions& pair : pairs_of(reach)) {
      for (std::size_t k = 0; k < 3; ++k) {
        state->in[k].push_back(static_cast<float>(pair.wi[k]));
        state->in[3 + k].push_back(static_cast<float>(pair.wo[k]));
      }
    }
    state->f.assign(material.channel_count(), std::vector<float>(kPairs));
    return [state] {
      const auto& in = state->in;
      std::vector<float*> to;
      for (std::vector<float>& channel : state->f) to.push_back(channel.data());
      state->evaluator.evaluate({{in[0].data(), in[1].data(), in[2].data()},
                                 {in[3].data(), in[4].data(), in[5].data()},
                                 kPairs},
                                to);
    };
  };
}

/// All values of a table, as its writer takes them.
Prepare table(const Grid& grid, const std::optional<Reach>& reach) {
  return [=] {
    TableSpec spec = material_spec(whole_cloth(), {}, grid);
    spec.reach = reach;
    const std::shared_ptr<const Producer> producer = make_producer(spec, 1, Precision::kSingle);
    return [producer] { stream_rows(*producer, 1, [](std::size_t, std::span<double>) {}); };
  };
}

/// Light from a ring, an eye that walks a quarter of the way around: a tenth of the cells of
/// inout:24x96x24x96, with their margin.
Reach tenth() { return {{{{20, 40}, {0, 360}}}, {{{10, 90}, {0, 94}}}, {0}}; }

std::vector<Case> all_cases(const std::vector<std::string>& plans) {
  const Material whole = whole_cloth();
  const Reach everything = {{kAll}, {kAll}, {0}};
  std::vector<Case> cases = {{"full", batch(whole, {}, everything)}};
  for (const char* only : {"specular", "diffuse"}) {
    cases.push_back({std::string(only) + " only", batch(whole, effects_of({only}), everything)});
  }
  for (const char* word :
       {"no-colour", "no-near_side", "no-interreflection", "no-scatter", "no-second_yarn",
        "no-anisotropy", "no-shadowing", "no-fresnel_angle=0.8"}) {
    cases.push_back({word, batch(whole, effects_of({word}), everything)});
  }
  cases.push_back(
      {"internal:2", batch(whole, effects_of({"specular", "internal:2", "diffuse"}), everything)});
  for (const Grid& grid : {inout(24, 96, 24, 96), halfdiff3d()}) {
    cases.push_back({grid.sizes(), table(grid, std::nullopt)});
    cases.push_back({grid.sizes() + " reached", table(grid, tenth())});
  }
  for (const std::string& file : plans) {
    const Plan plan = read_plan(file);
    const MaterialPlan& first = plan.materials.front();
    const std::string name = std::filesystem::path(file).stem().string();
    cases.push_back({name + " whole", batch(first.material, {}, plan.reach)});
    cases.push_back({name + " planned", batch(first.material, first.effects, plan.reach)});
  }
  return cases;
}

void count(const std::vector<Case>& cases, const std::string& name) {
  const auto found =
      std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return c.name == name; });
  const std::function<void()> work = found->prepare();
  CALLGRIND_START_INSTRUMENTATION;
  work();
  CALLGRIND_STOP_INSTRUMENTATION;
}

void time(const std::vector<Case>& cases) {
  constexpr int kRounds = 21;
  std::vector<std::function<void()>> work;
  for (const Case& c : cases) work.push_back(c.prepare());
  std::vector<std::vector<double>> seconds(cases.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < work.size(); ++k) {
      // Once to have it in the caches, then for a millisecond and more.
      work[k]();
      int runs = 0;
      std::chrono::duration<double> taken{0};
      const auto start = std::chrono::steady_clock::now();
      for (; taken.count() < 1e-3; ++runs) {
        work[k]();
        taken = std::chrono::steady_clock::now() - start;
      }
      seconds[k].push_back(taken.count() / runs);
    }
  }
  for (std::size_t k = 0; k < cases.size(); ++k) {
    std::nth_element(seconds[k].begin(), seconds[k].begin() + kRounds / 2, seconds[k].end());
    std::cout << seconds[k][kRounds / 2] << ' ' << cases[k].name << '\n';
  }
}

}  // namespace
}  // namespace clothbrdf

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool counts = arguments.size() > 1 && arguments[0] == "count";
  const std::size_t first_plan = counts ? 2 : 1;
  const auto cases = clothbrdf::all_cases(
      {arguments.begin() + static_cast<std::ptrdiff_t>(std::min(first_plan, arguments.size())),
       arguments.end()});
  if (counts) {
    clothbrdf::count(cases, arguments[1]);
  } else if (!arguments.empty() && arguments[0] == "time") {
    clothbrdf::time(cases);
  } else {
    for (const auto& c : cases) std::cout << c.name << '\n';
  }
  return 0;
}
