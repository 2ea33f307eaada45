#include "formats/alta.h"

#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>

#include "model/reflectance.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"
#include "tests/support/random_inputs.h"
#include "tests/support/shared_data.h"

namespace clothbrdf::test {
namespace {

// A strict reader that goes as ALTA's own does: header lines as long as the next byte is a '#', or
// up to '#ALTA END HEADER'; then numbers by >>, or as they are.
struct AltaFile {
  std::map<std::string, std::string> keys;
  int inputs = 0;
  int outputs = 0;
  std::vector<std::vector<double>> rows;
};

AltaFile as_alta_reads(const std::string& text) {
  AltaFile file;
  std::istringstream in(text);
  while (in.peek() == '#') {
    std::string line;
    std::getline(in, line);
    std::istringstream words(line.substr(1));
    std::string key;
    std::string value;
    words >> key >> std::ws;
    std::getline(words, value);
    if (key == "ALTA" && value == "END HEADER") break;
    file.keys[key] = value;
  }
  std::istringstream dim(file.keys.at("DIM"));
  dim >> file.inputs >> file.outputs;
  const auto columns = static_cast<std::size_t>(file.inputs + file.outputs);
  REQUIRE(file.keys.at("VS") == "0");
  if (file.keys.contains("FORMAT")) {
    REQUIRE(file.keys.at("FORMAT") == "binary");
    REQUIRE(file.keys.at("VERSION") == "0");
    REQUIRE(file.keys.at("PRECISION") == "ieee754-double");
    REQUIRE(file.keys.at("ENDIAN") == "little");
    for (int n = std::stoi(file.keys.at("SAMPLE_COUNT")); n > 0; --n) {
      std::vector<double> row(columns);
      in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(8 * columns));
      REQUIRE(in.good());
      file.rows.push_back(row);
    }
    const std::string rest(std::istreambuf_iterator<char>(in), {});
    REQUIRE(rest == "\n#END_STREAM\n");
    return file;
  }
  std::string line;
  while (std::getline(in, line)) {
    REQUIRE(line.at(0) != '#');
    std::istringstream numbers(line);
    std::vector<double> row(columns);
    for (double& x : row) numbers >> x;
    REQUIRE(!numbers.fail());
    REQUIRE((numbers >> std::ws).eof());
    file.rows.push_back(row);
  }
  REQUIRE(static_cast<int>(file.rows.size()) == std::stoi(file.keys.at("SAMPLE_COUNT")));
  return file;
}

using Vector = Vector3<double>;

Vector spherical(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// ALTA's half/difference angles: the difference vector is the eye's.
Directions from_half(double theta_h, double phi_h, double theta_d, double phi_d) {
  const Vector d = spherical(theta_d, phi_d);
  const double x = d[0] * std::cos(theta_h) + d[2] * std::sin(theta_h);
  const Vector view = {x * std::cos(phi_h) - d[1] * std::sin(phi_h),
                       x * std::sin(phi_h) + d[1] * std::cos(phi_h),
                       d[2] * std::cos(theta_h) - d[0] * std::sin(theta_h)};
  const Vector h = spherical(theta_h, phi_h);
  const double dot = view[0] * h[0] + view[1] * h[1] + view[2] * h[2];
  return {{2 * dot * h[0] - view[0], 2 * dot * h[1] - view[1], 2 * dot * h[2] - view[2]}, view};
}

Directions directions_of(const AltaFile& file, const std::vector<double>& x) {
  const std::string& in = file.keys.at("PARAM_IN");
  if (in == "RUSIN_TH_PH_TD_PD") return from_half(x[0], x[1], x[2], x[3]);
  if (in == "RUSIN_TH_TD_PD") return from_half(x[0], 0, x[1], x[2]);
  REQUIRE(in == "SPHERICAL_TL_PL_TV_PV");
  return {spherical(x[0], x[1]), spherical(x[2], x[3])};
}

Table random_table(RandomInputs& random, const Grid& grid, bool components, bool average) {
  Material material = random.material({}, components ? 4 : 3);
  if (average) material.reflectance = Reflectance::kMicrofacet;
  if (material.channel_count() == 4) material.wavelengths_nm = {450, 500.5, 600, 700};
  const TableSpec spec =
      material_spec(material, {}, grid, average ? CellRule{true, 0.1} : CellRule{}, components);
  return collect(*make_producer(spec, 1), 1);
}

}  // namespace

TEST_CASE("rows of ALTA files are pairs of directions in ALTA's angles, with f_r there") {
  const TemporaryFolder folder;
  // Not reciprocal: light and eye cannot be taken for each other.
  const Material material = read_material(preset("tamamushi_paper"));
  const ClothModel<double> model(material);
  for (const Grid& grid : {halfdiff4d(4, 6, 5, 7, 360), inout(4, 5, 3, 6)}) {
    const Table table = preset_table("tamamushi_paper", grid);
    std::size_t above = 0;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      above += grid.node_above_horizon(cell) ? 1 : 0;
    }
    for (const char* const name : {"t.alta", "t.dat"}) {
      write_table(table, folder / name);
      const AltaFile file = as_alta_reads(read_file(folder / name));
      CHECK(file.inputs == 4);
      CHECK(file.outputs == 3);
      CHECK(file.keys.at("PARAM_OUT") == "RGB_COLOR");
      CHECK(file.rows.size() == above);
      double worst = 0;
      for (const std::vector<double>& row : file.rows) {
        const Directions d = directions_of(file, row);
        REQUIRE(d.above_horizon());
        const Components f =
            model.evaluate(pair_geometry<double>(d.wi, d.wo, material.rotation_deg));
        for (std::size_t c = 0; c < 3; ++c) {
          worst = std::max(worst, std::abs(row[4 + c] / f.total(c) - 1));
        }
      }
      std::cout << "ALTA rows of " << grid.description() << " in " << name << ": off by " << worst
                << '\n';
      CHECK(worst < 1e-9);  // angles near the horizon magnify the rounding of radians
    }
  }
}

