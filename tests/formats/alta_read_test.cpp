#include "formats/alta_read.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <sstream>

#include "formats/alta_parametrisation.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

using Vector = Vector3<double>;
using Numbers = std::vector<double>;

Vector sum(const Vector& a, const Vector& b, double sign = 1) {
  return {a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2]};
}
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }
Vector unit(const Vector& a) {
  const double l = length(a);
  return {a[0] / l, a[1] / l, a[2] / l};
}
double azimuth(const Vector& a) { return std::atan2(a[1], a[0]); }
double planar(const Vector& a) { return std::hypot(a[0], a[1]); }
Vector half(const Vector& v, const Vector& l) { return unit(sum(v, l)); }
// Of the eye and of the light's mirror image.
Vector back(const Vector& v, const Vector& l) {
  return unit({v[0] - l[0], v[1] - l[1], v[2] + l[2]});
}
// The eye around the half vector.
Vector difference(const Vector& v, const Vector& l) {
  const Vector h = half(v, l);
  const double phi = -azimuth(h);
  const double theta = -std::acos(h[2]);
  const double x = v[0] * std::cos(phi) - v[1] * std::sin(phi);
  const double y = v[0] * std::sin(phi) + v[1] * std::cos(phi);
  return {x * std::cos(theta) + v[2] * std::sin(theta), y,
          v[2] * std::cos(theta) - x * std::sin(theta)};
}
double azimuth_after(const Vector& a, const Vector& b) {
  const double phi = azimuth(a) - azimuth(b);
  return phi < 0 ? phi + 2 * kPi : phi;
}

// What each parametrisation says of a pair, from ALTA's documentation of its coordinates.
struct Definition {
  const char* name;
  bool complete;   // tells isotropic pairs apart
  bool isotropic;  // does not tell how the cloth is turned
  std::function<Numbers(const Vector& v, const Vector& l)> of;
};

