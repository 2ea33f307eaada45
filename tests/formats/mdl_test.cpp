#include "formats/mdl.h"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <limits>
#include <numbers>

#include "model/reflectance.h"
#include "support/errors.h"
#include "table/resample.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"
#include "tests/support/shared_data.h"

namespace clothbrdf::test {
namespace {

// A strict reader of the published layout: one block of reflection and nothing after it.
struct Mbsdf {
  std::string keys;
  std::uint32_t type = 0;
  std::uint32_t theta = 0;
  std::uint32_t phi = 0;
  std::vector<float> numbers;

  std::size_t channels() const { return type == 1 ? 3 : 1; }
  float at(std::size_t i, std::size_t o, std::size_t p, std::size_t c) const {
    return numbers[channels() * (i * phi * theta + o * phi + p) + c];
  }
};

Mbsdf strictly_read(const std::string& file) {
  const std::string magic = "NVIDIA ARC MBSDF V1\n";
  const std::string data = "\nMBSDF_DATA_REFLECTION=\n";
  REQUIRE(file.substr(0, magic.size()) == magic);
  const std::size_t end = file.find(data);
  REQUIRE(end != std::string::npos);
  Mbsdf mbsdf;
  mbsdf.keys = file.substr(magic.size(), end + 1 - magic.size());
  const char* at = file.data() + end + data.size();
  std::memcpy(&mbsdf.type, at, 4);
  std::memcpy(&mbsdf.theta, at + 4, 4);
  std::memcpy(&mbsdf.phi, at + 8, 4);
  const std::size_t bytes = 4 * mbsdf.channels() * mbsdf.theta * mbsdf.theta * mbsdf.phi;
  REQUIRE(file.size() == end + data.size() + 12 + bytes);
  mbsdf.numbers.resize(bytes / 4);
  std::memcpy(mbsdf.numbers.data(), at + 12, bytes);
  return mbsdf;
}

std::string file_text(std::uint32_t type, std::uint32_t theta, std::uint32_t phi,
                      const std::vector<float>& numbers, const std::string& head,
                      const std::string& magic = "NVIDIA ARC MBSDF V1\n") {
  const std::uint32_t sizes[] = {type, theta, phi};
  return magic + head + std::string(reinterpret_cast<const char*>(sizes), sizeof sizes) +
         std::string(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
}

TableSpec mdl_spec(const Material& material) {
  return material_spec(material, {}, mdl_format().default_samples(material.reflectance, false));
}

void write_material(const Material& material, const std::filesystem::path& path,
                    const WriteOptions& options = {}) {
  write_table(*make_producer(mdl_spec(material), 1), path, options);
}

// As the SDK's readers look a value up: the mean of both orders in texels of three axes.
double looked_up(const Mbsdf& file, const Directions& d, std::size_t c) {
  const double theta_i = std::acos(d.wi[2]) * 2 / std::numbers::pi;
  const double theta_o = std::acos(d.wo[2]) * 2 / std::numbers::pi;
  double phi = std::atan2(d.wo[1], d.wo[0]) - std::atan2(d.wi[1], d.wi[0]);
  if (phi < 0) phi += 2 * std::numbers::pi;
  if (phi > std::numbers::pi) phi = 2 * std::numbers::pi - phi;
  const auto texel = [](double share, std::uint32_t size, unsigned side, double& weight) {
    const double at = std::clamp(share * size - 0.5, 0.0, size - 1.0);
    weight *= side != 0 ? at - std::floor(at) : 1 - (at - std::floor(at));
    return std::min(static_cast<std::size_t>(at) + side, std::size_t{size} - 1);
  };
  double sum = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1;
    const std::size_t i = texel(theta_i, file.theta, corner & 1U, weight);
    const std::size_t o = texel(theta_o, file.theta, corner >> 1U & 1U, weight);
    const std::size_t p = texel(phi / std::numbers::pi, file.phi, corner >> 2U, weight);
    sum += weight * (double{file.at(i, o, p, c)} + double{file.at(o, i, p, c)}) / 2;
  }
  return sum;
}

// f_r of a cloth in R, G and B, the mean over rotations by brute force.
std::array<double, 3> mean_over_rotations(const ClothModel<double>& model,
                                          const DirectionPair& pair) {
  constexpr int kTurns = 360;
  std::array<double, 3> mean{};
  for (int k = 0; k < kTurns; ++k) {
    const Components f = model.evaluate(pair_geometry<double>(pair, 360.0 * k / kTurns));
    for (std::size_t c = 0; c < 3; ++c) mean[c] += f.total(c) / kTurns;
  }
  return mean;
}

}  // namespace

TEST_CASE("an MDL file holds the mean over rotations and both orders at the centres of its steps") {
  const TemporaryFolder folder;
  for (const char* const name : {"tamamushi", "silk_paper"}) {
    const Material material = read_material(preset(name));
    write_material(material, folder / "t.mbsdf", {.bytes = 100000});
    const std::string text = read_file(folder / "t.mbsdf");
    const Mbsdf file = strictly_read(text);
    CHECK(file.type == 1);
    CHECK(file.theta == 16);  // 24 * 16^3 bytes, and no more fit into 100,000
    CHECK(file.phi == 32);
    CHECK(text.size() <= 100000);
    CHECK(file.keys.find("program=\"clothbrdf ") == 0);
    const ClothModel<double> model(material);
    double worst = 0;
    double order_matters = 0;
    for (std::size_t i = 0; i < 16; i += 5) {
      for (std::size_t o = 1; o < 16; o += 3) {
        for (std::size_t p = 1; p < 32; p += 6) {
          const auto middle = [](std::size_t k, double step) {
            return (static_cast<double>(k) + 0.5) * step;
          };
          const DirectionPair pair{middle(i, 90.0 / 16), 0, middle(o, 90.0 / 16),
                                   middle(p, 180.0 / 32)};
          const DirectionPair swapped{pair.theta_o, pair.phi_o, pair.theta_i, pair.phi_i};
          const std::array<double, 3> one = mean_over_rotations(model, pair);
          const std::array<double, 3> other = mean_over_rotations(model, swapped);
          for (std::size_t c = 0; c < 3; ++c) {
            const double f = (one[c] + other[c]) / 2;
            worst = std::max(worst, std::abs(file.at(i, o, p, c) / f - 1));
            order_matters = std::max(order_matters, std::abs(one[c] / f - 1));
            CHECK(file.at(i, o, p, c) == file.at(o, i, p, c));
          }
        }
      }
    }
    std::cout << "MDL nodes of " << name << ": off by " << worst
              << " of the mean; orders differ from it by up to " << order_matters << '\n';
    CHECK(worst < 0x1p-23);
    CHECK((order_matters > 0.1) == (material.reflectance == Reflectance::kPaper));
  }
}

TEST_CASE("the usual MDL file has 45 x 45 x 90 nodes, and --size finds the largest that fits") {
  const TemporaryFolder folder;
  const Format& format = format_for("t.mbsdf");
  const TableSpec spec = mdl_spec(read_material(preset("silk")));
  CHECK(format.layout(spec, {}).description == "45x45x90");
  CHECK(format.layout(spec, {}).cells == 182250);
  write_material(read_material(preset("silk")), folder / "t.mbsdf");
  const std::uint64_t bytes = std::filesystem::file_size(folder / "t.mbsdf");
  CHECK(bytes > 2187000);
  CHECK(bytes < 2187200);
  CHECK(format.layout(spec, {.bytes = bytes}).description == "45x45x90");
  CHECK(format.layout(spec, {.bytes = bytes - 1}).description == "44x44x88");
  CHECK(format.layout(spec, {.bytes = ~std::uint64_t{0}}).description == "1289x1289x2578");
  CHECK_THROWS_WITH(check_output(format, spec, {.bytes = 100}, "t.mbsdf"),
                    ContainsSubstring("t.mbsdf: --size: 100 bytes are not allowed"));
}

TEST_CASE("an MDL file reads back to its numbers, and between them to what its readers see") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  INFO("seed " << seed);
  RandomInputs random(seed);
  const Material material = random.material({});
  write_material(material, folder / "t.mbsdf", {.bytes = 30000});
  const Mbsdf file = strictly_read(read_file(folder / "t.mbsdf"));
  const Table back = read_table(folder / "t.mbsdf");
  REQUIRE(back.spec().has_pairs());
  CHECK(back.spec().isotropic());
  CHECK(back.complete());
  CHECK(back.spec().channels == rgb_channels());
  REQUIRE(back.values().size() == file.numbers.size());
  CHECK(std::equal(back.values().begin(), back.values().end(), file.numbers.begin()));
  CHECK(back.spec().provenance.note.find("program=\"clothbrdf ") == 0);
  CHECK(back.spec().provenance.note.find("differ") == std::string::npos);
  double worst = 0;
  double at_nodes = 0;
  double highest = 0;
  for (int n = 0; n < 20000; ++n) {
    const Directions d = {direction(random.uniform(0, 89.99), random.uniform(-180, 180)),
                          direction(random.uniform(0, 89.99), random.uniform(-180, 180))};
    double values[3];
    REQUIRE(back.interpolate(d, values));
    for (std::size_t c = 0; c < 3; ++c) {
      const double f = looked_up(file, d, c);
      highest = std::max(highest, f);
      worst = std::max(worst, std::abs(values[c] - f));
    }
  }
  for (std::size_t node = 0; node < back.spec().cell_count(); ++node) {
    double values[3];
    back.interpolate(back.spec().directions(node), values);
    for (std::size_t c = 0; c < 3; ++c) {
      at_nodes = std::max(at_nodes, std::abs(values[c] - back.value(node, c)));
    }
  }
  std::cout << "MDL between nodes: off by " << worst << ", at nodes by " << at_nodes << " of up to "
            << highest << " (seed " << seed << ")\n";
  CHECK(worst <= 1e-10 * highest);
  CHECK(at_nodes <= 1e-10 * highest);
  // Written again from the table, by its own interpolation: the same numbers.
  write_table(TablePairs(back, true), folder / "again.mbsdf", {.bytes = 30000});
  const Mbsdf again = strictly_read(read_file(folder / "again.mbsdf"));
  double off = 0;
  for (std::size_t k = 0; k < file.numbers.size(); ++k) {
    off = std::max(off, std::abs(double{again.numbers[k]} / file.numbers[k] - 1));
  }
  CHECK(off <= 0x1p-22);
}

