#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "formats/rgl.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/formats/strict_rgl.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Fields = std::vector<TensorBytes>;
using Shape = std::vector<std::uint64_t>;

constexpr double kPi = 3.14159265358979323846;

// A small file of random content: phi_i from -pi on.
Fields small_fields(RandomInputs& random, std::size_t phi, double phi_range) {
  std::vector<float> phi_i(phi);
  for (std::size_t k = 0; k < phi; ++k) {
    phi_i[k] = static_cast<float>(-kPi + phi_range * static_cast<double>(k) /
                                             std::max(1.0, static_cast<double>(phi - 1)));
  }
  const auto randoms = [&](const std::string& name, Shape shape) {
    std::size_t count = 1;
    for (const std::uint64_t size : shape) count *= size;
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random.uniform(0.5, 2));
    return tensor_of(name, 10, std::move(shape), values);
  };
  const std::string text = "random";
  return {tensor_of("description", 1, {text.size()}, std::vector<char>(text.begin(), text.end())),
          tensor_of("phi_i", 10, {phi}, phi_i),
          tensor_of("theta_i", 10, {2}, std::vector<float>{0, 1.5F}),
          randoms("ndf", {2, 3}),
          randoms("sigma", {2, 2}),
          randoms("vndf", {phi, 2, 2, 3}),
          randoms("luminance", {phi, 2, 2, 2}),
          randoms("rgb", {phi, 2, 3, 2, 2}),
          tensor_of("jacobian", 1, {1}, std::vector<char>{1})};
}

TensorBytes& field_of(Fields& fields, const std::string& name) {
  return *std::find_if(fields.begin(), fields.end(),
                       [&](const TensorBytes& f) { return f.name == name; });
}

Table read_bytes(const TemporaryFolder& folder, const std::string& bytes) {
  write_file(folder / "t.bsdf", bytes);
  return format_for("t.bsdf").read(folder / "t.bsdf");
}

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

TEST_CASE("every truncation of an RGL file is refused") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const std::string bytes = tensor_file(small_fields(random, 3, 2 * kPi));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    INFO(length << " of " << bytes.size() << " bytes");
    CHECK_THROWS_AS(read_bytes(folder, bytes.substr(0, length)), InputError);
  }
  CHECK_THROWS_WITH(read_bytes(folder, bytes.substr(0, bytes.size() - 1)),
                    ContainsSubstring("field 'jacobian': its values go beyond the end"));
  CHECK_NOTHROW(read_bytes(folder, bytes));
  CHECK_THROWS_WITH(read_bytes(folder, bytes + std::string(5000, 'x')),
                    ContainsSubstring("bytes follow"));
}

TEST_CASE("a changed byte in the head of an RGL file is refused or changes no shape") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const Fields fields = small_fields(random, 3, 2 * kPi);
  const std::string bytes = tensor_file(fields);
  const Table whole = read_bytes(folder, bytes);
  int refused = 0;
  int read = 0;
  for (std::size_t at = 0; at < header_size(fields); ++at) {
    for (const int value : {0, 1, 7, 10, 0x7f, 0x80, 0xff, bytes[at] + 1, bytes[at] ^ 0x40}) {
      std::string changed = bytes;
      changed[at] = static_cast<char>(value);
      if (changed == bytes) continue;
      INFO("byte " << at << " is " << value);
      try {
        const Table table = read_bytes(folder, changed);
        CHECK(table.spec().cell_count() == whole.spec().cell_count());
        CHECK(table.spec().channels == whole.spec().channels);
        ++read;
      } catch (const InputError& error) {
        const std::string text = error.what();
        CHECK(text.rfind((folder / "t.bsdf").string() + ": ", 0) == 0);
        CHECK(text.find('\n') == std::string::npos);
        ++refused;
      }
    }
  }
  std::cout << "changed heads of RGL files: " << refused << " refused, " << read << " read\n";
  CHECK(refused > 1000);
  // Names of fields that may be missing, and the text's length.
  CHECK(read < 200);
}

TEST_CASE("an RGL file that contradicts itself is refused in one line") {
  const TemporaryFolder folder;
  RandomInputs random(seed_from_environment());
  const Fields good = small_fields(random, 4, 2 * kPi);
  const auto refused = [&](const std::string& name, const TensorBytes& field,
                           const std::string& part) {
    Fields fields = good;
    field_of(fields, name) = field;
    CHECK_THROWS_WITH(read_bytes(folder, tensor_file(fields)), ContainsSubstring("t.bsdf: ") &&
                                                                   ContainsSubstring(part) &&
                                                                   !ContainsSubstring("\n"));
  };
  const auto floats = [](const std::string& name, Shape shape, const std::vector<float>& values) {
    return tensor_of(name, 10, std::move(shape), values);
  };
  const float nan = std::nanf("");
  refused("theta_i", floats("theta_i", {2}, {0.5F, 0.5F}), "ascending");
  refused("theta_i", floats("theta_i", {2}, {0, 2}), "'theta_i': node 1 is 2");
  refused("theta_i", floats("theta_i", {2}, {0, nan}), "'theta_i'");
  refused("theta_i", floats("theta_i", {1, 2}, {0, 1}), "one dimension");
  refused("theta_i", floats("theta_i", {3}, {0, 1, 1.5F}), "'vndf': its shape 4 x 2 x 2 x 3");
  refused("ndf", floats("ndf", {1, 6}, std::vector<float>(6, 1)), "'ndf': its shape 1 x 6");
  refused("ndf", floats("ndf", {2, 2}, {1, 1, -1, 1}), "'ndf' holds -1");
  refused("vndf", floats("vndf", {4, 2, 2, 2}, std::vector<float>(32, nan)), "'vndf' holds nan");
  refused("rgb", floats("rgb", {4, 2, 4, 2, 2}, std::vector<float>(128, 1)), "3 channels");
  refused("luminance", floats("luminance", {4, 2, 2, 3}, std::vector<float>(48, 1)), "N x N");
  refused("luminance", floats("light", {4, 2, 2, 2}, std::vector<float>(32, 1)),
          "'luminance' is missing");
  refused("sigma", floats("ndf", {2, 2}, {1, 1, 1, 1}), "'ndf' is there twice");
  refused("jacobian", tensor_of("jacobian", 12, {1}, std::vector<char>{1}), "type 12");
  refused("description", tensor_of("description", 1, {0}, std::vector<char>{}), "holds nothing");
  // The second field's values where the first one's are: 18 bytes of file head, 13 and the name and
  // 8 for one dimension of each field.
  std::string shared = tensor_file(good);
  const std::size_t first = 18 + 2 + 11 + 2 + 1;
  const std::size_t second = 18 + 13 + 11 + 8 + 2 + 5 + 2 + 1;
  shared.replace(second, 8, shared.substr(first, 8));
  CHECK_THROWS_WITH(read_bytes(folder, shared),
                    ContainsSubstring("its values do not follow the others'"));
  CHECK_THROWS_WITH(read_bytes(folder, "tensor_file"), ContainsSubstring("no RGL tensor file"));
  CHECK_THROWS_AS(format_for("t.bsdf").read(folder / "absent.bsdf"), InputError);
  CHECK_THROWS_AS(format_for("t.bsdf").read(folder.path()), InputError);
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
