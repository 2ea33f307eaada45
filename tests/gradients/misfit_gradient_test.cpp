#include <iostream>
#include <map>
#include <sstream>

#include "tests/catch.h"
#include "tests/gradients/problem.h"

namespace clothbrdf::test {
namespace {

// Ridders' method on values that are good to about 1e-14 leaves this, relative; the worst measured
// are printed.
constexpr double kTwoSided = 1e-8;
// Of one side only: half the order, and at a bound the steps are large beside the value's scale.
constexpr double kOneSided = 1e-5;

// Steps of a coordinate to begin with: the model is smooth over a few of them.
double first_step(const FitParameter& p) { return p.column == kRotation ? 1 : 0.02; }

std::string described(const Problem& problem, const Material& material, const std::string& name,
                      const SlopeError& e) {
  std::ostringstream out;
  out << name << " row " << e.row << " exact " << e.exact << " numeric " << e.numeric << ": ";
  print(out, problem.setting());
  out << "\n    ";
  print(out, material, DirectionPair{});
  return out.str();
}

struct Worst {
  double error = 0;
  std::string where;
};

void check_column(const Problem& problem, const Material& material, const Eigen::MatrixXd& slopes,
                  std::size_t free, Side side, double tolerance, Worst& worst) {
  const FitParameter& p = problem.set().parameters()[problem.set().free()[free]];
  const double at = p.to_coordinate(parameter_value(material, p));
  const std::vector<double> numeric = ridders(
      [&](double x) { return problem.residuals_at(material, free, x); }, at, first_step(p), side);
  const SlopeError e = slope_error(slopes, free, numeric, problem.largest_residual(material));
  if (!(e.error <= worst.error)) worst = {e.error, described(problem, material, p.name, e)};
  INFO(described(problem, material, p.name, e));
  CHECK(e.error <= tolerance);
}

// A tie makes the weft's values the warp's.
Material tied(const Problem& problem, const Material& m) {
  return problem.set().material(problem.set().coordinates(m), m);
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  const Grid points[] = {halfdiff3d(5, 4, 4), halfdiff4d(4, 3, 3, 3), inout(3, 3, 3, 4)};
  const Grid averages[] = {halfdiff3d(4, 3, 4), halfdiff4d(3, 2, 3, 3), inout(2, 2, 2, 2)};
  for (const Paths paths : {Paths::kAll, Paths::kSingle}) {
    for (const Grid& grid : points) {
      for (const Reflectance r : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
        all.push_back({grid, false, r, paths, 1, {}, true});
      }
    }
    for (const Grid& grid : averages) {
      all.push_back({grid, true, Reflectance::kMicrofacet, paths, 1, {}, true});
    }
  }
  return all;
}

constexpr int kLayerCounts[] = {0, 1, 3, 8};

}  // namespace

TEST_CASE("residuals have exact derivatives at random materials, whatever the table") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  Worst worst;
  std::map<std::string, int> drawn;
  int number = 0;
  for (Setting setting : settings()) {
    for (int n = 0; n < soak_cases(2); ++n, ++number) {
      setting.channels = number % 3 == 0 ? 5 : 1;
      setting.tied.clear();
      if (number % 4 == 1) setting.tied = {"refractive_index", "scatter"};
      if (number % 4 == 3) setting.tied = {"absorption", "lobe_axes.1"};
      setting.reduce = number % 2 == 0;
      Material material = random_cloth(random, setting.channels);
      material.reflectance = setting.reflectance;
      material.paths = setting.paths;
      if (setting.grid.kind == GridKind::kHalfDifference3d) material.rotation_deg = 0;
      material.warp.layers = kLayerCounts[number % 4];
      material.weft.layers = kLayerCounts[(number / 4 + number) % 4];
      const Problem problem(setting, material, seed + static_cast<std::uint64_t>(number));
      const Material at = shaken(tied(problem, material), problem.set(), 0.05, seed);
      Eigen::MatrixXd slopes;
      const Misfit misfit = problem.misfit();
      misfit.residuals(at, problem.set(), &slopes);
      for (std::size_t k = 0; k < problem.set().free().size(); ++k) {
        check_column(problem, at, slopes, k, Side::kBoth, kTwoSided, worst);
      }
      ++drawn["layers " + std::to_string(at.warp.layers)];
      ++drawn[std::to_string(setting.channels) + " channels"];
      ++drawn[setting.tied.empty() ? "free" : "tied"];
      ++drawn[setting.reduce ? "reduced" : "all rows"];
    }
  }
  CHECK(number >= 10);
  CHECK(drawn.size() == 10);  // four layer counts and both of every other choice
  for (const auto& [what, count] : drawn) {
    INFO(what);
    CHECK(count >= 5);
  }
  std::cout << "derivatives at " << number << " random materials: worst error " << worst.error
            << " (seed " << seed << ")\n    " << worst.where;
}