TEST_CASE("MDL's own file of 2 x 2 x 3 nodes reads, as the mean of both orders") {
  const auto path = shared_data("mdl_test_rgb_theta_2_phi_3.mbsdf");
  if (path.empty()) return;
  const Table table = read_table(path);
  REQUIRE(table.spec().cell_count() == 12);
  CHECK(table.spec().pairs()[0] == DirectionPair{22.5, 0, 22.5, 30});
  CHECK(table.spec().pairs()[4] == DirectionPair{22.5, 0, 67.5, 90});
  CHECK(table.spec().pairs()[6] == DirectionPair{67.5, 0, 22.5, 30});
  // The file counts from 0 up in its own order.
  CHECK(table.value(0, 0) == 0);
  CHECK(table.value(2, 1) == 7);
  CHECK(table.value(11, 2) == 35);
  CHECK(table.value(4, 0) == (12 + 21) / 2.0);
  CHECK(table.value(7, 0) == (12 + 21) / 2.0);
  CHECK(table.spec().provenance.note.find("their mean was taken") != std::string::npos);
}

TEST_CASE("MDL files of one number a node, of keys and of transmission read with a note") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    write_file(folder / "t.mbsdf", text);
    return read_table(folder / "t.mbsdf");
  };
  const std::vector<float> two = {0.25F, 0.5F};
  const Table mono = read(file_text(0, 1, 2, two, "a=\"b \\\" c\"\nd=\"\"\nMBSDF_DATA=\n"));
  REQUIRE(mono.spec().channels.size() == 1);
  CHECK(mono.spec().channels[0].name == "mono");
  CHECK(mono.value(1, 0) == 0.5);
  CHECK(mono.spec().provenance.note == "a=\"b \\\" c\"; d=\"\"");
  double value[1];
  CHECK(mono.interpolate({direction(80.0, 3.0), direction(1.0, 93.0)}, value));
  CHECK(std::abs(value[0] - 0.375) < 1e-12);
  const std::string transmission = file_text(1, 1, 1, {1, 2, 3}, "MBSDF_DATA_TRANSMISSION=\n", "");
  const Table both = read(file_text(0, 1, 2, two, "MBSDF_DATA_REFLECTION=\n") + transmission);
  CHECK(both.value(0, 0) == 0.25);
  CHECK(both.spec().provenance.note == "its block of transmission was left out");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Table hole = read(file_text(0, 1, 2, {nan, 0.5F}, "MBSDF_DATA=\n"));
  CHECK(std::isnan(hole.value(0, 0)));
  CHECK(!hole.interpolate({direction(45.0, 0.0), direction(45.0, 10.0)}, value));
  CHECK(value[0] == 0);
}

