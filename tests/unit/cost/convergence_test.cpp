#include "cost/convergence.h"

#include <array>
#include <cmath>

#include "cost/fit_line.h"
#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

constexpr double kFitted = 1e-12;  // exact laws, but for rounding

Material absorbing(double absorption) {
  Material material;
  material.weights = {1, 1, 0};
  material.warp.lobe_axes = {0.2, 0.5};
  material.warp.absorption = {absorption, 2};
  material.warp.layers = 6;
  material.warp.refractive_index = 1.5;
  material.weft = material.warp;
  material.weft.layers = 2;
  return material;
}

CostSetting table(const char* front, double cells, double rms, const char* reader = "linear") {
  CostSetting setting;
  setting.dial = "uniform axes";
  setting.front = front;
  setting.format = "EXR";
  setting.cells = "point";
  setting.stored = "float";
  setting.reader = reader;
  setting.size = cells;
  setting.error.rms = rms;
  return setting;
}

CostSetting evaluation(const char* dial, double size, double rms) {
  CostSetting setting;
  setting.dial = dial;
  setting.front = "evaluation";
  setting.size = size;
  setting.error.rms = rms;
  return setting;
}

std::vector<CostSetting> tables(const char* front, double dimensions, double order,
                                const char* reader = "linear") {
  std::vector<CostSetting> settings;
  for (const double side : {10.0, 15.0, 30.0, 70.0})
    settings.push_back(
        table(front, std::pow(side, dimensions), 3 * std::pow(side, -order), reader));
  return settings;
}

}  // namespace

TEST_CASE("a line is fitted by least squares") {
  const std::array<double, 3> x = {0, 1, 2};
  const std::array<double, 3> y = {1, 3, 2};
  CHECK(fitted_slope(x, y) == 0.5);
}

TEST_CASE("orders of grids are found in either dimension") {
  for (const auto& [front, dimensions] : {std::pair{"3-D", 3.0}, {"4-D", 4.0}}) {
    for (const double order : {1.0, 2.0, 0.5}) {
      const std::vector<Convergence> laws = convergence({}, tables(front, dimensions, order));
      REQUIRE(laws.size() == 1);
      CHECK(std::abs(laws[0].fitted - order) <= kFitted);
      CHECK(laws[0].expected == 2);
      CHECK(laws[0].law == "rms ~ step^order");
      CHECK(laws[0].dial == std::string(front) + " uniform axes, EXR, point, linear, float");
      CHECK(laws[0].differs == (order != 2));
      CHECK(laws[0].reason.empty() == (order == 2));
    }
  }
}

TEST_CASE("nearest cells are of first order, and what is off by more than 0.35 has a reason") {
  const auto law = [](double order, const char* reader) {
    const std::vector<Convergence> laws = convergence({}, tables("4-D", 4, order, reader));
    REQUIRE(laws.size() == 1);
    return laws[0];
  };
  CHECK(law(1, "nearest").expected == 1);
  CHECK_FALSE(law(1.34, "nearest").differs);
  CHECK_FALSE(law(0.66, "nearest").differs);
  CHECK(law(1.36, "nearest").differs);
  CHECK_THAT(law(0.64, "nearest").reason, ContainsSubstring("kink"));
  CHECK_THAT(law(2.4, "linear").reason, ContainsSubstring("coarsest"));
  CHECK(law(2, "RGL's").expected == 2);
}

