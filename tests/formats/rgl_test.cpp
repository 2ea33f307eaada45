#include "formats/rgl.h"

#include <algorithm>
#include <cmath>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/formats/strict_rgl.h"
#include "tests/formats/table_errors.h"

namespace clothbrdf::test {
namespace {

Material spectral_material(std::vector<double> wavelengths_nm) {
  Material material = read_material(preset("silk"));
  material.wavelengths_nm = std::move(wavelengths_nm);
  for (Yarn* yarn : {&material.warp, &material.weft}) {
    yarn->absorption.clear();
    for (std::size_t k = 0; k < material.wavelengths_nm.size(); ++k) {
      yarn->absorption.push_back(0.1 + 0.05 * static_cast<double>(k % 5));
    }
  }
  return material;
}

}  // namespace

TEST_CASE("an RGL file holds what every reader asks for") {
  const TemporaryFolder folder;
  const auto exact = pairs_of(read_material(preset("denim")));
  write_table(*exact, folder / "t.bsdf", {.bytes = 300000});
  const StrictRgl file(read_file(folder / "t.bsdf"));
  const auto& phi = file.values("phi_i");
  const auto& theta = file.values("theta_i");
  const std::size_t n = file.field("luminance").shape[2];
  REQUIRE(phi.size() >= 3);
  CHECK(phi.front() == static_cast<float>(-kPi));
  CHECK(phi.back() == static_cast<float>(kPi));
  CHECK(std::is_sorted(phi.begin(), phi.end(), std::less_equal<>()));
  CHECK(theta.front() == 0);
  CHECK(theta.back() < static_cast<float>(kPi / 2));
  CHECK(std::is_sorted(theta.begin(), theta.end(), std::less_equal<>()));
  using Shape = std::vector<std::uint64_t>;
  CHECK(file.field("rgb").shape == Shape{phi.size(), theta.size(), 3, n, n});
  CHECK(file.field("luminance").shape == Shape{phi.size(), theta.size(), n, n});
  CHECK(file.field("jacobian").values == "\1");
  CHECK(file.field("description").values.rfind("denim, by clothbrdf ", 0) == 0);
  for (const char* name : {"ndf", "sigma", "vndf", "luminance"}) {
    INFO(name);
    const auto& values = file.values(name);
    CHECK(std::all_of(values.begin(), values.end(),
                      [](float v) { return v > 0 && std::isfinite(v); }));
  }
  for (const char* name : {"vndf", "luminance", "rgb"}) {
    INFO(name);
    const auto& values = file.values(name);
    CHECK(std::all_of(values.begin(), values.end(), [](float v) { return v >= 0; }));
    const std::size_t column = values.size() / phi.size();
    const auto at = [&](std::size_t k) {
      return values.begin() + static_cast<std::ptrdiff_t>(k * column);
    };
    CHECK(std::equal(at(0), at(1), at(phi.size() - 1)));  // the first azimuth again
    float most = 0;
    for (std::size_t k = 1; k < phi.size(); ++k) {
      for (std::size_t v = 0; v < column / theta.size(); ++v) {
        const float here = at(k)[static_cast<std::ptrdiff_t>(v)];
        const float first = at(0)[static_cast<std::ptrdiff_t>(v)];
        most = std::max(most, std::abs(here - first) / std::max(first, 1e-3F));
      }
    }
    CHECK(most <= 1e-4F);  // at the pole azimuths of the eye are one direction
  }
}

TEST_CASE("an RGL file has the same bytes for any number of threads") {
  const TemporaryFolder folder;
  const auto exact = pairs_of(read_material(preset("tamamushi")));
  write_table(*exact, folder / "1.bsdf", {.bytes = 300000, .workers = 1});
  const std::string one = read_file(folder / "1.bsdf");
  for (const int threads : {2, 5}) {
    write_table(*exact, folder / "n.bsdf", {.bytes = 300000, .workers = threads});
    CHECK((read_file(folder / "n.bsdf") == one));
  }
}

TEST_CASE("an RGL file says what it was made of, and its nodes hold what its rule gives there") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  for (const bool isotropic : {false, true}) {
    const Material material = random.material(MaterialRanges{});
    const auto exact = pairs_of(material, isotropic);
    write_table(*exact, folder / "t.bsdf", {.bytes = 200000});
    const Table table = read_table(folder / "t.bsdf");
    CHECK(table.spec().provenance == exact->spec().provenance);
    CHECK(table.spec().channels == exact->spec().channels);
    CHECK(table.spec().isotropic() == isotropic);
    CHECK(table.complete());
    double worst = 0;
    std::size_t valid = 0;
    for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
      const Directions node = table.spec().directions(cell);
      CHECK(table.valid(cell) == node.above_horizon());
      if (!table.valid(cell) || node.wi[2] < 1e-3) continue;
      ++valid;
      std::vector<double> f(3);
      table.interpolate(node, f);
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = table.value(cell, c);
        worst = std::max(worst, std::abs(f[c] - value) / std::max(value, 1e-3));
      }
    }
    INFO("seed " << seed);
    CHECK(valid > table.spec().cell_count() / 2);
    // Floats of azimuths reach a little beyond pi; half vectors at the pole lose their azimuth.
    CHECK(worst <= 1e-3);
  }
}