TEST_CASE("what is not an MDL file is refused in one line, and so is each piece of one") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const std::string& part) {
    write_file(folder / "bad.mbsdf", content);
    CHECK_THROWS_WITH(read_table(folder / "bad.mbsdf"),
                      ContainsSubstring((folder / "bad.mbsdf").string() + ": ") &&
                          ContainsSubstring(part) && !ContainsSubstring("\n"));
    CHECK_THROWS_AS(read_table(folder / "bad.mbsdf"), InputError);
  };
  const std::vector<float> two = {0.25F, 0.5F};
  const std::string reflection = "MBSDF_DATA_REFLECTION=\n";
  const std::string good = file_text(0, 1, 2, two, "key=\"value\"\n" + reflection);
  const std::string whole = good + file_text(0, 1, 2, two, "MBSDF_DATA_TRANSMISSION=\n", "");
  refused(file_text(0, 1, 2, two, reflection, "NVIDIA ARC MBSDF V2\n"), "NVIDIA ARC MBSDF V1");
  refused(file_text(0, 1, 2, two, "key=value\n" + reflection), "'key=value' is no line");
  refused(file_text(0, 1, 2, two, "MBSDF_DATA_TRANSMISSION=\n"), "transmission only");
  refused(file_text(2, 1, 2, two, reflection), "type 2");
  refused(file_text(0, 0, 2, two, reflection), "0 x 0 x 2 nodes");
  refused(file_text(0, 1, 0, two, reflection), "1 x 1 x 0 nodes");
  refused(file_text(0, 1, 3, two, reflection), "too short for 1 x 1 x 3 nodes");
  refused(file_text(1, 0xFFFFFFFF, 0xFFFFFFFF, two, reflection), "too short for 4294967295");
  refused(file_text(0, 0x80000000, 4, two, reflection), "too short");
  refused(good + "x", "a line has no end");
  refused(good + "\n", "bytes follow the last number");
  refused(whole + std::string(1, '\0'), "bytes follow the last number");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    if (size != good.size()) refused(whole.substr(0, size), "");
  }
  CHECK_THROWS_AS(read_table(folder / "absent.mbsdf"), InputError);
  CHECK_THROWS_AS(read_table(folder.path()), InputError);
}

