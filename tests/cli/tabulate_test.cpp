#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/format.h"
#include "formats/material_json.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

std::vector<json> json_lines(const std::string& text) {
  std::vector<json> objects;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) objects.push_back(json::parse(line));
  return objects;
}

// The table that tabulate writes of silk with these options.
Table tabulated(const Arguments& options) {
  const TemporaryFolder folder;
  Arguments arguments = {"tabulate", kSilk, "-o", (folder / "silk.exr").string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  output_of(arguments);
  return read_table(folder / "silk.exr");
}

// Totals of eval, one array a pair.
std::vector<std::vector<double>> totals(const std::string& material, const std::string& pairs) {
  std::vector<std::vector<double>> values;
  for (const json& line : json_lines(output_of({"eval", material}, pairs)))
    values.push_back(line["f_r"]["total"].get<std::vector<double>>());
  return values;
}

std::string pair_text(const Directions& directions, double turn_deg) {
  std::ostringstream text;
  text.precision(17);
  for (const Vector3<double>& w : {directions.wi, directions.wo}) {
    constexpr double kDegrees = 180 / 3.14159265358979323846;
    text << std::atan2(std::hypot(w[0], w[1]), w[2]) * kDegrees << ' '
         << std::atan2(w[1], w[0]) * kDegrees + turn_deg << ' ';
  }
  return text.str() + '\n';
}

}  // namespace

TEST_CASE("tabulate writes each table that is asked for and says so") {
  const TemporaryFolder folder;
  const std::string binary = (folder / "silk.binary").string();
  const std::string exr = (folder / "silk.exr").string();
  const std::string said = output_of({"tabulate", kSilk, "-o", binary, "-o", exr});
  CHECK(folder.entry_count() == 2);
  CHECK(std::filesystem::file_size(binary) == 34'992'012);
  CHECK(read_table(binary).spec().grid() == halfdiff3d());
  CHECK(read_table(exr).spec().grid() == halfdiff4d());
  CHECK_THAT(said, ContainsSubstring(binary + ": MERL halfdiff3d:90x90x180, 1,458,000 cells of 3 "
                                              "channels, 34,992,012 bytes in "));
  CHECK_THAT(said, ContainsSubstring("(isotropic: the mean over phi_h)\n"));
  CHECK_THAT(said, ContainsSubstring(exr + ": EXR halfdiff4d:45x36x45x45, 3,280,500 cells"));
}

TEST_CASE("tabulate --json gives one JSON object a line") {
  const TemporaryFolder folder;
  const std::string binary = (folder / "silk.binary").string();
  const std::string exr = (folder / "silk.exr").string();
  const std::vector<json> lines =
      json_lines(output_of({"tabulate", kSilk, "--json", "-o", binary, "-o", exr}));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0]["file"] == binary);
  CHECK(lines[0]["format"] == "MERL");
  CHECK(lines[0]["note"] == "isotropic: the mean over phi_h");
  CHECK(lines[1]["file"] == exr);
  CHECK(lines[1]["format"] == "EXR");
  CHECK(lines[1]["grid"] == "halfdiff4d:45x36x45x45");
  CHECK(lines[1]["cells"] == 3'280'500);
  CHECK(lines[1]["channels"] == 3);
  CHECK(lines[1]["seconds"].get<double>() > 0);
  for (const json& line : lines) {
    CHECK(line["bytes"] == std::filesystem::file_size(line["file"].get<std::string>()));
  }
}

TEST_CASE("names that are not UTF-8 are told in valid JSON") {
  const TemporaryFolder folder;
  const std::string name = (folder / "\xff.exr").string();
  const std::vector<json> told =
      json_lines(output_of({"tabulate", kSilk, "--grid", "inout", "--json", "-o", name}));
  CHECK(told.size() == 1);
  CHECK(std::filesystem::exists(name));
  CHECK(json_lines(output_of({"info", "--json", name})).size() == 1);
}