TEST_CASE("residuals have exact derivatives at each bound of every parameter") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed + 1);
  Worst worst;
  int cases = 0;
  const std::vector<Setting> all = settings();
  const std::size_t count = fit_parameters(1).size();
  for (std::size_t i = 0; i < count; ++i) {
    for (const bool high : {false, true}) {
      for (int n = 0; n < soak_cases(3); ++n, ++cases) {
        Setting setting = all[static_cast<std::size_t>(random.integer(0, 17))];
        if (fit_parameters(1)[i].column == kRotation &&
            setting.grid.kind == GridKind::kHalfDifference3d) {
          setting.grid = halfdiff4d(4, 3, 3, 3);
        }
        Material material = random_cloth(random, 1);
        material.reflectance = setting.reflectance;
        material.paths = setting.paths;
        if (setting.grid.kind == GridKind::kHalfDifference3d) material.rotation_deg = 0;
        const Problem problem(setting, material, seed + static_cast<std::uint64_t>(cases));
        const FitParameter& p = problem.set().parameters()[i];
        set_parameter(material, p, high ? p.highest : p.lowest);
        Eigen::MatrixXd slopes;
        problem.misfit().residuals(material, problem.set(), &slopes);
        for (std::size_t k = 0; k < problem.set().free().size(); ++k) {
          if (problem.set().free()[k] != i) continue;
          const Side side = high ? Side::kBelow : Side::kAbove;
          check_column(problem, material, slopes, k, side, kOneSided, worst);
        }
      }
    }
  }
  std::cout << "derivatives at " << cases << " bounds: worst error " << worst.error << " (seed "
            << seed << ")\n    " << worst.where;
}

TEST_CASE("derivatives of every other parameter hold where one sits at its bound") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed + 2);
  Worst worst;
  int cases = 0;
  const std::vector<Setting> all = settings();
  for (std::size_t i = 0; i < fit_parameters(1).size(); ++i) {
    for (const bool high : {false, true}) {
      Setting setting = all[static_cast<std::size_t>(cases) % all.size()];
      Material material = random_cloth(random, 1);
      material.reflectance = setting.reflectance;
      material.paths = setting.paths;
      if (setting.grid.kind == GridKind::kHalfDifference3d) material.rotation_deg = 0;
      const Problem problem(setting, material, seed + static_cast<std::uint64_t>(cases));
      const FitParameter& p = problem.set().parameters()[i];
      set_parameter(material, p, high ? p.highest : p.lowest);
      if (p.column == kRotation && setting.grid.kind == GridKind::kHalfDifference3d) continue;
      Eigen::MatrixXd slopes;
      problem.misfit().residuals(material, problem.set(), &slopes);
      for (std::size_t k = 0; k < problem.set().free().size(); ++k) {
        if (problem.set().free()[k] == i) continue;
        check_column(problem, material, slopes, k, Side::kBoth, kTwoSided, worst);
      }
      ++cases;
    }
  }
  CHECK(cases > 15);
  std::cout << "derivatives beside " << cases << " bounds: worst error " << worst.error << " (seed "
            << seed << ")\n    " << worst.where;
}

// Where the axes are equal, the wider one that scatter tends to passes from one to the other: a
// kink. The derivative is that of the side on which the axis across is the wider one: along it is
// from below, across it from above. Along both at once there is no kink, and their sum is exact.
TEST_CASE("at equal axes derivatives are those of the side where the axis across is the wider") {
  RandomInputs random(seed_from_environment() + 3);
  Worst worst;
  for (int n = 0; n < 6; ++n) {
    Setting setting = settings()[static_cast<std::size_t>(n) * 3];
    Material material = random_cloth(random, 1);
    material.reflectance = setting.reflectance;
    material.paths = setting.paths;
    material.rotation_deg = 0;
    Yarn& yarn = n % 2 == 0 ? material.warp : material.weft;
    yarn.lobe_axes[1] = yarn.lobe_axes[0];
    const Problem problem(setting, material, 5);
    Eigen::MatrixXd slopes;
    problem.misfit().residuals(material, problem.set(), &slopes);
    std::size_t along = 0;
    for (std::size_t k = 0; k < problem.set().free().size(); ++k) {
      const FitParameter& p = problem.set().parameters()[problem.set().free()[k]];
      if (p.column != kAlong || p.yarn != static_cast<std::size_t>(n % 2)) continue;
      along = k;
    }
    check_column(problem, material, slopes, along, Side::kBelow, kOneSided, worst);
    check_column(problem, material, slopes, along + 1, Side::kAbove, kOneSided, worst);
    const double at = std::log(yarn.lobe_axes[0]);
    const auto both = [&](double x) {
      std::vector<double> coordinates = problem.set().coordinates(material);
      coordinates[along] = coordinates[along + 1] = x;
      return problem.misfit().residuals(problem.set().material(coordinates, material),
                                        problem.set(), nullptr);
    };
    const Eigen::MatrixXd sum = slopes.col(static_cast<Eigen::Index>(along)) +
                                slopes.col(static_cast<Eigen::Index>(along) + 1);
    const SlopeError e = slope_error(sum, 0, ridders(both, at, 0.02, Side::kBoth),
                                     problem.largest_residual(material));
    INFO(described(problem, material, "both axes", e));
    CHECK(e.error <= kTwoSided);
    if (!(e.error <= worst.error)) worst = {e.error, described(problem, material, "both", e)};
  }
  std::cout << "derivatives at equal axes: worst error " << worst.error << "\n    " << worst.where;
}

}  // namespace clothbrdf::test