const std::vector<Definition>& definitions() {
  static const std::vector<Definition> kAll = {
      {"COS_TH", false, true, [](auto& v, auto& l) { return Numbers{half(v, l)[2]}; }},
      {"COS_TK", false, true, [](auto& v, auto& l) { return Numbers{back(v, l)[2]}; }},
      {"COS_TLV", false, true, [](auto& v, auto& l) { return Numbers{dot(v, l)}; }},
      {"RUSIN_TH_TD", false, true,
       [](auto& v, auto& l) {
         return Numbers{std::acos(half(v, l)[2]), std::acos(dot(v, half(v, l)))};
       }},
      {"COS_TH_TD", false, true,
       [](auto& v, auto& l) {
         return Numbers{half(v, l)[2], dot(v, half(v, l))};
       }},
      {"ISOTROPIC_TV_PROJ_DPHI", false, true,
       [](auto& v, auto& l) {
         const double phi = azimuth(v) - azimuth(l);
         return Numbers{std::acos(v[2]) * std::cos(phi), std::acos(v[2]) * std::sin(phi)};
       }},
      {"STARK_2D", false, true,
       [](auto& v, auto& l) {
         return Numbers{planar(sum(v, l)) / 2, length(sum(l, v, -1)) / 2};
       }},
      {"NEUMANN_2D", false, true,
       [](auto& v, auto& l) {
         return Numbers{planar(sum(v, l)) / 2, planar(sum(l, v, -1)) / 2};
       }},
      {"RUSIN_TH_TD_PD", true, true,
       [](auto& v, auto& l) {
         const Vector d = difference(v, l);
         return Numbers{std::acos(half(v, l)[2]), std::acos(d[2]), azimuth(d)};
       }},
      {"ISOTROPIC_TV_TL_DPHI", true, true,
       [](auto& v, auto& l) {
         return Numbers{std::acos(v[2]), std::acos(l[2]), azimuth(l) - azimuth(v)};
       }},
      {"RUSIN_VH", false, false,
       [](auto& v, auto& l) {
         const Vector h = half(v, l);
         return Numbers{h[0], h[1], h[2]};
       }},
      {"SCHLICK_VH", false, false,
       [](auto& v, auto& l) {
         const Vector k = back(v, l);
         return Numbers{-k[0], -k[1], k[2]};
       }},
      {"ISOTROPIC_TL_TV_PROJ_DPHI", true, true,
       [](auto& v, auto& l) {
         const double phi = azimuth(l) - azimuth(v);
         return Numbers{std::acos(l[2]), std::acos(v[2]) * std::cos(phi),
                        std::acos(v[2]) * std::sin(phi)};
       }},
      {"SCHLICK_TL_TK_PROJ_DPHI", true, true,
       [](auto& v, auto& l) {
         const Vector k = back(v, l);
         const double phi = azimuth(l) - azimuth(k);
         return Numbers{std::acos(l[2]), std::acos(k[2]) * std::cos(phi),
                        std::acos(k[2]) * std::sin(phi)};
       }},
      {"RETRO_TL_TVL_PROJ_DPHI", true, true,
       [](auto& v, auto& l) {
         const double theta = std::acos(dot(v, l));
         const double sines = planar(l) * std::sin(theta);
         const double cosine = (v[2] - l[2] * dot(v, l)) / sines;
         const double sine = std::sin(azimuth(l) - azimuth(v)) * planar(v) / std::sin(theta);
         return Numbers{std::acos(l[2]), theta * cosine, theta * sine};
       }},
      {"STARK_3D", true, true,
       [](auto& v, auto& l) {
         return Numbers{planar(sum(v, l)) / 2, length(sum(l, v, -1)) / 2,
                        azimuth_after(sum(l, v, -1), sum(v, l))};
       }},
      {"NEUMANN_3D", true, true,
       [](auto& v, auto& l) {
         return Numbers{planar(sum(v, l)) / 2, planar(sum(l, v, -1)) / 2,
                        azimuth_after(sum(l, v, -1), sum(v, l))};
       }},
      {"RUSIN_TH_PH_TD_PD", true, false,
       [](auto& v, auto& l) {
         const Vector d = difference(v, l);
         return Numbers{std::acos(half(v, l)[2]), azimuth(half(v, l)), std::acos(d[2]), azimuth(d)};
       }},
      {"SPHERICAL_TL_PL_TV_PV", true, false,
       [](auto& v, auto& l) {
         return Numbers{std::acos(l[2]), azimuth(l), std::acos(v[2]), azimuth(v)};
       }},
      {"STEREOGRAPHIC", true, false,
       [](auto& v, auto& l) {
         return Numbers{v[0] / (1 + v[2]), v[1] / (1 + v[2]), l[0] / (1 + l[2]), l[1] / (1 + l[2])};
       }},
      {"CARTESIAN", true, false,
       [](auto& v, auto& l) { return Numbers{v[0], v[1], v[2], l[0], l[1], l[2]}; }},
  };
  return kAll;
}

std::string text_of(const std::string& head, const std::vector<Numbers>& rows) {
  std::ostringstream text;
  text.precision(17);
  text << head;
  for (const Numbers& row : rows) {
    for (const double x : row) text << x << '\t';
    text << '\n';
  }
  return text.str();
}

std::string head_of(std::size_t inputs, const std::string& in) {
  return "#DIM " + std::to_string(inputs) + " 1\n#PARAM_IN  " + in + "\n#PARAM_OUT INV_STERADIAN\n";
}

double largest_difference(const Vector& a, const Vector& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// What does not change as the cloth turns, or is seen in a mirror.
Vector turned_away(const Directions& d) { return {d.wi[2], d.wo[2], dot(d.wi, d.wo)}; }

}  // namespace