TEST_CASE("tabulate --dry-run writes nothing") {
  const TemporaryFolder folder;
  const std::string binary = (folder / "silk.binary").string();
  const std::string exr = (folder / "silk.exr").string();
  const std::string said = output_of({"tabulate", kSilk, "--dry-run", "-o", binary, "-o", exr});
  CHECK(folder.entry_count() == 0);
  CHECK_THAT(said, ContainsSubstring(binary + ": MERL "));
  CHECK_THAT(said, ContainsSubstring(exr + ": EXR "));
  CHECK_THAT(said, ContainsSubstring("not written (dry run)"));
  const std::vector<json> told =
      json_lines(output_of({"tabulate", kSilk, "--dry-run", "--json", "-o", exr}));
  REQUIRE(told.size() == 1);
  CHECK(!told[0].contains("bytes"));
  CHECK(told[0]["predicted"]["bytes"] > 39e6);
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("tabulate --tolerance meets it, and says so in the file") {
  const TemporaryFolder folder;
  const std::string exr = (folder / "silk.exr").string();
  const json told =
      json_lines(output_of({"tabulate", kSilk, "--tolerance", "0.02", "--json", "-o", exr})).at(0);
  CHECK(told["error"]["rms"] <= 0.02);
  CHECK(told["error"]["rms"] > 0.015);
  CHECK(told["error"]["reader"] == "linear");
  CHECK(told["error"]["against"] == "cloth");
  const Table table = read_table(exr);
  REQUIRE(table.spec().provenance.error);
  CHECK(table.spec().provenance.error->error.rms == told["error"]["rms"].get<double>());
  CHECK(table.precision().relative == 0x1p-11);
  // Nothing else is left in the folder, and what a conversion writes has another error.
  CHECK(folder.entry_count() == 1);
  const std::string other = (folder / "other.exr").string();
  output_of({"convert", exr, other, "--grid", "halfdiff4d:9x8x9x8"});
  CHECK(!read_table(other).spec().provenance.error);

  const json p99 = json_lines(output_of({"tabulate", kSilk, "--tolerance", "0.05", "--metric",
                                         "p99", "--json", "-o", exr}))
                       .at(0);
  CHECK(p99["error"]["p99"] <= 0.05);
  CHECK(p99["error"]["p99"] > 0.035);
}

TEST_CASE("a tolerance that a format cannot meet is refused with the best that it can") {
  const TemporaryFolder folder;
  const std::string binary = (folder / "silk.binary").string();
  const Outcome outcome = run_program({"tabulate", kSilk, "--tolerance", "0.03", "-o", binary});
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out == "");
  CHECK_THAT(outcome.err, ContainsSubstring(binary) && ContainsSubstring("0.03") &&
                              ContainsSubstring("the least rms error") &&
                              ContainsSubstring("--isotropic-ok"));
  CHECK(folder.entry_count() == 0);
  const json told = json_lines(output_of({"tabulate", kSilk, "--tolerance", "0.03",
                                          "--isotropic-ok", "--json", "-o", binary}))
                        .at(0);
  CHECK(told["error"]["rms"] <= 0.03);
  CHECK(told["error"]["reader"] == "nearest");
  CHECK(told["error"]["against"] == "mean over rotations");
}

TEST_CASE("formats with a size get the bytes that a tolerance needs") {
  const TemporaryFolder folder;
  const std::string bsdf = (folder / "silk.bsdf").string();
  const json rough =
      json_lines(output_of({"tabulate", kSilk, "--tolerance", "0.1", "--json", "-o", bsdf})).at(0);
  const json fine =
      json_lines(output_of({"tabulate", kSilk, "--tolerance", "0.03", "--json", "-o", bsdf})).at(0);
  CHECK(rough["error"]["rms"] <= 0.1);
  CHECK(fine["error"]["rms"] <= 0.03);
  CHECK(rough["bytes"].get<double>() < 0.5 * fine["bytes"].get<double>());
  CHECK(read_table(bsdf).spec().provenance.error);
}

