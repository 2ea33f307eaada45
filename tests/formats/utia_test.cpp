#include "formats/utia.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <numbers>

#include "model/reflectance.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

constexpr std::size_t kUtiaBytes = 1990656;

std::size_t place(std::size_t plane, std::size_t ti, std::size_t pi, std::size_t tv,
                  std::size_t pv) {
  return plane * 82944 + 288 * (48 * ti + pi) + 48 * tv + pv;
}

double stored_at(const std::string& file, std::size_t index) {
  double value = 0;
  std::memcpy(&value, file.data() + 8 * index, sizeof value);
  return value;
}

// What dj_brdf makes of a code, in the precision that it is built with: single on most machines.
template <class T>
T as_light(T code) {
  code /= T(140);
  const T light =
      code > T(0.0375) ? std::pow((code + T(0.055)) / T(1.055), T(2.4)) : code / T(12.92);
  return T(100) * light;
}

// A table on UTIA's grid: value(index) in the file's order.
Table utia_table(const std::function<double(std::size_t)>& value) {
  TableSpec spec{inout(), rgb_channels(), {}, {}};
  std::vector<double> values(std::size_t{3} * 82944);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t cell = 0; cell < 82944; ++cell) {
      values[(cell / 288 * 3 + c) * 288 + cell % 288] = value(c * 82944 + cell);
    }
  }
  return {spec, std::move(values), std::vector<std::uint8_t>(82944, 1)};
}

Vector3<double> random_direction(RandomInputs& random) {
  return direction(random.uniform(0, 89.9), random.uniform(-180, 180));
}

// Between the nodes as dj_brdf goes: bins, shares, 16 corners, then the curve.
double looked_up(const std::string& file, std::size_t plane, const Directions& d, bool codes) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double theta[2] = {std::acos(d.wi[2]) * kDegrees, std::acos(d.wo[2]) * kDegrees};
  const double phi[2] = {std::atan2(d.wi[1], d.wi[0]) * kDegrees,
                         std::atan2(d.wo[1], d.wo[0]) * kDegrees};
  double sum = 0;
  for (unsigned corner = 0; corner < 16; ++corner) {
    double weight = 1;
    std::size_t t[2];
    std::size_t p[2];
    for (unsigned k = 0; k < 2; ++k) {
      const double low = std::min(std::floor(theta[k] / 15), 4.0);
      const double upper = theta[k] / 15 - low;
      weight *= (corner >> k & 1U) != 0 ? upper : 1 - upper;
      t[k] = static_cast<std::size_t>(low) + (corner >> k & 1U);
      const double turned = phi[k] < 0 ? phi[k] + 360 : phi[k];
      const double left = std::floor(turned / 7.5);
      const double right_share = turned / 7.5 - left;
      weight *= (corner >> (2 + k) & 1U) != 0 ? right_share : 1 - right_share;
      p[k] = (static_cast<std::size_t>(left) + (corner >> (2 + k) & 1U)) % 48;
    }
    sum += weight * stored_at(file, place(plane, t[0], p[0], t[1], p[1]));
  }
  return std::max(0.0, codes ? as_light(sum) : sum);
}

}  // namespace

TEST_CASE("UTIA files hold planes of the light's and the eye's angles, as codes or as f_r") {
  const TemporaryFolder folder;
  // Not reciprocal: light and eye cannot be taken for each other.
  const Material material = read_material(preset("tamamushi_paper"));
  const ClothModel<double> model(material);
  const Table table = preset_table("tamamushi_paper", inout());
  write_table(table, folder / "t.bin");
  write_table(table, folder / "t.linear.bin");
  const std::string codes = read_file(folder / "t.bin");
  const std::string linear = read_file(folder / "t.linear.bin");
  REQUIRE(codes.size() == kUtiaBytes);
  REQUIRE(linear.size() == kUtiaBytes);
  double worst = 0;
  double worst_code = 0;
  for (std::size_t ti = 0; ti < 6; ++ti) {
    for (std::size_t pi = 0; pi < 48; pi += 5) {
      for (std::size_t tv = 0; tv < 6; ++tv) {
        for (std::size_t pv = 1; pv < 48; pv += 3) {
          const DirectionPair pair{15.0 * static_cast<double>(ti), 7.5 * static_cast<double>(pi),
                                   15.0 * static_cast<double>(tv), 7.5 * static_cast<double>(pv)};
          const PairGeometry<double> geometry = pair_geometry<double>(pair, material.rotation_deg);
          for (std::size_t c = 0; c < 3; ++c) {
            const double f = model.evaluate(geometry).total(c);
            const std::size_t index = place(c, ti, pi, tv, pv);
            worst = std::max(worst, std::abs(stored_at(linear, index) / f - 1));
            worst_code = std::max(worst_code, std::abs(as_light(stored_at(codes, index)) / f - 1));
          }
        }
      }
    }
  }
  std::cout << "UTIA nodes against the model: f_r off by " << worst << ", codes by " << worst_code
            << '\n';
  CHECK(worst < 1e-11);       // the batch kernel's accuracy
  CHECK(worst_code < 1e-11);  // no value of this cloth lies in the curve's gap
}

