#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "formats/rgl.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/formats/small_rgl.h"
#include "tests/formats/strict_rgl.h"

namespace clothbrdf::test {
namespace {

std::vector<double> f_at(const Table& table, const Directions& pair) {
  std::vector<double> f(table.spec().channels.size());
  REQUIRE(table.interpolate(pair, f));
  return f;
}

Directions random_pair(RandomInputs& random) {
  const DirectionPair pair = random.pair();
  return {direction(pair.theta_i, pair.phi_i), direction(pair.theta_o, pair.phi_o)};
}

Directions mirrored(const Directions& d, double x, double y) {
  return {{x * d.wi[0], y * d.wi[1], d.wi[2]}, {x * d.wo[0], y * d.wo[1], d.wo[2]}};
}

std::filesystem::path shared_file(const std::string& name) {
  const char* folder = std::getenv("CLOTHBRDF_SHARED_DATA");
  return std::filesystem::path(folder != nullptr ? folder
                                                 : CLOTHBRDF_SOURCE_DIR "/../shared/data") /
         name;
}

}  // namespace

TEST_CASE("any small RGL file is evaluated as by a plain reader, whatever its field order") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  double worst = 0;
  for (int n = 0; n < 20; ++n) {
    Fields fields = small_fields(random, 5, 2 * kPi);
    if (n % 2 == 1) std::reverse(fields.begin(), fields.end());
    const std::string bytes = tensor_file(fields);
    const Table table = read_bytes(folder, bytes);
    const StrictRgl strict(bytes);
    CHECK(table.spec().channels == rgb_channels());
    CHECK(!table.spec().isotropic());
    CHECK(table.spec().cell_count() == 5 * 2 * 2 * 2);
    for (int k = 0; k < 50; ++k) {
      const Directions pair = random_pair(random);
      const std::vector<double> f = f_at(table, pair);
      const std::vector<double> expected = strict.f(pair.wi, pair.wo);
      for (std::size_t c = 0; c < 3; ++c) {
        CHECK(expected[c] > 0);
        worst = std::max(worst, std::abs(f[c] / expected[c] - 1));
      }
    }
  }
  std::cout << "small RGL files against a plain reader: " << worst << " (seed " << seed << ")\n";
  // The chord's rounding near the normal, and azimuths of half vectors beside it.
  CHECK(worst <= 1e-6);
}

TEST_CASE("half circles stand for the rest turned by 180 degrees, quarters for their mirrors") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const Table half = read_bytes(folder, tensor_file(small_fields(random, 4, kPi)));
  const Table quarter = read_bytes(folder, tensor_file(small_fields(random, 3, kPi / 2)));
  for (int k = 0; k < 200; ++k) {
    const Directions pair = random_pair(random);
    if (std::abs(pair.wo[0]) < 1e-6 || std::abs(pair.wo[1]) < 1e-6) continue;
    CHECK(f_at(half, pair) == f_at(half, mirrored(pair, -1, -1)));
    CHECK(f_at(quarter, pair) == f_at(quarter, mirrored(pair, -1, 1)));
    CHECK(f_at(quarter, pair) == f_at(quarter, mirrored(pair, 1, -1)));
  }
  const Directions pair = {direction(50.0, 10.0), direction(40.0, -100.0)};
  CHECK(f_at(half, pair) != f_at(half, mirrored(pair, 1, -1)));
  Fields third = small_fields(random, 4, 2 * kPi / 3);
  CHECK_THROWS_WITH(read_bytes(folder, tensor_file(third)),
                    ContainsSubstring("'phi_i' covers 2.09"));
}

TEST_CASE("one or two azimuths are isotropic: only their difference counts") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  Fields fields = small_fields(random, 1, 0);
  // As in real files: of an isotropic cloth it cannot depend on the azimuth.
  field_of(fields, "sigma") = tensor_of("sigma", 10, {2, 2}, std::vector<float>{1, 2, 1, 2});
  const Table table = read_bytes(folder, tensor_file(fields));
  CHECK(table.spec().isotropic());
  const auto f = f_at(table, {direction(50.0, 10.0), direction(40.0, 100.0)});
  const auto turned = f_at(table, {direction(50.0, 75.0), direction(40.0, 165.0)});
  for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(f[c] / turned[c] - 1) <= 1e-12);
  CHECK(f != f_at(table, {direction(50.0, 10.0), direction(40.0, 120.0)}));
}