TEST_CASE("each of ALTA's parametrisations reads as the pairs that its coordinates come from") {
  const TemporaryFolder folder;
  const std::uint64_t seed = seed_from_environment();
  INFO("seed " << seed);
  RandomInputs random(seed);
  for (const Definition& definition : definitions()) {
    INFO(definition.name);
    std::vector<Directions> pairs;
    std::vector<Numbers> rows;
    for (int n = 0; n < 500; ++n) {
      const Directions d = {direction(random.uniform(1, 80), random.uniform(-180, 180)),
                            direction(random.uniform(1, 80), random.uniform(-180, 180))};
      pairs.push_back(d);
      rows.push_back(definition.of(d.wo, d.wi));
      rows.back().push_back(n);
    }
    const std::size_t inputs = rows.front().size() - 1;
    write_file(folder / "t.alta", text_of(head_of(inputs, definition.name), rows));
    const Table table = read_table(folder / "t.alta");
    REQUIRE(table.spec().cell_count() == 500);
    CHECK(table.spec().isotropic() == definition.isotropic);
    CHECK(table.spec().provenance.note.empty() == definition.complete);
    double off = 0;
    double off_again = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      CHECK(table.value(k, 0) == static_cast<double>(k));
      const Directions read = table.spec().directions(k);
      if (definition.complete && definition.isotropic) {
        off = std::max(off, largest_difference(turned_away(read), turned_away(pairs[k])));
      } else if (definition.complete) {
        off = std::max({off, largest_difference(read.wi, pairs[k].wi),
                        largest_difference(read.wo, pairs[k].wo)});
      }
      // Whatever was added to it, the pair has the coordinates of the file. The side of an
      // isotropic pair is not told.
      const Numbers again = definition.of(read.wo, read.wi);
      for (std::size_t x = 0; x < inputs; ++x) {
        const double here = again[x] - rows[k][x];
        const bool side = definition.isotropic && definition.complete && x + 1 == inputs;
        off_again = std::max(
            off_again, std::min(std::abs(std::sin(here / 2)) * 2 + (std::abs(here) > 7 ? 1 : 0),
                                side ? std::abs(again[x] + rows[k][x]) : 9));
      }
    }
    std::cout << definition.name << ": pairs off by " << off << ", coordinates by " << off_again
              << '\n';
    CHECK(off < 1e-9);  // cosines near 1 lose digits
    CHECK(off_again < 1e-9);
  }
}

TEST_CASE("ALTA text is read as ALTA reads it: comments, blank lines, tabs, Windows line ends") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    write_file(folder / "t.alta", text);
    return read_table(folder / "t.alta");
  };
  const std::string rows = "0.1 0.2 0.3 1 2 3\n";
  const std::string head =
      "# a comment\n#ALTA_BEGIN_HEADER\n#DIM 3  3\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT "
      "RGB_COLOR\n";
  const Table plain = read(head + "#VS 0\n#ALTA_END_HEADER\n" + rows);
  REQUIRE(plain.spec().cell_count() == 1);
  CHECK(plain.value(0, 2) == 3);
  CHECK(std::abs(plain.spec().pairs()[0].theta_o - 0.1 * 180 / kPi) < 1e-13);
  CHECK(std::abs(plain.spec().pairs()[0].theta_i - 0.2 * 180 / kPi) < 1e-13);
  CHECK(read(head + "#ALTA END HEADER\n#DIM 9 9\n# more\n\n \t\r\n\t+0.1\t2e-1 0.3 1 2 3 \r\n" +
             "# between\n0.4 0.5 -0.6 4 5 6")
            .spec()
            .cell_count() == 2);
  const Table intervals = read(head + "#VS 2\n0.1 0.2 0.3 1 2 3 0.9 1.1\n");
  CHECK(intervals.value(0, 0) == 1);
  CHECK(intervals.spec().provenance.note == "intervals of confidence were left out");
  const Table unnamed =
      read("#DIM 3 3\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN\n" + rows);
  CHECK(unnamed.spec().channels == rgb_channels());
  CHECK(unnamed.spec().provenance.note == "three values without names: taken as R, G and B");
  const Table masked =
      read(head + rows + "1.7 0.2 0.3 1 2 3\n0.1 0.2 0.3 1 -2 3\n" + "0.1 0.2 0.4 nan 2 3\n");
  CHECK(masked.valid(0));
  CHECK(!masked.valid(1));  // below the horizon
  CHECK(!masked.valid(2));  // not measured
  CHECK(masked.valid(3));
  CHECK(std::isnan(masked.value(3, 0)));
}