TEST_CASE(
    "UTIA files read back to the values that were written, outside the curve's gap to 1e-14") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  INFO("seed " << seed);
  RandomInputs random(seed);
  std::vector<double> values(std::size_t{3} * 82944);
  for (double& v : values) {
    v = random.chance(0.5) ? random.log_uniform(1e-12, 1e4) : random.uniform(0.28, 0.3);
  }
  values[7] = 0;
  const Table table = utia_table([&](std::size_t at) { return values[at]; });
  write_table(table, folder / "t.bin");
  write_table(table, folder / "t.linear.bin");
  const Table back = read_table(folder / "t.bin");
  const Table linear = read_table(folder / "t.linear.bin");
  CHECK(back.spec().samples == table.spec().samples);
  CHECK(back.spec().channels == table.spec().channels);
  CHECK(std::equal(linear.values().begin(), linear.values().end(), table.values().begin()));
  const std::string file = read_file(folder / "t.bin");
  double worst = 0;
  double worst_in_gap = 0;
  double worst_single = 0;
  int in_gap = 0;
  for (std::size_t at = 0; at < values.size(); ++at) {
    const double f = values[at];
    const double read = back.value(at % 82944, at / 82944);
    const double off = f == 0 ? read : std::abs(read / f - 1);
    if (f > 0.2902473 && f < 0.2903586) {
      worst_in_gap = std::max(worst_in_gap, off);
      ++in_gap;
    } else {
      worst = std::max(worst, off);
      const double single = as_light(static_cast<float>(stored_at(file, at)));
      worst_single = std::max(worst_single, f == 0 ? single : std::abs(single / f - 1));
    }
  }
  std::cout << "UTIA codes: off by " << worst << ", in the gap " << worst_in_gap << " (" << in_gap
            << " values), decoded in single precision " << worst_single << " (seed " << seed
            << ")\n";
  CHECK(in_gap > 100);
  CHECK(worst <= 1e-14);
  CHECK(worst_in_gap <= 2e-4);
  CHECK(worst_single <= 2e-6);
}

TEST_CASE("where a UTIA table looks along the normal, its azimuth does not count") {
  const TemporaryFolder folder;
  for (const char* const name : {"silk", "cotton_paper"}) {
    for (const bool codes : {false, true}) {
      const auto path = folder / (codes ? "t.bin" : "t.linear.bin");
      write_table(preset_table(name, inout()), path);
      const std::string file = read_file(path);
      bool equal = true;
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t p = 0; p < 48; ++p) {
          for (std::size_t other = 0; other < 288; ++other) {
            equal = equal && stored_at(file, place(c, 0, p, 0, other)) ==
                                 stored_at(file, place(c, 0, 0, 0, other));
            equal = equal && stored_at(file, place(c, other / 48, other % 48, 0, p)) ==
                                 stored_at(file, place(c, other / 48, other % 48, 0, 0));
          }
        }
      }
      INFO(name << (codes ? ", codes" : ", linear"));
      CHECK(equal);
    }
  }
}

TEST_CASE("between the nodes of a UTIA table its readers' rule holds, up to the horizon") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  INFO("seed " << seed);
  RandomInputs random(seed);
  // Steep enough that the line from 60 to 75 degrees falls below 0 beyond.
  const Table table = utia_table([&](std::size_t) { return random.uniform(0, 1); });
  for (const bool codes : {false, true}) {
    const auto path = folder / (codes ? "t.bin" : "t.linear.bin");
    write_table(table, path);
    const std::string file = read_file(path);
    const Table back = read_table(path);
    double worst = 0;
    int clamped = 0;
    int beyond = 0;
    for (int n = 0; n < 20000; ++n) {
      const Directions d = {random_direction(random), random_direction(random)};
      double values[3];
      REQUIRE(back.interpolate(d, values));
      for (std::size_t c = 0; c < 3; ++c) {
        const double expected = looked_up(file, c, d, codes);
        worst = std::max(worst, std::abs(values[c] - expected));
        clamped += expected == 0 ? 1 : 0;
      }
      beyond += d.wi[2] < std::cos(75 * std::numbers::pi / 180) ? 1 : 0;
    }
    std::cout << "UTIA between nodes: off by " << worst << ", " << clamped << " clamped (seed "
              << seed << ")\n";
    CHECK(worst < 1e-11);
    CHECK(clamped > 100);
    CHECK(beyond > 1000);
  }
  // At the nodes the rule gives what is stored_at there.
  const Table back = read_table(folder / "t.bin");
  double worst = 0;
  for (std::size_t cell = 0; cell < 82944; cell += 97) {
    if (cell < 48 * 288 || cell % 288 < 48) continue;  // along the normal no azimuth is known
    double values[3];
    back.interpolate(back.spec().directions(cell), values);
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(values[c] - back.value(cell, c)));
    }
  }
  CHECK(worst < 1e-12);
  CHECK(back.complete());
}