TEST_CASE("where half floats end before the values do, a tolerance is met with floats") {
  const TemporaryFolder folder;
  const std::string exr = (folder / "paper.exr").string();
  Material narrow = read_material(preset("silk"));
  narrow.warp.lobe_axes = {0.001, 0.05};
  narrow.weft.lobe_axes = {0.05, 0.001};
  const std::string material = (folder / "narrow.json").string();
  {
    AtomicFile file(material);
    const std::string text = material_to_json(narrow);
    file.write_at(0, std::as_bytes(std::span(text)));
    file.commit();
  }
  const json told = json_lines(output_of({"tabulate", material, "--isotropic", "--isotropic-ok",
                                          "--tolerance", "0.1", "--json", "-o", exr}))
                        .at(0);
  CHECK(told["error"]["rms"] <= 0.1);
  CHECK(read_table(exr).precision().bytes == 4);
}

TEST_CASE("grids of free sizes get the cells that a tolerance needs") {
  const TemporaryFolder folder;
  const std::string alta = (folder / "cotton.dat").string();
  const std::string cotton = preset("cotton").string();
  std::vector<double> bytes;
  for (const char* tolerance : {"0.2", "0.05", "0.025"}) {
    const json told =
        json_lines(output_of({"tabulate", cotton, "--tolerance", tolerance, "--json", "-o", alta}))
            .at(0);
    CHECK(told["error"]["rms"] <= std::stod(tolerance));
    bytes.push_back(told["bytes"]);
  }
  CHECK(bytes[0] < bytes[1]);
  CHECK(bytes[1] < bytes[2]);
}

TEST_CASE("files of other colours than the material's are written and measured in theirs") {
  const TemporaryFolder folder;
  const std::string bsdf = (folder / "silk.bsdf").string();
  const Arguments spectral = {"tabulate", kSilk, "--flavour", "spectral", "--json", "-o", bsdf};
  CHECK(json_lines(output_of(spectral)).at(0)["channels"] > 3);
  Arguments exact = spectral;
  exact.insert(exact.end(), {"--tolerance", "0.2"});
  CHECK(json_lines(output_of(exact)).at(0)["error"]["rms"] <= 0.2);
  Arguments dry = spectral;
  dry.emplace_back("--dry-run");
  CHECK(json_lines(output_of(dry)).at(0)["predicted"]["error"]["rms"] < 0.2);
}

