#include <iostream>
#include <limits>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/fits/finite_report.h"

namespace clothbrdf::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Each of these is small; what takes longer hangs.
constexpr double kMostSeconds = 10;

FitReport fit(const Table& table, const FitOptions& base = {}) {
  FitOptions options = base;
  options.starts = 3;
  options.most_layers = 2;
  FitReport report = fit_table(table, options, 1);
  INFO(report.failure);
  CHECK(not_finite(report) == "");
  CHECK(report.seconds <= kMostSeconds);
  return report;
}

// All three channels of the cells that are not the right ones for a fit.
Table cloth(const Grid& grid, const std::function<double(std::size_t, double)>& value) {
  RandomInputs random(3);
  Material m = random_cloth(random, 3, 2);
  if (grid.kind == GridKind::kHalfDifference3d) m.rotation_deg = 0;
  const Table table = table_of(m, grid);
  std::vector<double> values(table.values().begin(), table.values().end());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = value(k, values[k]);
  return with_values(table, std::move(values));
}

std::size_t count(const FitReport& report, Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(report.parameters.begin(), report.parameters.end(),
                    [&](const ParameterEstimate& p) { return p.verdict == verdict; }));
}

const Grid kSmall = halfdiff3d(6, 5, 6);

}  // namespace

TEST_CASE("tables without a value or without light are refused in words") {
  const auto same = [](double value) {
    return cloth(kSmall, [=](std::size_t, double) { return value; });
  };
  CHECK(fit(same(0)).failure.find('0') != std::string::npos);
  for (const double value : {-1.0, kNaN, kInfinity, -kInfinity}) {
    INFO(value);
    CHECK(fit(same(value)).failure.find("no cell") != std::string::npos);
  }
  CHECK(fit(same(1e200)).failure.find("no reflectance") != std::string::npos);
}

TEST_CASE("a constant table is a cloth without lobes, whose lobes cannot be told") {
  for (const double value : {0.1, 1e30, 1e-30}) {
    INFO(value);
    const FitReport report = fit(cloth(kSmall, [=](std::size_t, double) { return value; }));
    if (!report.failure.empty()) continue;
    for (const ParameterEstimate& p : report.parameters) {
      if (!p.name.ends_with("scatter") && !p.name.ends_with("refractive_index")) continue;
      INFO(p.name << ' ' << p.value << " +- " << p.standard_error.value_or(-1));
      CHECK(p.verdict != Verdict::kIdentifiable);
    }
  }
}

TEST_CASE("one lit cell settles nothing, and the report says so") {
  for (const std::size_t lit : {0U, 40U, 100U}) {
    const FitReport report =
        fit(cloth(kSmall, [=](std::size_t k, double) { return k == lit ? 1.0 : 0.0; }));
    std::cout << "one lit cell: '" << report.failure << "', identifiable "
              << count(report, Verdict::kIdentifiable) << ", residual " << report.residual_rms
              << ", converged " << report.converged << '\n';
    CHECK((!report.failure.empty() || count(report, Verdict::kNotIdentifiable) +
                                              count(report, Verdict::kAtBound) +
                                              count(report, Verdict::kWeak) >=
                                          5));
  }
}

TEST_CASE("cells that are not a number, negative or infinite are left out and counted") {
  const Grid grid = halfdiff4d(6, 5, 4, 5);
  FitOptions one;
  one.reflectances = {Reflectance::kMicrofacet};
  one.paths = {Paths::kAll};
  for (const double bad : {kNaN, -1.0, -1e-300, kInfinity, -kInfinity}) {
    RandomInputs random(8);
    const Table whole = cloth(grid, [](std::size_t, double x) { return x; });
    std::vector<double> values(whole.values().begin(), whole.values().end());
    std::size_t left_out = 0;
    for (double& value : values) {
      if (!(value > 0) || !random.chance(0.5)) continue;
      value = bad;
      ++left_out;
    }
    const FitReport all = fit(whole, one);
    const FitReport half = fit(with_values(whole, values), one);
    INFO(bad);
    CHECK(half.failure == "");
    CHECK(half.masked == left_out);
    CHECK(half.values == all.values - left_out);
    CHECK(all.masked == 0);
    CHECK(half.below_horizon == all.below_horizon);
    // What is left is exact.
    CHECK(half.residual_rms <= 1e-6);
  }
}

TEST_CASE("tables of too few cells or of one row are refused, or fitted without claims") {
  const Grid grids[] = {halfdiff3d(1, 1, 1), inout(1, 1, 1, 1), halfdiff3d(20, 1, 20),
                        halfdiff4d(1, 1, 1, 1), halfdiff3d(1, 20, 10)};
  for (const Grid& grid : grids) {
    const FitReport report = fit(cloth(grid, [](std::size_t, double x) { return x; }));
    std::cout << grid.description() << ": '" << report.failure << "', identifiable "
              << count(report, Verdict::kIdentifiable) << " of " << report.parameters.size()
              << '\n';
    CHECK((!report.failure.empty() ||
           count(report, Verdict::kIdentifiable) < report.parameters.size()));
  }
}

TEST_CASE("values far beyond any cloth's give a report of finite numbers") {
  for (const double factor : {1e30, 1e-30, 1e99, 1e-290}) {
    INFO(factor);
    const FitReport report = fit(cloth(kSmall, [=](std::size_t, double x) { return x * factor; }));
    std::cout << "values times " << factor << ": '" << report.failure << "', converged "
              << report.converged << ", residual " << report.residual_rms << '\n';
  }
  // A few of them among good ones.
  const FitReport report =
      fit(cloth(kSmall, [](std::size_t k, double x) { return k % 97 == 0 && x > 0 ? 1e30 : x; }));
  CHECK(report.residual_rms > 1);
}

TEST_CASE("options out of range are refused before any work") {
  const Table table = cloth(kSmall, [](std::size_t, double x) { return x; });
  using Kind = ParameterWish::Kind;
  const auto refused = [&](const ParameterWish& wish, const char* words) {
    FitOptions options;
    options.wishes = {wish};
    CHECK_THROWS_WITH(fit_table(table, options, 1), ContainsSubstring(words));
  };
  refused({Kind::kFix, "warp.colour", 1, {}, {}}, "is no parameter");
  refused({Kind::kFix, "warp.scatter", 2, {}, {}}, "warp.scatter: 2 is not allowed");
  refused({Kind::kFree, "warp.scatter", {}, 0.5, 0.4}, "hold no number");
  refused({Kind::kFix, "layers", 1.5, {}, {}}, "an integer");
  refused({Kind::kFix, "layers", 65, {}, {}}, "an integer");
  refused({Kind::kTie, "weights", {}, {}, {}}, "only parameters of yarns");
  refused({Kind::kStart, "warp.scatter", kNaN, {}, {}}, "is not allowed");
  for (const double noise : {0.0, -1.0, kNaN, kInfinity}) {
    FitOptions options;
    options.noise = noise;
    CHECK_THROWS_AS(fit_table(table, options, 1), InputError);
  }
  FitOptions layers;
  layers.fewest_layers = 3;
  layers.most_layers = 2;
  CHECK_THROWS_AS(fit_table(table, layers, 1), InputError);
}

}  // namespace clothbrdf::test