TEST_CASE("a spectral RGL file holds the wavelengths of its table") {
  const TemporaryFolder folder;
  const Material material = spectral_material({400, 1250.0 / 3, 500, 600.5, 700});
  const auto exact = pairs_of(material);
  const WriteOptions options{.flavour = Flavour::kSpectral, .bytes = 3000000};
  write_table(*exact, folder / "t.bsdf", options);
  const auto fields = strict_fields(read_file(folder / "t.bsdf"));
  CHECK(!fields.contains("rgb"));
  CHECK(floats_of(fields.at("wavelengths")) ==
        std::vector<float>{400, 416.6666667F, 500, 600.5, 700});
  const Table table = read_table(folder / "t.bsdf");
  CHECK(table.spec().channels == exact->spec().channels);
  const Errors e = errors_of(table, *exact);
  CHECK(e.median <= 0.6);
  CHECK(e.p95 <= 4);
  const StrictRgl strict(read_file(folder / "t.bsdf"));
  RandomInputs random(seed_from_environment());
  for (const Directions& pair : uniform_pairs(random, 50, 80)) {
    std::vector<double> f(5);
    table.interpolate(pair, f);
    const std::vector<double> expected = strict.f(pair.wi, pair.wo);
    for (std::size_t c = 0; c < 5; ++c) CHECK(std::abs(f[c] - expected[c]) <= 1e-6 * expected[c]);
  }
  TableSpec descending = exact->spec();
  std::swap(descending.channels[0], descending.channels[2]);
  CHECK_THROWS_WITH(
      check_output(rgl_format(), descending, options, "d.bsdf"),
      ContainsSubstring("d.bsdf: the wavelength 416.66") && ContainsSubstring("after 500"));
}

TEST_CASE("an RGL file is never larger than asked, and a size too small is refused") {
  const TemporaryFolder folder;
  const auto exact = pairs_of(read_material(preset("cotton")));
  const auto refusal = [&](std::uint64_t bytes) -> std::string {
    try {
      check_output(rgl_format(), exact->spec(), {.bytes = bytes}, "t.bsdf");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string text = refusal(1000);
  CHECK(text.rfind("t.bsdf: --size 1000 is too small", 0) == 0);
  const std::uint64_t smallest = std::stoull(text.substr(text.find(" has ") + 5));
  CHECK(!refusal(smallest - 1).empty());
  std::uint64_t before = 0;
  for (std::uint64_t bytes = smallest; bytes < 2 * smallest; bytes += smallest / 7) {
    write_table(*exact, folder / "t.bsdf", {.bytes = bytes});
    const std::uint64_t written = std::filesystem::file_size(folder / "t.bsdf");
    CHECK(written <= bytes);
    CHECK(written >= before);
    before = written;
    CHECK_NOTHROW(read_table(folder / "t.bsdf"));
  }
}

TEST_CASE("what RGL files cannot hold is refused") {
  const auto refused = [](const Material& material, const Samples& samples,
                          const WriteOptions& options, const std::string& part,
                          bool components = false) {
    const TableSpec spec = material_spec(material, {}, samples, {}, components);
    CHECK_THROWS_WITH(check_output(rgl_format(), spec, options, "t.bsdf"),
                      ContainsSubstring("t.bsdf: ") && ContainsSubstring(part));
  };
  const Material silk = read_material(preset("silk"));
  refused(silk, halfdiff4d(2, 2, 2, 2), {}, "nodes of their own");
  refused(silk, PairList{{{1, 2, 3, 4}}}, {}, "1 pairs");
  refused(silk, AnyPairs{}, {.half = true}, "--half");
  refused(silk, AnyPairs{}, {}, "R, G and B only", true);
  refused(silk, AnyPairs{}, {.flavour = Flavour::kSpectral}, "wavelengths only");
  refused(spectral_material({500, 600}), AnyPairs{}, {}, "R, G and B only");
}

TEST_CASE("a black or a broken table makes a file that can be read") {
  const TemporaryFolder folder;
  class Broken final : public Producer {
   public:
    explicit Broken(double value) : value_(value) {
      spec_.samples = AnyPairs{};
      spec_.channels = rgb_channels();
    }
    const TableSpec& spec() const override { return spec_; }
    void fill_rows(std::size_t, std::span<double>) const override {}
    void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override {
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = pairs[k / 3].above_horizon() ? value_ : 0;
      }
    }

   private:
    TableSpec spec_;
    double value_;
  };
  for (const double value : {0.0, -1.0, std::nan(""), 1e-30}) {
    INFO(value);
    write_table(Broken(value), folder / "t.bsdf", {.bytes = 100000});
    const auto fields = strict_fields(read_file(folder / "t.bsdf"));
    for (const char* name : {"ndf", "sigma", "vndf", "luminance"}) {
      const std::vector<float> values = floats_of(fields.at(name));
      CHECK(std::all_of(values.begin(), values.end(),
                        [](float v) { return v > 0 && std::isfinite(v); }));
    }
    const Table table = read_table(folder / "t.bsdf");
    std::vector<double> f(3);
    // What is no number is no answer.
    CHECK(table.interpolate({{0.6, 0, 0.8}, {0, 0.6, 0.8}}, f) == std::isfinite(value));
    if (std::isfinite(value)) CHECK(std::abs(f[1] - value) <= 0.02 * std::abs(value));
  }
}

}  // namespace clothbrdf::test
