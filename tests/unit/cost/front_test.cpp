#include "cost/front.h"

#include <algorithm>
#include <cmath>

#include "cost/cells_ratio.h"
#include "cost/fidelity.h"
#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

CostSetting setting(const char* front, const char* name, double seconds, double rms) {
  CostSetting s;
  s.front = front;
  s.name = name;
  s.seconds = {seconds, seconds, seconds};
  s.error.rms = rms;
  return s;
}

CostSetting of_dial(const char* dial, CostSetting s, double size) {
  s.dial = dial;
  s.size = size;
  return s;
}

std::vector<std::string> names(const std::vector<CostSetting>& settings, bool pareto_only) {
  std::vector<std::string> all;
  for (const CostSetting& s : settings) {
    if (s.pareto || !pareto_only) all.push_back(s.name);
  }
  return all;
}

using Strings = std::vector<std::string>;

/// 4-D tables of rms = scale * step^2.
void add_tables(std::vector<CostSetting>& settings, const char* dial, double scale,
                std::initializer_list<double> sides, const char* stored = "half") {
  for (const double side : sides) {
    CostSetting s = setting("4-D", "", side, scale / (side * side));
    s.dial = dial;
    s.reader = "linear";
    s.stored = stored;
    s.size = std::pow(side, 4);
    settings.push_back(s);
  }
}

}  // namespace

TEST_CASE("a front has what nothing beats in time and error at once, and comes sorted") {
  std::vector<CostSetting> settings = {
      setting("evaluation", "best of all", 0.001, 0.0001),
      setting("4-D", "slow, exact", 9, 0.001),
      setting("4-D", "beaten", 3, 0.02),
      setting("4-D", "quick", 1, 0.05),
      setting("3-D", "alone", 5, 0.5),
      setting("4-D", "middle", 2, 0.02),
      setting("4-D", "as slow as the exact one", 9, 0.002),
      setting("4-D", "twin of quick", 1, 0.05),
  };
  mark_fronts(settings);
  CHECK(names(settings, false) == Strings{"alone", "quick", "twin of quick", "middle", "beaten",
                                          "slow, exact", "as slow as the exact one",
                                          "best of all"});
  CHECK(names(settings, true) ==
        Strings{"alone", "quick", "twin of quick", "middle", "slow, exact", "best of all"});
}

TEST_CASE("rotations have a front of their own") {
  std::vector<CostSetting> settings = {
      of_dial("paths", setting("evaluation", "paths", 1, 0), 0),
      of_dial("rotations", setting("evaluation", "two", 2, 0.5), 2),
      of_dial("rotations", setting("evaluation", "four", 4, 0.5), 4)};
  mark_fronts(settings);
  CHECK(names(settings, true) == Strings{"paths", "two"});
}

TEST_CASE("for each target the soonest setting is named, once, for the tightest it reaches") {
  std::vector<CostSetting> settings = {
      setting("4-D", "coarse", 0.0512, 0.009), setting("4-D", "fine", 3.25, 0.0029),
      setting("4-D", "finest", 1234, 0.0007), setting("3-D", "rough", 1, 0.2)};
  settings[0].bytes = 34'600'000;
  settings[2].bytes = 999'900;
  mark_fronts(settings);
  CHECK(sentences(settings) ==
        Strings{"3-D: no setting reaches 10 % rms; the best has 20 % (rough)",
                "4-D: 1 % rms costs 0.051 s and 35 MB (coarse)",
                "4-D: 0.3 % rms costs 3.3 s (fine)",
                "4-D: 0.1 % rms costs 1200 s and 1 MB (finest)",
                "4-D: no setting reaches 0.03 % rms; the best has 0.07 % (finest)"});
  CHECK(sentences({}).empty());
}

TEST_CASE("a front that reaches every target has no last sentence") {
  std::vector<CostSetting> settings = {setting("4-D", "exact", 2, 0.0003)};
  mark_fronts(settings);
  CHECK(sentences(settings) == Strings{"4-D: 0.03 % rms costs 2 s (exact)"});
}

TEST_CASE("what simpler models save is told against all paths") {
  std::vector<CostSetting> settings = {
      of_dial("paths", setting("evaluation", kAllPaths, 0.2, 0), 0),
      of_dial("paths", setting("evaluation", "single paths", 0.15, 0.023), 0),
      of_dial("layers kept", setting("evaluation", "1 of 3 layers kept", 0.22, 0.004), 1),
      of_dial("layers kept", setting("evaluation", "0 of 3 layers kept", 0.1, 0.3), 0),
      of_dial("layers kept", setting("evaluation", "2 of 3 layers kept", 0.196, 0.001), 2),
      of_dial("paths", setting("evaluation", "noisy paths", 0.17, 0.02), 0)};
  settings.back().seconds.highest = 0.2;
  mark_fronts(settings);
  CHECK(sentences(settings) ==
        Strings{"single paths in place of all paths saves 25 % of the time and costs 2.3 % rms",
                "noisy paths in place of all paths saves no time and costs 2 % rms",
                "0 of 3 layers kept: saves 50 % of the time and costs 30 % rms",
                "1 of 3 layers kept: takes 10 % more time and costs 0.4 % rms",
                "2 of 3 layers kept: saves no time and costs 0.1 % rms"});
}

TEST_CASE("chosen nodes are compared with uniform axes at an error that both reach") {
  std::vector<CostSetting> settings;
  CHECK_FALSE(chosen_nodes_ratio(settings));
  add_tables(settings, "uniform axes", 2, {40, 10, 20});
  CHECK_FALSE(chosen_nodes_ratio(settings));
  add_tables(settings, "uniform axes", 0.5, {10, 20, 40}, "float");
  add_tables(settings, "chosen nodes", 1, {10, 15, 30});
  const auto ratio = chosen_nodes_ratio(settings);
  REQUIRE(ratio);
  // cells = (scale / rms)^2
  CHECK(std::abs(ratio->times_fewer - 4) <= 1e-12);
  // Reached by both: from 1 / 100 down to 2 / 1600.
  CHECK(std::abs(ratio->rms / std::sqrt(0.01 * 0.00125) - 1) <= 1e-12);
  const Strings said = sentences(settings);
  CHECK(std::find(said.begin(), said.end(),
                  "4-D: chosen nodes need 4 times fewer cells than axes uniform in angle at 0.35 % "
                  "rms") != said.end());
  settings.clear();
  add_tables(settings, "uniform axes", 100, {10, 20});
  add_tables(settings, "chosen nodes", 1, {10, 20});
  CHECK_FALSE(chosen_nodes_ratio(settings));
}

}  // namespace clothbrdf::test