TEST_CASE("ALTA binary is read with its intervals of confidence, and without a begin or end mark") {
  const TemporaryFolder folder;
  const auto bytes = [](const Numbers& numbers) {
    return std::string(reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size());
  };
  const std::string head =
      "#DIM 1 1\n#PARAM_IN COS_TH\n#PARAM_OUT INV_STERADIAN\n#FORMAT binary\n#VERSION 0\n"
      "#PRECISION ieee754-double\n#ENDIAN little\n#SAMPLE_COUNT 2\n";
  const auto read = [&](const std::string& text) {
    write_file(folder / "t.dat", text);
    return read_table(folder / "t.dat");
  };
  const Table bare = read(head + "#ALTA_END_HEADER\n" + bytes({1, 5, 0.5, 6}));
  CHECK(bare.value(1, 0) == 6);
  CHECK(bare.spec().channels[0].name == "mono");
  const Table intervals =
      read(head + "#VS 2\n#BEGIN_STREAM\n" + bytes({1, 5, 4, 6, 0.5, 6, 5, 7}) + "\n#END_STREAM\n");
  CHECK(intervals.value(1, 0) == 6);
  CHECK(intervals.spec().pairs()[0].theta_i == 0);
  CHECK(intervals.spec().provenance.note.find("intervals of confidence were left out") !=
        std::string::npos);
  CHECK_THROWS_AS(read(head + "#VS 1\n#BEGIN_STREAM\n" + bytes({1, 5, 0.5, 6}) + "\n#END_STREAM\n"),
                  InputError);
}

TEST_CASE("what is not an ALTA file, or not of f_r, is refused in one line") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const std::string& part) {
    write_file(folder / "bad.alta", content);
    CHECK_THROWS_WITH(read_table(folder / "bad.alta"),
                      ContainsSubstring((folder / "bad.alta").string() + ": ") &&
                          ContainsSubstring(part) && !ContainsSubstring("\n"));
    CHECK_THROWS_AS(read_table(folder / "bad.alta"), InputError);
  };
  const auto with = [](const std::string& dim, const std::string& in, const std::string& out,
                       const std::string& more, const std::string& rows) {
    return "#DIM " + dim + "\n#PARAM_IN " + in + "\n#PARAM_OUT " + out + "\n" + more + rows;
  };
  const std::string rgb = "RGB_COLOR";
  refused("", "#DIM is missing");
  refused("some text\n", "#DIM is missing");
  refused("#DIM 1 3\n#PARAM_OUT RGB_COLOR\n1 2 3 4\n", "#PARAM_IN is missing");
  refused("#DIM 1 3\n#PARAM_IN COS_TH\n1 2 3 4\n", "#PARAM_OUT is missing");
  refused(with("1 3", "COS_TH", rgb, "", ""), "no samples");
  refused(with("one 3", "COS_TH", rgb, "", "1 2 3 4\n"), "#DIM is 'one 3'");
  refused(with("1", "COS_TH", rgb, "", "1 2 3 4\n"), "#DIM is '1'");
  refused(with("1 3 1", "COS_TH", rgb, "", "1 2 3 4\n"), "#DIM is '1 3 1'");
  refused(with("0 3", "COS_TH", rgb, "", "1 2 3 4\n"), "#DIM is '0 3'");
  refused(with("1 1000000000", "COS_TH", rgb, "", "1 2 3 4\n"), "#DIM is '1 1000000000'");
  refused(with("2 3", "COS_TH", rgb, "", "1 1 2 3 4\n"), "COS_TH has 1");
  refused(with("1 3", "COS_TLR", rgb, "", "1 2 3 4\n"), "COS_TLR is not read");
  refused(with("1 3", "UNKNOWN", rgb, "", "1 2 3 4\n"), "'UNKNOWN' is not known; known: COS_TH");
  refused(with("1 3", "COS_TH", "XYZ_COLOR", "", "1 2 3 4\n"), "XYZ_COLOR is not read");
  refused(with("1 1", "COS_TH", "ENERGY", "", "1 2\n"), "ENERGY is not read");
  refused(with("1 1", "COS_TH", "INV_STERADIAN_COSINE_FACTOR", "", "1 2\n"), "which cosine");
  refused(with("1 1", "COS_TH", "GREY", "", "1 2\n"), "'GREY' is not allowed");
  refused(with("1 2", "COS_TH", "INV_STERADIAN", "", "1 2 3\n"), "with 2 values");
  refused(with("1 1", "COS_TH", rgb, "", "1 2\n"), "RGB_COLOR with 1 values");
  refused(with("1 3", "COS_TH", rgb, "#VS 3\n", "1 2 3 4\n"), "#VS is '3'");
  refused(with("1 3", "COS_TH", rgb, "#VS 0\n#VS 0\n", "1 2 3 4\n"), "#VS is there twice");
  refused(with("1 3", "COS_TH", rgb, "#FORMAT xml\n", "1 2 3 4\n"), "#FORMAT is 'xml'");
  refused(with("1 3", "COS_TH", rgb, "", "1 2 3 4\n1 2 3\n"), "sample 2 has 3 numbers");
  refused(with("1 3", "COS_TH", rgb, "", "1 2 3 4 5\n"), "sample 1 has 5 numbers");
  refused(with("1 3", "COS_TH", rgb, "", "1 2 three 4\n"), "sample 1: 'three' is no number");
  refused(with("1 3", "COS_TH", rgb, "", "1 2 3 4\n1.5 2 3 4\n"), "sample 2 is no pair");
  refused(with("1 3", "COS_TH", rgb, "", "nan 2 3 4\n"), "sample 1 is no pair");
  refused(with("2 1", "NEUMANN_2D", "INV_STERADIAN", "", "0.9 0.9 1\n"), "sample 1 is no pair");
  refused(with("3 1", "RUSIN_VH", "INV_STERADIAN", "", "1 1 0 1\n"), "sample 1 is no pair");
  refused(with("1 3", "COS_TH", rgb, "#SAMPLE_COUNT 2\n", "1 2 3 4\n"), "#SAMPLE_COUNT says 2");
  refused(with("1 3", "COS_TH", rgb, "#SAMPLE_COUNT 1\n", "1 2 3 4"), "cut off");
  const std::string binary = "#FORMAT binary\n#VERSION 0\n#PRECISION ieee754-double\n";
  const std::string little = binary + "#ENDIAN little\n";
  refused(with("1 3", "COS_TH", rgb, binary + "#SAMPLE_COUNT 1\n", ""), "#ENDIAN is missing");
  refused(with("1 3", "COS_TH", rgb, binary + "#ENDIAN big\n", ""), "#ENDIAN is 'big'");
  refused(with("1 3", "COS_TH", rgb, little, ""), "#SAMPLE_COUNT is missing");
  refused(with("1 3", "COS_TH", rgb, little + "#SAMPLE_COUNT 0\n", ""), "#SAMPLE_COUNT is '0'");
  refused(with("1 3", "COS_TH", rgb, little + "#SAMPLE_COUNT 999999999999999999\n", "12345678"),
          "too short for 999999999999999999 samples");
  CHECK_THROWS_AS(read_table(folder / "absent.alta"), InputError);
  CHECK_THROWS_AS(read_table(folder.path()), InputError);
}

