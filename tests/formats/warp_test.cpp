#include "formats/warp.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "tests/catch.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

std::vector<float> random_densities(RandomInputs& random, std::size_t count) {
  std::vector<float> densities(count);
  for (float& d : densities) {
    d = static_cast<float>(random.chance(0.3) ? 0.5 : random.log_uniform(1e-2, 1e2));
  }
  return densities;
}

}  // namespace

TEST_CASE("a warp and its inverse undo each other, in one slice and between four") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    const auto rows = static_cast<std::size_t>(random.integer(2, 9));
    const auto columns = static_cast<std::size_t>(random.integer(2, 9));
    const Warp warp(rows, columns, random_densities(random, 6 * rows * columns));
    const std::vector<float> phi = {-1, 0, 2};
    const std::vector<float> theta = {0, 1};
    const SliceBlend blend =
        random.chance(0.5)
            ? only_slice(static_cast<std::size_t>(random.integer(0, 5)))
            : blend_slices(phi, theta, random.uniform(-2, 3), random.uniform(-0.5, 1.5));
    for (int k = 0; k < 20; ++k) {
      const RglPoint u = {random.unit(), random.unit()};
      const RglPoint back = warp.invert(warp.sample(u, blend), blend);
      worst = std::max({worst, std::abs(back.x - u.x), std::abs(back.y - u.y)});
    }
  }
  std::cout << "warp: back to " << worst << " (seed " << seed << ")\n";
  // Rounding, magnified where neighbouring densities are nearly equal: the root cancels.
  CHECK(worst <= 1e-9);
}

TEST_CASE("a warp's density is that of its samples, and adds up to 1") {
  RandomInputs random(seed_from_environment());
  const std::size_t rows = 4;
  const std::size_t columns = 5;
  const Warp warp(rows, columns, random_densities(random, 2 * rows * columns));
  SliceBlend blend = only_slice(0);
  blend.shares[0].weight = 0.3;
  blend.shares[1] = {1, 0.7};
  blend.count = 2;
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    // How much of the even square is taken to a small square around a point inside a patch.
    const double h = 1e-4;
    const RglPoint at = {(random.integer(0, 3) + random.uniform(0.01, 0.99)) / 4,
                         (random.integer(0, 2) + random.uniform(0.01, 0.99)) / 3};
    const auto u = [&](double x, double y) { return warp.invert({at.x + x, at.y + y}, blend); };
    const double x_x = (u(h, 0).x - u(-h, 0).x) / (2 * h);
    const double y_y = (u(0, h).y - u(0, -h).y) / (2 * h);
    const double y_x = (u(h, 0).y - u(-h, 0).y) / (2 * h);  // rows are inverted first: none
    CHECK(std::abs(y_x) <= 1e-9);
    worst = std::max(worst, std::abs(x_x * y_y / warp.density(at, blend) - 1));
  }
  CHECK(worst <= 1e-5);  // second differences
  double sum = 0;
  const int n = 400;
  for (int k = 0; k < n * n; ++k) {
    const int row = k / n;
    sum += warp.density({(k % n + 0.5) / n, (row + 0.5) / n}, blend) / (n * n);
  }
  CHECK(std::abs(sum - 1) <= 1e-4);
}

TEST_CASE("rows without density are skipped, and their points stay finite") {
  const Warp warp(3, 2, std::vector<float>{1, 1, 1, 1, 0, 0});
  const RglPoint far = warp.sample({0.5, 1}, only_slice(0));
  CHECK(far.y == 1);
  const RglPoint back = warp.invert({0.5, 1}, only_slice(0));
  CHECK(back.x == 0);
  CHECK(std::abs(back.y - 1) <= 1e-15);
  const Warp empty(2, 2, std::vector<float>(4, 0.0F));
  CHECK(empty.density({0.5, 0.5}, only_slice(0)) == 0);
  CHECK(std::isfinite(empty.sample({0.5, 0.5}, only_slice(0)).x));
}

TEST_CASE("values between slices are clamped at both ends, without wrap") {
  const std::vector<float> nodes = {-1, 0, 2};
  CHECK(bracket(nodes, -5).lower == 0);
  CHECK(bracket(nodes, -5).upper_share == 0);
  CHECK(bracket(nodes, 0.5).lower == 1);
  CHECK(bracket(nodes, 0.5).upper_share == 0.25);
  CHECK(bracket(nodes, 9).lower == 1);
  CHECK(bracket(nodes, 9).upper_share == 1);
  CHECK(bracket(std::vector<float>{7}, 9).upper_share == 0);
}

}  // namespace clothbrdf::test