TEST_CASE("values without the mark of the Jacobian, of other types and spectra are read") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const Directions pair = {direction(50.0, 10.0), direction(40.0, -100.0)};
  Fields fields = small_fields(random, 5, 2 * kPi);
  const auto scaled = f_at(read_bytes(folder, tensor_file(fields)), pair);

  Fields other = fields;
  other.pop_back();
  CHECK(f_at(read_bytes(folder, tensor_file(other)), pair) == scaled);

  other = fields;
  field_of(other, "jacobian").values = std::string(1, '\0');
  field_of(other, "rgb") = tensor_of("rgb", 10, {5, 2, 3, 2, 2}, std::vector<float>(120, 2));
  const auto plain = f_at(read_bytes(folder, tensor_file(other)), pair);
  CHECK(std::abs(plain[0] - 2 / pair.wi[2]) <= 1e-12);

  other = fields;
  for (const char* name : {"rgb", "vndf", "theta_i"}) {
    TensorBytes& field = field_of(other, name);
    const std::vector<float> floats = floats_of(field);
    field = tensor_of(name, 11, field.shape, std::vector<double>(floats.begin(), floats.end()));
  }
  CHECK(f_at(read_bytes(folder, tensor_file(other)), pair) == scaled);

  // With both, wavelengths count, as for Mitsuba.
  other = fields;
  TensorBytes spectra = field_of(other, "rgb");
  spectra.name = "spectra";
  other.push_back(spectra);
  other.push_back(tensor_of("wavelengths", 10, {3}, std::vector<float>{450, 550.1F, 650}));
  const Table spectral = read_bytes(folder, tensor_file(other));
  CHECK(f_at(spectral, pair) == scaled);
  CHECK(spectral.spec().channels[1].name == "550_1nm");

  // Nodes 0 and 2 of the first eight are not measured.
  other = fields;
  std::vector<char> bits(5, -1);
  bits[0] = static_cast<char>(0b01011111);
  other.push_back(tensor_of("valid", 1, {5}, bits));
  const Table marked = read_bytes(folder, tensor_file(other));
  const Table unmarked = read_bytes(folder, tensor_file(fields));
  for (std::size_t cell = 0; cell < 40; ++cell) {
    CHECK(marked.valid(cell) == (unmarked.valid(cell) && cell != 0 && cell != 2));
  }
  CHECK(unmarked.valid(0));
  CHECK(unmarked.valid(2));
}

TEST_CASE("measured green felt has its known albedo") {
  const std::filesystem::path path = shared_file("rgl_acrylic_felt_green_rgb.bsdf");
  if (!std::filesystem::exists(path)) {
    WARN(path.string() << " is not there: skipped");
    return;
  }
  const Table table = format_for(path).read(path);
  CHECK(table.spec().isotropic());
  CHECK(table.spec().cell_count() == 8192);
  CHECK(!table.spec().provenance.material);
  const Vector3<double> eye = direction(30.0, 0.0);
  double albedo[3] = {0, 0, 0};
  const int n = 200;
  for (int k = 0; k < n * n; ++k) {
    // Midpoints of equal parts of the projected solid angle.
    const int row = k / n;
    const double sin_theta = std::sqrt((row + 0.5) / n);
    const double phi = 2 * kPi * (k % n + 0.5) / n;
    const std::vector<double> f =
        f_at(table, {{sin_theta * std::cos(phi), sin_theta * std::sin(phi),
                      std::sqrt(1 - sin_theta * sin_theta)},
                     eye});
    for (std::size_t c = 0; c < 3; ++c) albedo[c] += f[c] * kPi / (n * n);
  }
  std::cout << "green felt, albedo at 30 degrees: " << albedo[0] << ' ' << albedo[1] << ' '
            << albedo[2] << '\n';
  const double expected[3] = {0.1166, 0.2358, 0.0341};
  for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(albedo[c] / expected[c] - 1) <= 0.01);
}

}  // namespace clothbrdf::test