TEST_CASE("an ALTA file of ours that contradicts its description is refused") {
  const TemporaryFolder folder;
  write_table(preset_table("silk", inout(2, 2, 2, 2)), folder / "t.alta");
  const std::string good = read_file(folder / "t.alta");
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& part) {
    std::string changed = good;
    const std::size_t at = changed.find(from);
    REQUIRE(at != std::string::npos);
    changed.replace(at, from.size(), to);
    write_file(folder / "bad.alta", changed);
    CHECK_THROWS_WITH(read_table(folder / "bad.alta"),
                      ContainsSubstring((folder / "bad.alta").string() + ": ") &&
                          ContainsSubstring(part) && !ContainsSubstring("\n"));
  };
  CHECK_NOTHROW(read_table(folder / "t.alta"));
  const std::size_t rows = good.find("\n0 0 ") + 1;
  const std::string first = good.substr(rows, good.find('\n', rows) + 1 - rows);
  refused("SPHERICAL_TL_PL_TV_PV", "RUSIN_TH_PH_TD_PD", "#PARAM_IN is 'RUSIN_TH_PH_TD_PD'");
  refused("RGB_COLOR", "INV_STERADIAN", "#PARAM_OUT is 'INV_STERADIAN'; by #CLOTHBRDF");
  refused("#DIM 4 3", "#DIM 3 4", "#DIM is '3 4'; by #CLOTHBRDF it must be 4 3");
  refused("\n" + first, "\n0.001" + first.substr(1), "sample 1 is not at a node of inout:2x2x2x2");
  refused("\n" + first, "\n" + first + first, "#SAMPLE_COUNT says 16");
  refused("#CLOTHBRDF {", "#CLOTHBRDF [", "#CLOTHBRDF");
  refused("\"name\":\"R\"", "\"name\":\"S\"", "#PARAM_OUT is 'RGB_COLOR'; by #CLOTHBRDF");
  refused("\"size\":2", "\"size\":4", "the sample at theta_i");
  refused("\"size\":2", "\"size\":1000000", "samples are too few");
  std::string without = good;
  without.replace(good.find("#SAMPLE_COUNT"), 14, "#SAMPLE_TOTAL");
  without.erase(without.find(first), first.size());
  write_file(folder / "bad.alta", without);
  CHECK_THROWS_WITH(
      read_table(folder / "bad.alta"),
      ContainsSubstring("the sample at theta_i 0 phi_i 0 theta_o 0 phi_o 0 is missing"));
  without.insert(without.find("\n0 0 ") + 1, first + first);
  write_file(folder / "bad.alta", without);
  CHECK_THROWS_WITH(read_table(folder / "bad.alta"), ContainsSubstring("sample 2 is there twice"));
}

