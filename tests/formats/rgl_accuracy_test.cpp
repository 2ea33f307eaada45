#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

#include "formats/rgl.h"
#include "tests/catch.h"
#include "tests/formats/strict_rgl.h"
#include "tests/formats/table_errors.h"

namespace clothbrdf::test {
namespace {}  // namespace

TEST_CASE("an RGL file follows the cloth within the promised errors for its size") {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& name, std::uint64_t bytes, const Errors& most) {
    const auto exact = pairs_of(read_material(preset(name)));
    const auto start = std::chrono::steady_clock::now();
    write_table(*exact, folder / "t.bsdf", {.bytes = bytes, .workers = 2});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const auto written = std::filesystem::file_size(folder / "t.bsdf");
    CHECK(written <= bytes);
    CHECK(written > bytes / 100 * 95);
    const Errors e = errors_of(read_table(folder / "t.bsdf"), *exact);
    std::cout << name << ".bsdf, " << written << " bytes: median " << e.median << ", 95 % " << e.p95
              << ", 99 % " << e.p99 << " per cent below 80 degrees; written in " << seconds.count()
              << " s\n";
    CHECK(e.median <= most.median);
    CHECK(e.p95 <= most.p95);
    CHECK(e.p99 <= most.p99);
  };
  for (const char* name : {"silk", "cotton", "tamamushi"}) {
    check(name, 5000000, {0.30, 1.8, 5});
  }
  check("silk", 50000000, {0.08, 0.55, 1.4});
}

TEST_CASE("a reader written from the format's description finds the same f_r in an RGL file") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  const auto exact = pairs_of(random.material(MaterialRanges{}));
  write_table(*exact, folder / "t.bsdf", {.bytes = 300000});
  const Table table = read_table(folder / "t.bsdf");
  const StrictRgl strict(read_file(folder / "t.bsdf"));
  double worst = 0;
  double mean = 0;
  const std::vector<Directions> pairs = uniform_pairs(random, 3000, 89.5);
  for (const Directions& pair : pairs) {
    std::vector<double> f(3);
    REQUIRE(table.interpolate(pair, f));
    const std::vector<double> expected = strict.f(pair.wi, pair.wo);
    for (std::size_t c = 0; c < 3; ++c) {
      mean += expected[c] / 9000;
      worst = std::max(worst, std::abs(f[c] - expected[c]) / (expected[c] + 1e-3 * mean));
    }
  }
  std::cout << "RGL file against a plain reader: " << worst << " (seed " << seed << ")\n";
  CHECK(worst <= 1e-9);
}

TEST_CASE("the table direction of an RGL file is to the eye, where that makes a difference") {
  const TemporaryFolder folder;
  const auto exact = pairs_of(read_material(preset("silk_paper")));
  write_table(*exact, folder / "t.bsdf", {.bytes = 3000000});
  const Errors e = errors_of(read_table(folder / "t.bsdf"), *exact, 60);
  std::cout << "silk_paper.bsdf of 3 MB: median " << e.median << ", 95 % " << e.p95
            << " per cent below 60 degrees\n";
  CHECK(e.median <= 1);
  CHECK(e.p95 <= 4);
}

TEST_CASE("an isotropic RGL file holds the mean over rotations, the same in a mirror") {
  const TemporaryFolder folder;
  const auto exact = pairs_of(read_material(preset("silk")), true);
  write_table(*exact, folder / "t.bsdf", {.bytes = 1000000});
  CHECK(std::filesystem::file_size(folder / "t.bsdf") <= 1000000);
  const auto fields = strict_fields(read_file(folder / "t.bsdf"));
  CHECK(fields.at("phi_i").shape == std::vector<std::uint64_t>{1});
  const Table table = read_table(folder / "t.bsdf");
  const Errors e = errors_of(table, *exact);
  std::cout << "isotropic silk.bsdf of 1 MB: median " << e.median << ", 95 % " << e.p95 << ", 99 % "
            << e.p99 << " per cent\n";
  CHECK(e.median <= 0.08);
  CHECK(e.p95 <= 0.55);
  CHECK(e.p99 <= 1.4);
  const std::vector<float> rgb = floats_of(fields.at("rgb"));
  const std::size_t n = fields.at("rgb").shape[4];
  float worst = 0;
  for (std::size_t k = 0; k < rgb.size(); ++k) {
    const std::size_t row = k / n % n;
    const float mirrored = rgb[k - row * n + (n - 1 - row) * n];
    worst = std::max(worst, std::abs(rgb[k] - mirrored) / std::max(rgb[k], 1e-2F));
  }
  CHECK(worst <= 1e-3F);
}

}  // namespace clothbrdf::test