TEST_CASE("settings that differ in more than size make laws of their own, from three on") {
  std::vector<CostSetting> settings = tables("4-D", 4, 2);
  for (const CostSetting& nearest : tables("4-D", 4, 1, "nearest")) settings.push_back(nearest);
  for (CostSetting half : tables("4-D", 4, 1.5)) {
    half.stored = "half";
    settings.push_back(half);
  }
  CostSetting other = table("4-D", 100, 0.1);
  other.format = "MERL";
  settings.push_back(other);
  const std::vector<Convergence> laws = convergence({}, settings);
  REQUIRE(laws.size() == 3);
  CHECK(std::abs(laws[0].fitted - 2) <= kFitted);
  CHECK(std::abs(laws[1].fitted - 1) <= kFitted);
  CHECK(std::abs(laws[2].fitted - 1.5) <= kFitted);
  // Rounding, and what has no size, count for nothing.
  settings = tables("4-D", 4, 2);
  settings[3].error.rms = 1e-14;
  settings.push_back(table("4-D", 0, 1));
  CHECK(std::abs(convergence({}, settings).at(0).fitted - 2) <= kFitted);
  settings[2].error.rms = 1e-14;
  CHECK(convergence({}, settings).empty());
  CHECK(convergence({}, {}).empty());
}

TEST_CASE("the rounding of halves explains a grid that stops getting better") {
  std::vector<CostSetting> settings = tables("4-D", 4, 2);
  double rms = 4e-4;
  for (CostSetting& setting : settings) {
    setting.stored = "half";
    setting.error.rms = rms *= 0.9;
  }
  CHECK_THAT(convergence({}, settings).at(0).reason, ContainsSubstring("half"));
}

TEST_CASE("the ratio of layers is found, and expected from the yarn and channel absorbing least") {
  const auto law = [](double absorption, double ratio) {
    std::vector<CostSetting> settings;
    for (int n = 1; n < 6; ++n)
      settings.push_back(evaluation("layers kept", n, 0.2 * std::pow(ratio, n)));
    const std::vector<Convergence> laws = convergence(absorbing(absorption), settings);
    REQUIRE(laws.size() == 1);
    return laws[0];
  };
  CHECK(std::abs(law(0.3, 0.3).fitted - 0.3) <= kFitted);
  CHECK(law(0.3, 0.3).law == "rms ~ ratio^layers");
  CHECK(law(0.3, 0.3).dial == "layers kept");
  // Next to opaque layers add light that is reflected once, after passing one layer more twice:
  // exp(-2 absorption) t^4. Six of them are as good as infinitely many.
  const double r = 0.04;
  const double expected = std::exp(-2 * 1.9) * std::pow(1 - r, 4);
  const Convergence dark = law(1.9, expected);
  INFO(dark.expected << " for " << expected);
  CHECK(std::abs(dark.expected / expected - 1) < 0.01);
  CHECK_FALSE(dark.differs);
  CHECK_FALSE(law(1.9, 1.24 * expected).differs);
  CHECK_THAT(law(1.9, 1.3 * expected).reason, ContainsSubstring("flatter"));
  CHECK_THAT(law(1.9, 0.7 * expected).reason, ContainsSubstring("steeper"));
  CHECK(law(0, 0.5).differs);
  CHECK_THAT(law(0, 0.5).reason, ContainsSubstring("pile of plates"));
}

TEST_CASE("rotations whose order grows are faster than any power") {
  std::vector<CostSetting> exponential;
  std::vector<CostSetting> square;
  for (const double n : {2.0, 4.0, 8.0, 16.0}) {
    exponential.push_back(evaluation("rotations", n, std::exp(-n)));
    square.push_back(evaluation("rotations", n, 1 / (n * n)));
  }
  const std::vector<Convergence> fast = convergence({}, exponential);
  REQUIRE(fast.size() == 1);
  CHECK_FALSE(fast[0].differs);
  CHECK_THAT(fast[0].law, ContainsSubstring("faster than any power"));
  CHECK(std::abs(fast[0].fitted - 8 / std::log(2.0)) <= 1e-10);
  CHECK(std::abs(fast[0].expected - 4 / std::log(2.0)) <= 1e-10);
  const std::vector<Convergence> slow = convergence({}, square);
  REQUIRE(slow.size() == 1);
  CHECK(slow[0].differs);
  CHECK(std::abs(slow[0].fitted - 2) <= kFitted);
  CHECK_FALSE(slow[0].reason.empty());
}

}  // namespace clothbrdf::test
