#include "table/sampled_error.h"

#include <cmath>
#include <numeric>

#include "tests/catch.h"

namespace clothbrdf::test {

TEST_CASE("sampled pairs are the same for a seed, and stand for uniform ones") {
  const SampledPairs sampled = sampled_pairs(200000, 5);
  CHECK(sampled.pairs.size() > 120000);
  CHECK(sampled_pairs(1000, 5).shares == sampled_pairs(1000, 5).shares);
  CHECK(sampled_pairs(1000, 5).shares != sampled_pairs(1000, 6).shares);
  CHECK_THAT(std::accumulate(sampled.shares.begin(), sampled.shares.end(), 0.0),
             Catch::Matchers::WithinAbs(1, 1e-9));
  // Means of polynomials over cosines uniform from cos 85 degrees to 1, known by hand.
  const double low = std::cos(85 * std::acos(-1.0) / 180);
  const double mean = (1 + low) / 2;
  const double mean_square = (1 + low + low * low) / 3;
  double cosine = 0;
  double product = 0;
  double squares = 0;
  double azimuths = 0;
  for (std::size_t k = 0; k < sampled.pairs.size(); ++k) {
    const auto& [wi, wo] = sampled.pairs[k];
    CHECK((wi[2] >= low && wo[2] >= low));
    cosine += sampled.shares[k] * wi[2];
    product += sampled.shares[k] * wi[2] * wo[2];
    squares += sampled.shares[k] * wi[2] * wi[2] * wo[2] * wo[2];
    azimuths += sampled.shares[k] * (wi[0] * wo[0] + wi[1] * wo[1]);
  }
  CAPTURE(cosine, product, squares, azimuths);
  CHECK_THAT(cosine, Catch::Matchers::WithinRel(mean, 0.01));
  CHECK_THAT(product, Catch::Matchers::WithinRel(mean * mean, 0.01));
  CHECK_THAT(squares, Catch::Matchers::WithinRel(mean_square * mean_square, 0.02));
  CHECK(std::abs(azimuths) < 0.01);
}

TEST_CASE("the error of a table is that of its definition") {
  // Two pairs of two channels, of shares 3/4 and 1/4 and cosines 1 and 1/2.
  const SampledPairs sampled = {{{{0, 0, 1}, {0, 0, 1}}, {{0, 0, 0.5}, {0, 0, 1}}}, {0.75, 0.25}};
  const std::vector<double> exact = {1, 2, 3, 4};
  const std::vector<double> read = {1.1, 2, 3, 3};
  const TableError error = table_error(sampled, exact, read);
  const double squares = 0.75 * 0.01 + 0.25 * 0.25 * 1;
  const double all = 0.75 * (1 + 4) + 0.25 * 0.25 * (9 + 16);
  CHECK_THAT(error.rms, Catch::Matchers::WithinRel(std::sqrt(squares / all), 1e-12));
  const double mean = 0.75 * 1.5 + 0.25 * 3.5;
  CHECK_THAT(error.max, Catch::Matchers::WithinRel(1 / (4 + 0.001 * mean), 1e-12));
  CHECK(error.p99 == error.max);
  CHECK(table_error(sampled, exact, exact) == TableError{});
  const std::vector<double> black(4);
  CHECK(table_error(sampled, black, black) == TableError{});
}

TEST_CASE("one value in a hundred may pass the 99th percentile") {
  SampledPairs sampled;
  for (int k = 0; k < 1000; ++k) {
    sampled.pairs.push_back({{0, 0, 1}, {0, 0, 1}});
    sampled.shares.push_back(1e-3);
  }
  const std::vector<double> exact(1000, 1.0);
  std::vector<double> read(1000, 1.0);
  for (std::size_t k = 0; k < 9; ++k) read[k] = 2;
  CHECK(table_error(sampled, exact, read).p99 == 0);
  for (std::size_t k = 0; k < 11; ++k) read[k] = 2;
  CHECK(table_error(sampled, exact, read).p99 > 0.9);
}

}  // namespace clothbrdf::test