TEST_CASE("each piece of an ALTA file of ours is refused") {
  const TemporaryFolder folder;
  const Table table = preset_table("silk", halfdiff4d(2, 1, 2, 2));
  for (const char* const name : {"t.alta", "t.dat"}) {
    write_table(table, folder / name);
    const std::string whole = read_file(folder / name);
    int read = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      write_file(folder / "cut.alta", whole.substr(0, size));
      try {
        static_cast<void>(read_table(folder / "cut.alta"));
        ++read;
      } catch (const InputError& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) ++read;
      }
    }
    INFO(name);
    // The newline after #END_STREAM holds nothing.
    CHECK(read == (std::string(name) == "t.dat" ? 1 : 0));
  }
}

TEST_CASE("any byte of an ALTA header may change: the same numbers are read, or it is refused") {
  const TemporaryFolder folder;
  const Table table = preset_table("silk", halfdiff3d(2, 2, 2));
  for (const char* const name : {"t.alta", "t.dat"}) {
    write_table(table, folder / name);
    const std::string good = read_file(folder / name);
    std::size_t header = 0;
    for (std::size_t line = 0; good[line] == '#'; line = header) header = good.find('\n', line) + 1;
    int read = 0;
    int listed = 0;
    int refused = 0;
    for (std::size_t at = 0; at < header; ++at) {
      for (const int change : {0, 10, 48, 255}) {
        std::string changed = good;
        changed[at] = static_cast<char>(change);
        if (changed == good) continue;
        write_file(folder / "c.alta", changed);
        try {
          const Table other = read_table(folder / "c.alta");
          INFO("byte " << at << " of " << name << " made " << change);
          if (other.spec().has_pairs()) {  // the key of the description was hit
            ++listed;
            continue;
          }
          CHECK(other.spec().samples == table.spec().samples);
          CHECK(std::equal(other.values().begin(), other.values().end(), table.values().begin()));
          ++read;
        } catch (const InputError& error) {
          CHECK(std::string(error.what()).find('\n') == std::string::npos);
          ++refused;
        }
      }
    }
    std::cout << "changed ALTA headers of " << name << ": " << read << " read, " << listed
              << " without description, " << refused << " refused\n";
    CHECK(listed > 0);
    CHECK(listed < 100);
    CHECK(refused > 2000);
  }
}

TEST_CASE("a table that ALTA cannot hold is refused") {
  const Format& format = format_for("t.alta");
  const auto refused = [&](const Samples& samples, bool components, const std::string& part) {
    const TableSpec spec =
        material_spec(read_material(preset("silk")), {}, samples, {}, components);
    CHECK_THROWS_WITH(check_output(format, spec, {}, "t.alta"),
                      ContainsSubstring("t.alta: ") && ContainsSubstring(part));
  };
  refused(AnyPairs{false}, false, "grids and lists of pairs, not any pairs");
  refused(halfdiff4d(999, 999, 99, 99), false, "ALTA counts up to 2147483647 samples");
  const auto usual = [&](Reflectance reflectance, bool isotropic) {
    return std::get<Grid>(format.default_samples(reflectance, isotropic));
  };
  CHECK(usual(Reflectance::kPaper, false) == inout());
  CHECK(usual(Reflectance::kMicrofacet, true) == halfdiff3d(30, 30, 30));
  CHECK(usual(Reflectance::kPaper, true) == halfdiff3d(30, 30, 60, 360));
}

}  // namespace clothbrdf::test