TEST_CASE("phi_d of ALTA is the eye's where a table goes around once, ours where it is folded") {
  const TemporaryFolder folder;
  for (const double range : {360.0, 180.0}) {
    const Grid grid = halfdiff3d(3, 4, 6, range);
    write_table(preset_table("silk_paper", grid), folder / "t.alta");
    const AltaFile file = as_alta_reads(read_file(folder / "t.alta"));
    CHECK(file.keys.at("PARAM_IN") == "RUSIN_TH_TD_PD");
    const double first = range / 12 - (range == 360 ? 180 : 0);
    CHECK(std::abs(file.rows.front()[2] - first / 180 * kPi) < 1e-15);
  }
}

TEST_CASE("ALTA files read back to the table that was written, every digit, whatever the ending") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  INFO("seed " << seed);
  RandomInputs random(seed);
  for (const Grid& grid : {halfdiff3d(5, 4, 6), halfdiff3d(3, 5, 8, 360), halfdiff4d(4, 3, 5, 2),
                           inout(3, 4, 2, 5), halfdiff4d(3, 4, 3, 5, 360), inout(4, 1, 3, 6)}) {
    for (const bool components : {false, true}) {
      for (const bool average : {false, true}) {
        if (average && grid.kind != GridKind::kInOut && grid.axes.back().highest_deg > 180)
          continue;
        const Table table = random_table(random, grid, components, average);
        write_table(table, folder / "t.alta");
        write_table(table, folder / "t.dat");
        std::filesystem::rename(folder / "t.alta", folder / "text.dat");
        std::filesystem::rename(folder / "t.dat", folder / "binary.alta");
        for (const char* const name : {"text.dat", "binary.alta"}) {
          INFO(name << ' ' << grid.description() << (components ? " components" : "")
                    << (average ? " averages" : ""));
          const Table back = read_table(folder / name);
          CHECK(back.spec() == table.spec());
          bool equal = true;
          for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
            equal = equal && back.valid(cell) == table.valid(cell);
            for (std::size_t c = 0; c < table.spec().channels.size(); ++c) {
              equal = equal && back.value(cell, c) == table.value(cell, c);
            }
          }
          CHECK(equal);
        }
      }
    }
  }
}