TEST_CASE("negative UTIA codes read as 0 and are counted, linear ones and NaN are kept") {
  const TemporaryFolder folder;
  std::string file(kUtiaBytes, '\0');
  const auto put = [&](std::size_t index, double value) {
    std::memcpy(file.data() + 8 * index, &value, 8);
  };
  put(5, -3);
  put(82944 + 6, -0.5);
  put(place(0, 2, 3, 1, 7), std::numeric_limits<double>::quiet_NaN());
  put(8, 140);
  write_file(folder / "m.bin", file);
  write_file(folder / "m.linear.bin", file);
  const Table codes = read_table(folder / "m.bin");
  CHECK(codes.spec().provenance.note == "2 negative codes: read as 0");
  CHECK(codes.value(5, 0) == 0);
  CHECK(codes.valid(5));
  CHECK(std::isnan(codes.value(place(0, 2, 3, 1, 7), 0)));
  CHECK(codes.value(8, 0) == 100);
  const Table linear = read_table(folder / "m.linear.bin");
  CHECK(linear.spec().provenance.note.empty());
  CHECK(linear.value(5, 0) == -3);
  CHECK(linear.value(6, 1) == -0.5);
  CHECK(std::isnan(linear.value(place(0, 2, 3, 1, 7), 0)));
  CHECK(linear.value(8, 0) == 140);
  double values[3];
  CHECK(!linear.interpolate(linear.spec().directions(place(0, 2, 3, 1, 7)), values));
  CHECK(values[0] == 0);
}

TEST_CASE("files of another size are no UTIA files, and tables of other grids are refused") {
  const TemporaryFolder folder;
  for (const char* const name : {"bad.bin", "bad.linear.bin"}) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, kUtiaBytes - 8, kUtiaBytes - 1,
                                   kUtiaBytes + 1, kUtiaBytes + 8}) {
      write_file(folder / name, std::string(size, '\0'));
      CHECK_THROWS_WITH(read_table(folder / name),
                        ContainsSubstring((folder / name).string() + ": ") &&
                            ContainsSubstring("1990656") && !ContainsSubstring("\n"));
      CHECK_THROWS_AS(read_table(folder / name), InputError);
    }
  }
  CHECK_THROWS_AS(read_table(folder / "absent.bin"), InputError);
  CHECK_THROWS_AS(read_table(folder.path()), InputError);
  const Format& format = format_for("t.bin");
  const auto spec = [&](const Samples& samples, bool components = false) {
    return material_spec(read_material(preset("silk")), {}, samples, {}, components);
  };
  const auto refused = [&](const TableSpec& bad, const std::string& part,
                           const WriteOptions& options = {}) {
    CHECK_THROWS_WITH(check_output(format, bad, options, "t.bin"),
                      ContainsSubstring("t.bin: ") && ContainsSubstring(part));
  };
  refused(spec(inout(6, 48, 6, 24)), "inout:6x48x6x24 is not allowed: UTIA holds the anisotropic");
  refused(spec(halfdiff4d()), "halfdiff4d");
  refused(spec(PairList{{{10, 0, 20, 0}}, false}), "1 pairs");
  refused(spec(format.default_samples(Reflectance::kPaper, true)), "an isotropic table");
  refused(spec(inout(), true), "12 channels");
  refused(spec(inout()), "--half", {.half = true});
  CHECK_NOTHROW(
      check_output(format, spec(format.default_samples(Reflectance::kPaper, false)), {}, "t.bin"));
  CHECK(find_format("x.LINEAR.bin")->name == "UTIA linear");
  CHECK(find_format("x.bin")->name == "UTIA");
}

TEST_CASE("an EXR table on UTIA's grid is the picture that ALTA reads as UTIA data") {
  const TemporaryFolder folder;
  const Table table = preset_table("silk_paper", inout());
  write_table(table, folder / "t.exr");
  write_table(table, folder / "t.linear.bin");
  const std::string file = read_file(folder / "t.linear.bin");
  Imf::InputFile in((folder / "t.exr").c_str());
  const Imath::Box2i window = in.header().dataWindow();
  REQUIRE(window.min == Imath::V2i(0, 0));
  REQUIRE(window.max == Imath::V2i(287, 287));
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> pixels(std::size_t{288} * 288);
    Imf::FrameBuffer frame;
    frame.insert(rgb_channels()[c].name,
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), 4, 288 * 4));
    in.setFrameBuffer(frame);
    in.readPixels(0, 287);
    bool equal = true;
    for (std::size_t cell = 0; cell < 82944; ++cell) {
      const std::size_t row = cell / 288;
      const std::size_t column = cell % 288;
      const float f = static_cast<float>(
          stored_at(file, place(c, row / 48, row % 48, column / 48, column % 48)));
      equal = equal && pixels[row * 288 + column] == f;
    }
    CHECK(equal);
  }
}

}  // namespace clothbrdf::test