TEST_CASE("any byte of an MDL header may change: the same numbers are read, or it is refused") {
  const TemporaryFolder folder;
  write_material(read_material(preset("silk")), folder / "t.mbsdf", {.bytes = 1000});
  const std::string good = read_file(folder / "t.mbsdf");
  const Table table = read_table(folder / "t.mbsdf");
  const std::size_t header = good.find("MBSDF_DATA_REFLECTION=\n") + 23 + 12;
  int read = 0;
  int refused = 0;
  for (std::size_t at = 0; at < header; ++at) {
    for (const int change : {0, 1, 10, 34, 61, 65, 128, 255}) {
      std::string changed = good;
      changed[at] = static_cast<char>(change);
      if (changed == good) continue;
      write_file(folder / "c.mbsdf", changed);
      try {
        const Table other = read_table(folder / "c.mbsdf");
        INFO("byte " << at << " made " << change);
        CHECK(other.spec().samples == table.spec().samples);
        CHECK(std::equal(other.values().begin(), other.values().end(), table.values().begin()));
        ++read;
      } catch (const InputError& error) {
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        ++refused;
      }
    }
  }
  std::cout << "changed MDL headers: " << read << " read, " << refused << " refused\n";
  CHECK(read > 100);  // in the keys
  CHECK(refused > 300);
}

TEST_CASE("a table that MDL cannot hold is refused, and so is a value beyond its floats") {
  const TemporaryFolder folder;
  const Format& format = format_for("t.mbsdf");
  const auto refused = [&](const Samples& samples, const std::string& part) {
    const TableSpec spec = material_spec(read_material(preset("silk")), {}, samples);
    CHECK_THROWS_WITH(check_output(format, spec, {}, "t.mbsdf"),
                      ContainsSubstring("t.mbsdf: ") && ContainsSubstring(part));
  };
  refused(halfdiff3d(), "halfdiff3d:90x90x180 is not allowed: MDL has nodes of its own");
  refused(PairList{{{10, 0, 20, 0}}, true}, "1 pairs, isotropic is not allowed");
  refused(AnyPairs{false}, "isotropic tables only");
  const TableSpec spec{halfdiff3d(2, 2, 2), rgb_channels(), {}, {}};
  const Table huge(spec, std::vector<double>(24, 0x1p130), std::vector<std::uint8_t>(8, 1));
  CHECK_THROWS_WITH(write_table(TablePairs(huge, true), folder / "t.mbsdf", {.bytes = 400}),
                    ContainsSubstring("R is 1.3611") && ContainsSubstring("e+39 at theta_i 22.5"));
  CHECK(!std::filesystem::exists(folder / "t.mbsdf"));
}

}  // namespace clothbrdf::test
