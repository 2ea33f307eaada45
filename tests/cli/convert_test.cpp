#include <algorithm>
#include <cstring>
#include <filesystem>

#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/plain_table.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

void write_silk_table(const std::filesystem::path& file, const std::string& grid,
                      const Arguments& options = {}) {
  Arguments all = {"tabulate", preset("silk").string(), "--grid", grid, "-o", file.string()};
  all.insert(all.end(), options.begin(), options.end());
  output_of(all);
}

bool same_values(const Table& a, const Table& b) {
  return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end());
}

bool loses(const json& told, const std::string& what) {
  return std::any_of(told["lost"].begin(), told["lost"].end(),
                     [&](const json& lost) { return lost.get<std::string>().starts_with(what); });
}

}  // namespace

TEST_CASE("an EXR table on MERL's grid goes to MERL and back to the same floats") {
  const TemporaryFolder folder;
  const std::string exr = (folder / "a.exr").string();
  const std::string binary = (folder / "a.binary").string();
  const std::string back = (folder / "b.exr").string();
  write_silk_table(exr, "halfdiff3d");
  const json there = json_of({"convert", exr, binary});
  CHECK(there["file"] == binary);
  CHECK(there["from"] == exr);
  CHECK(there["format"] == "MERL");
  CHECK(there["grid"] == "halfdiff3d:90x90x180");
  CHECK(there["cells"] == 1'458'000);
  CHECK(there["channels"] == 3);
  CHECK(there["bytes"] == std::filesystem::file_size(binary));
  CHECK(there["lost"] == json::array({"the description: material, effects and cells"}));
  CHECK(!there.contains("error"));
  CHECK_THAT(output_of({"convert", binary, back}),
             ContainsSubstring("\n  lost: digits: rounded by"));
  CHECK(folder.entry_count() == 3);
  CHECK(same_values(read_table(exr), read_table(back)));
}

TEST_CASE("negative marks of a MERL table survive the way to EXR and back") {
  const TemporaryFolder folder;
  const std::string first = (folder / "a.binary").string();
  const std::string exr = (folder / "a.exr").string();
  const std::string last = (folder / "b.binary").string();
  TableSpec spec = lambertian(halfdiff3d(), 0.5).spec();
  spec.channels = {{"R", Part::kTotal, 0}, {"G", Part::kTotal, 1}, {"B", Part::kTotal, 2}};
  std::vector<double> values(spec.cell_count() * 3, 0.25);
  std::vector<std::uint8_t> expected(spec.cell_count());
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    expected[cell] = spec.grid().any_above_horizon(cell) && cell % 11 != 0 ? 1 : 0;
    if (expected[cell] != 0) continue;
    for (std::size_t c = 0; c < 3; ++c) values[value_index(spec, cell, c)] = kNotMeasured;
  }
  write_table(Table(spec, values, expected), first);
  output_of({"convert", first, exr});
  output_of({"convert", exr, last});
  const Table table = read_table(last);
  std::size_t other_mask = 0;
  std::size_t other_values = 0;
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    other_mask += table.valid(cell) != (expected[cell] != 0);
    // 1/4, and -1 times a channel's scale and over it again to a few epsilons, rounded to a float.
    const double written = values[value_index(spec, cell, 1)];
    other_values += static_cast<float>(table.value(cell, 1)) != static_cast<float>(written);
  }
  CHECK(other_mask == 0);
  CHECK(other_values == 0);
}

TEST_CASE("convert says what is lost, and how far off the old nodes are") {
  const TemporaryFolder folder;
  const std::string in = (folder / "a.exr").string();
  const std::string out = (folder / "b.exr").string();
  write_silk_table(in, "halfdiff4d:12x6x12x12", {"--components"});

  const json nothing = json_of({"convert", in, out});
  CHECK(nothing["lost"].empty());
  CHECK(nothing["channels"] == 12);
  CHECK_THAT(output_of({"convert", in, out}), ContainsSubstring("  lost: nothing\n"));
  CHECK(same_values(read_table(in), read_table(out)));
  CHECK(read_table(in).spec() == read_table(out).spec());

  const json half = json_of({"convert", "--half", in, out});
  CHECK(half["lost"] ==
        json::array(
            {"digits: rounded by up to 0.00049 of the value, or by 3e-08 where that is more"}));
  CHECK(!half.contains("error"));

  const json resampled = json_of({"convert", "--grid", "halfdiff3d:20x20x20", in, out});
  CHECK(loses(resampled, "anisotropy"));
  CHECK(loses(resampled, "the nodes: resampled from halfdiff4d:12x6x12x12 to halfdiff3d:20x20x20"));
  CHECK(!loses(resampled, "the order"));  // silk is reciprocal
  CHECK(!loses(resampled, "the components"));
  CHECK(resampled["error"]["rms"].get<double>() > 0.01);
  CHECK(resampled["error"]["max"].get<double>() >= resampled["error"]["p99"].get<double>());
  CHECK(resampled["grid"] == "halfdiff3d:20x20x20");
  CHECK(read_table(out).spec().grid() == halfdiff3d(20, 20, 20));
  CHECK_THAT(output_of({"convert", "--grid", "inout:4x6x4x6", in, out}),
             ContainsSubstring("\n  relative error at the old nodes: rms "));
}