TEST_CASE("options that --tolerance decides itself, or that need it, are refused") {
  for (const Arguments& wrong :
       std::vector<Arguments>{{"--tolerance", "0.01", "--grid", "halfdiff4d"},
                              {"--tolerance", "0.01", "--cells", "point"},
                              {"--tolerance", "0.01", "--size", "1000000"},
                              {"--tolerance", "0"},
                              {"--tolerance", "nan"},
                              {"--tolerance", "-1"},
                              {"--tolerance", "0.01", "--metric", "max"},
                              {"--metric", "rms"},
                              {"--isotropic-ok"}}) {
    const TemporaryFolder folder;
    Arguments arguments = {"tabulate", kSilk, "-o", (folder / "silk.exr").string()};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const Outcome outcome = run_program(arguments);
    CAPTURE(wrong, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(folder.entry_count() == 0);
  }
}

TEST_CASE("the material may follow -o") {
  const TemporaryFolder folder;
  const std::string exr = (folder / "silk.exr").string();
  output_of({"tabulate", "-o", exr, kSilk, "--grid", "inout"});
  CHECK(std::filesystem::exists(exr));
}

TEST_CASE("every option of tabulate reaches the table") {
  const TableSpec plain = tabulated({"--grid", "inout:2x4x3x6"}).spec();
  CHECK(plain.grid() == inout(2, 4, 3, 6));
  CHECK(plain.cells == CellRule{});
  CHECK(plain.provenance.effects == Effects{});
  CHECK(plain.provenance.material == read_material(kSilk));
  CHECK(plain.channels.size() == 3);

  const TableSpec other = tabulated({"--grid", "halfdiff4d:2x3x4x5", "--cells", "average:0.01",
                                     "--effects", "diffuse", "--components"})
                              .spec();
  CHECK(other.grid() == halfdiff4d(2, 3, 4, 5));
  CHECK(other.cells == CellRule{.average = true, .tolerance = 0.01});
  CHECK(other.provenance.effects == Effects{.specular = false, .internal = false});
  CHECK(other.channels.size() == 12);
}

TEST_CASE("option --compress loses nothing, --half half of the bytes") {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const Arguments& options) {
    Arguments arguments = {"tabulate", kSilk, "--grid", "inout", "-o", (folder / name).string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    output_of(arguments);
    return std::filesystem::file_size(folder / name);
  };
  const std::uintmax_t bytes = write("plain.exr", {});
  CHECK(write("compressed.exr", {"--compress"}) < bytes);
  CHECK(write("half.exr", {"--half"}) < bytes * 51 / 100);
  const Table plain = read_table(folder / "plain.exr");
  const Table compressed = read_table(folder / "compressed.exr");
  CHECK(std::equal(plain.values().begin(), plain.values().end(), compressed.values().begin(),
                   compressed.values().end()));
}

TEST_CASE("any number of threads writes the same bytes") {
  const TemporaryFolder folder;
  for (const char* threads : {"1", "3"}) {
    output_of({"tabulate", kSilk, "--grid", "halfdiff4d:20x18x20x20", "--threads", threads, "-o",
               (folder / (threads + std::string(".exr"))).string()});
  }
  CHECK(read_file(folder / "1.exr") == read_file(folder / "3.exr"));
}

TEST_CASE("eval and an EXR table hold the same values at the nodes") {
  const std::string material = preset("tamamushi").string();
  const TemporaryFolder folder;
  const std::string name = (folder / "table.exr").string();
  output_of({"tabulate", material, "--grid", "inout", "-o", name});
  const Table table = read_table(name);
  const Grid& grid = table.spec().grid();
  std::string pairs;
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < grid.cell_count(); cell += 997) {
    const std::array<int, 4> k = grid.indices(cell);
    for (std::size_t a = 0; a < 4; ++a) pairs += std::to_string(grid.axes[a].node_deg(k[a])) + ' ';
    pairs += '\n';
    cells.push_back(cell);
  }
  const std::vector<std::vector<double>> expected = totals(material, pairs);
  REQUIRE(expected.size() == cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      // For files of floats in/out points are evaluated in floats.
      CAPTURE(cells[i], c);
      CHECK_THAT(table.value(cells[i], c), Catch::Matchers::WithinRel(expected[i][c], 5e-6));
    }
  }
}

TEST_CASE("a MERL table holds the mean of eval over phi_h at the cells' centres") {
  const std::string material = preset("cotton").string();
  const TemporaryFolder folder;
  const std::string name = (folder / "table.binary").string();
  output_of({"tabulate", material, "-o", name});
  const Table table = read_table(name);
  const Grid& grid = table.spec().grid();
  // The lobes of cotton are so smooth in azimuth that equal weights of so many give all digits.
  constexpr int kTurns = 180;
  int checked = 0;
  for (std::size_t cell = 180 * 90 + 7; cell < grid.cell_count(); cell += 181 * 911) {
    if (!grid.node_above_horizon(cell)) continue;
    std::string pairs;
    for (int k = 0; k < kTurns; ++k) pairs += pair_text(grid.directions(cell), 180.0 * k / kTurns);
    std::array<double, 3> mean{};
    for (const std::vector<double>& values : totals(material, pairs)) {
      for (std::size_t c = 0; c < 3; ++c) mean[c] += values[c] / kTurns;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      CAPTURE(cell, c);
      CHECK_THAT(table.value(cell, c), Catch::Matchers::WithinRel(mean[c], 1e-9));
    }
    ++checked;
  }
  CHECK(checked >= 4);
}

}  // namespace clothbrdf::test