TEST_CASE("cells that were not measured are left out of ALTA files and stay so") {
  const TemporaryFolder folder;
  const Grid grid = halfdiff3d(4, 4, 4);
  const Table table = plain_table(grid, [](std::size_t cell) {
    return cell % 3 == 0 ? kNotMeasured : 0.1 * static_cast<double>(cell);
  });
  for (const char* const name : {"t.alta", "t.dat"}) {
    write_table(table, folder / name);
    const AltaFile file = as_alta_reads(read_file(folder / name));
    CHECK(file.keys.at("PARAM_OUT") == "INV_STERADIAN");
    const Table back = read_table(folder / name);
    CHECK(back.spec() == table.spec());
    std::size_t rows = 0;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      const bool measured = grid.node_above_horizon(cell) && cell % 3 != 0;
      rows += measured ? 1 : 0;
      CHECK(back.valid(cell) == measured);
      CHECK(back.value(cell, 0) == table.value(cell, 0));
    }
    CHECK(file.rows.size() == rows);
  }
  const Table none = plain_table(grid, [](std::size_t) { return kNotMeasured; });
  CHECK_THROWS_AS(write_table(none, folder / "none.alta"), WorkError);
  CHECK(!std::filesystem::exists(folder / "none.alta"));
}

TEST_CASE("lists of pairs are written to ALTA files and read back, first bytes of all kinds") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  INFO("seed " << seed);
  RandomInputs random(seed);
  double worst = 0;
  int hashes = 0;
  for (int n = 0; n < 1000; ++n) {
    const bool isotropic = random.chance(0.5);
    PairList list{{}, isotropic};
    std::vector<double> values;
    for (int k = random.integer(1, 4); k > 0; --k) {
      list.pairs.push_back({random.uniform(0, 89), random.uniform(-180, 180), random.uniform(0, 89),
                            random.uniform(-180, 180)});
      for (int c = 0; c < 3; ++c) values.push_back(random.log_uniform(1e-300, 1e300));
    }
    const std::size_t count = list.pairs.size();
    const Material material = random.material({});
    const TableSpec spec = material_spec(material, {}, list);
    const Table table(spec, values, std::vector<std::uint8_t>(count, 1));
    for (const char* const name : {"t.alta", "t.dat"}) {
      write_table(table, folder / name);
      const std::string text = read_file(folder / name);
      hashes += text.find("#BEGIN_STREAM\n#") != std::string::npos ? 1 : 0;
      REQUIRE(as_alta_reads(text).rows.size() == count);
      const Table back = read_table(folder / name);
      REQUIRE(back.spec().has_pairs());
      REQUIRE(back.spec().isotropic() == isotropic);
      REQUIRE(back.spec().channels == spec.channels);
      REQUIRE(back.spec().provenance == spec.provenance);
      REQUIRE(back.spec().provenance.note.empty());
      REQUIRE(std::equal(back.values().begin(), back.values().end(), values.begin(), values.end()));
      for (std::size_t k = 0; k < count; ++k) {
        const DirectionPair& a = list.pairs[k];
        const DirectionPair& b = back.spec().pairs()[k];
        REQUIRE(back.valid(k));
        worst = std::max({worst, std::abs(a.theta_i - b.theta_i), std::abs(a.theta_o - b.theta_o)});
        const double turn = reduce_turns((a.phi_i - a.phi_o) - (b.phi_i - b.phi_o));
        worst = std::max(worst, std::abs(turn));
        if (!isotropic) worst = std::max(worst, std::abs(reduce_turns(a.phi_i - b.phi_i)));
      }
    }
  }
  std::cout << "ALTA lists: angles off by " << worst << " degrees, " << hashes
            << " streams begin with a '#' (seed " << seed << ")\n";
  CHECK(worst < 1e-12);
  CHECK(hashes > 0);
}

TEST_CASE("ALTA's slice of MERL's pink felt reads, with a note on what it leaves open") {
  const auto path = shared_data("alta_pink-felt-1d.alta");
  if (path.empty()) return;
  const Table table = read_table(path);
  REQUIRE(table.spec().cell_count() == 90);
  CHECK(table.spec().isotropic());
  CHECK(table.spec().channels == rgb_channels());
  CHECK(table.spec().provenance.note == "theta_d, phi_d are not in the file: taken as 0");
  const DirectionPair& first = table.spec().pairs()[0];
  const double theta_h = std::acos(0.999984567305837) * 180 / kPi;
  CHECK(std::abs(first.theta_i - theta_h) < 1e-10);
  CHECK(std::abs(first.theta_o - theta_h) < 1e-10);
  CHECK(first.phi_i == first.phi_o);
  CHECK(table.value(0, 0) == 0.109704419970512);
  CHECK(table.value(0, 2) == 0.0616232864558697);
  CHECK(table.valid(0));
}

}  // namespace clothbrdf::test