TEST_CASE("a table that MERL cannot hold is resampled, its components left out") {
  const TemporaryFolder folder;
  const std::string in = (folder / "a.exr").string();
  const std::string out = (folder / "a.binary").string();
  write_silk_table(in, "inout:4x4x4x6", {"--components"});
  const json told = json_of({"convert", in, out});
  for (const char* what : {"anisotropy", "the nodes", "the components", "the description"}) {
    INFO(what);
    CHECK(loses(told, what));
  }
  CHECK(told["channels"] == 3);
  CHECK(told.contains("error"));
  const Table table = read_table(out);
  CHECK(table.spec().grid() == halfdiff3d());
  CHECK(table.value(0, 0) > 0.05);
}

TEST_CASE("the paper's convention keeps both orders in EXR, and is told to lose them") {
  const TemporaryFolder folder;
  const std::string in = (folder / "a.exr").string();
  const std::string out = (folder / "b.exr").string();
  output_of({"tabulate", preset("silk_paper").string(), "--grid", "halfdiff4d:6x4x6x8", "-o", in});
  CHECK(!loses(json_of({"convert", "--grid", "halfdiff4d:7x4x6x8", in, out}), "the order"));
  CHECK(read_table(out).spec().grid().axes.back().highest_deg == 360);
}

TEST_CASE("a table may be converted onto itself") {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.exr").string();
  write_silk_table(file, "halfdiff4d:6x4x6x6");
  const Table before = read_table(file);
  output_of({"convert", "--compress", file, file});
  CHECK(folder.entry_count() == 1);
  CHECK(same_values(before, read_table(file)));
  CHECK(before.spec() == read_table(file).spec());
}

TEST_CASE("convert refuses what it cannot do and leaves nothing behind") {
  const TemporaryFolder folder;
  const std::string in = (folder / "a.exr").string();
  const auto in_folder = [&](const char* name) { return (folder / name).string(); };
  write_silk_table(in, "halfdiff4d:6x4x6x6");
  const Arguments refused[] = {
      {in, in_folder("b.png")},
      {in, in_folder("b")},
      {in_folder("none.exr"), in_folder("b.exr")},
      {folder.path().string() + "/", in_folder("b.exr")},
      {preset("silk").string(), in_folder("b.exr")},
      {in, in_folder("b.binary"), "--grid", "halfdiff3d:9x9x9"},
      {in, in_folder("b.binary"), "--grid", "inout"},
      {in, in_folder("b.exr"), "--grid", "merl"},
      {in, in_folder("b.binary"), "--half"},
      {in, in_folder("b.exr"), "--threads", "none"},
      {in},
      {in, in_folder("b.exr"), in_folder("c.exr")},
  };
  for (const Arguments& arguments : refused) {
    Arguments all = {"convert"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    CAPTURE(all);
    CHECK(not_a_refusal(run_program(all), 2) == "");
    CHECK(folder.entry_count() == 1);
  }
  std::filesystem::create_directory(folder / "d.exr");
  CHECK(not_a_refusal(run_program({"convert", in_folder("d.exr"), in_folder("b.exr")}), 2) == "");
  const Outcome onto = run_program({"convert", in, in_folder("d.exr")});
  CHECK(not_a_refusal(onto, onto.exit_code == 1 ? 1 : 2) == "");
  CHECK(folder.entry_count() == 2);
}

TEST_CASE("a value beyond half floats ends the conversion, and an older file stays") {
  const TemporaryFolder folder;
  const std::string in = (folder / "a.exr").string();
  const std::string out = (folder / "b.exr").string();
  write_table(with_value(lambertian(halfdiff3d(4, 4, 4), 0.5), 3, 0, 1e6), in);
  write_file(out, "old");
  CHECK(not_a_refusal(run_program({"convert", "--half", in, out}), 1) == "");
  CHECK(read_file(out) == "old");
  CHECK(folder.entry_count() == 2);
}

}  // namespace clothbrdf::test
