#include <ceres/cost_function.h>
#include <ceres/gradient_checker.h>
#include <ceres/manifold.h>

#include <iostream>

#include "tests/catch.h"
#include "tests/gradients/problem.h"

namespace clothbrdf::test {
namespace {

// Sums of some hundred products in another order.
constexpr double kRounding = 1e-11;

const Setting kSettings[] = {
    {halfdiff4d(5, 4, 4, 5), false, Reflectance::kMicrofacet, Paths::kAll, 3, {}, true},
    {halfdiff3d(6, 5, 6), false, Reflectance::kPaper, Paths::kSingle, 5, {"scatter"}, false},
    {inout(3, 4, 3, 4), false, Reflectance::kMicrofacet, Paths::kAll, 1, {"absorption"}, true},
    {halfdiff4d(4, 3, 3, 4), true, Reflectance::kMicrofacet, Paths::kAll, 3, {"lobe_axes"}, true},
};

struct Case {
  Problem problem;
  Material at;
};

std::vector<Case> cases(std::uint64_t seed) {
  RandomInputs random(seed);
  std::vector<Case> all;
  for (const Setting& setting : kSettings) {
    Material material = random_cloth(random, setting.channels);
    material.reflectance = setting.reflectance;
    material.paths = setting.paths;
    if (setting.grid.kind == GridKind::kHalfDifference3d) material.rotation_deg = 0;
    Problem problem(setting, material, seed);
    const Material at = shaken(material, problem.set(), 0.1, seed);
    all.push_back({std::move(problem), at});
  }
  return all;
}

// The residuals as Ceres sees them.
class CeresResiduals final : public ceres::CostFunction {
 public:
  CeresResiduals(const Problem& problem, const Material& base) : problem_(problem), base_(base) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.set().free().size()));
    set_num_residuals(
        static_cast<int>(problem.misfit().residuals(base, problem.set(), nullptr).size()));
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::size_t free = problem_.set().free().size();
    const Material m = problem_.set().material({parameters[0], free}, base_);
    Eigen::MatrixXd slopes;
    const std::vector<double> r = problem_.misfit().residuals(m, problem_.set(), &slopes);
    std::copy(r.begin(), r.end(), residuals);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], slopes.rows(), slopes.cols()) = slopes;
    }
    return true;
  }

 private:
  const Problem& problem_;
  const Material& base_;
};

}  // namespace

TEST_CASE("products and the triangle are those of the residuals and their derivatives") {
  const std::uint64_t seed = seed_from_environment();
  double worst = 0;
  for (const Case& c : cases(seed)) {
    const Misfit misfit = c.problem.misfit();
    Eigen::MatrixXd slopes;
    const std::vector<double> r = misfit.residuals(c.at, c.problem.set(), &slopes);
    Eigen::MatrixXd all(slopes.rows(), slopes.cols() + 1);
    all << slopes, Eigen::Map<const Eigen::VectorXd>(r.data(), slopes.rows());
    const Eigen::MatrixXd expected = all.transpose() * all;
    const Eigen::MatrixXd products = misfit.products(c.at, c.problem.set());
    const Eigen::MatrixXd triangle = misfit.triangle(c.at, c.problem.set());
    REQUIRE(products.rows() == expected.rows());
    REQUIRE(triangle.rows() == expected.rows());
    CHECK(triangle.isUpperTriangular(0));
    const Eigen::MatrixXd squared = triangle.transpose() * triangle;
    const Eigen::VectorXd size = expected.diagonal().cwiseSqrt();
    for (Eigen::Index i = 0; i < expected.rows(); ++i) {
      for (Eigen::Index j = 0; j < expected.cols(); ++j) {
        for (const Eigen::MatrixXd* m : {&products, &squared}) {
          const double error = std::abs((*m)(i, j) - expected(i, j)) / (size[i] * size[j]);
          INFO(c.problem.setting().grid.description() << " element " << i << ' ' << j);
          CHECK(error <= kRounding);
          worst = std::max(worst, error);
        }
      }
    }
    CHECK(std::abs(misfit.cost(c.at) / expected(expected.rows() - 1, expected.cols() - 1) - 1) <=
          kRounding);
  }
  std::cout << "sums over residuals: worst difference " << worst << " (seed " << seed << ")\n";
}

TEST_CASE("ceres::GradientChecker finds no error in any residual") {
  // Its Ridders steps are relative to each coordinate.
  constexpr double kTolerance = 1e-6;
  double worst = 0;
  for (const Case& c : cases(seed_from_environment() + 7)) {
    const CeresResiduals residuals(c.problem, c.at);
    ceres::NumericDiffOptions options;
    options.ridders_relative_initial_step_size = 1e-3;
    options.relative_step_size = 1e-3;
    const std::vector<const ceres::Manifold*>* const no_manifolds = nullptr;
    const ceres::GradientChecker checker(&residuals, no_manifolds, options);
    const std::vector<double> at = c.problem.set().coordinates(c.at);
    const double* const blocks[] = {at.data()};
    ceres::GradientChecker::ProbeResults results;
    INFO(c.problem.setting().grid.description());
    const bool good = checker.Probe(blocks, kTolerance, &results);
    INFO(results.error_log);
    // Elements that are rounding are compared, too: only those of some size count.
    const Eigen::MatrixXd difference = results.jacobians[0] - results.numeric_jacobians[0];
    const double error =
        difference.cwiseAbs().maxCoeff() / results.jacobians[0].cwiseAbs().maxCoeff();
    CHECK((good || error <= kTolerance));
    worst = std::max(worst, error);
  }
  std::cout << "ceres::GradientChecker: worst difference " << worst << '\n';
}

}  // namespace clothbrdf::test
