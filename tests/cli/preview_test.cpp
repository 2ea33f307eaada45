#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/material_json.h"
#include "preview/lobes.h"
#include "preview/panels.h"
#include "preview/sheet.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/make_table.h"
#include "tests/support/read_picture.h"
#include "tests/support/run_program.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

const std::string kCotton = preset("cotton").string();
constexpr int kSize = 16;

Arguments preview(const Arguments& files, const std::string& output, const Arguments& options) {
  Arguments arguments = {"preview"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  arguments.insert(arguments.end(), {"-o", output, "--size", std::to_string(kSize)});
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

// The linear picture that preview draws of files, 16 pixels a panel.
Image drawn(const Arguments& files, const Arguments& options) {
  const TemporaryFolder folder;
  output_of(preview(files, (folder / "p.exr").string(), options));
  return read_exr_picture(folder / "p.exr");
}

// The library's own sheet of a preset.
Image sheet(const std::string& name, SheetView view, Part part = Part::kTotal, double turn = 0) {
  view.size = kSize;
  const auto cloth = material_cloth(read_material(preset(name)), name);
  const Shading shading = cloth->shading(part);
  return render_sheet(turned(shading, turn), view, 1);
}

Image lobes(const std::string& name, double light_theta_deg) {
  return render_lobes(*material_cloth(read_material(preset(name)), name),
                      {light_theta_deg, 0, kSize});
}

// Panels without captions, as floats.
Image arranged(const std::vector<std::vector<Image>>& rows) {
  std::vector<std::vector<Panel>> panels;
  for (const std::vector<Image>& row : rows) {
    panels.emplace_back();
    for (const Image& image : row) panels.back().push_back({"", image});
  }
  Image image = arrange(panels);
  for (Rgb& pixel : image.pixels) {
    for (double& value : pixel) value = static_cast<float>(value);
  }
  return image;
}

// Whether two pictures of panels are the same, to a difference of a pixel, but for the captions.
bool same_panels(const Image& a, const Image& b, double difference = 0) {
  if (a.width != b.width || a.height != b.height) return false;
  constexpr int kStrip = 10;
  constexpr int kStep = kSize + kStrip + 4;
  for (int y = 0; y < a.height; ++y) {
    if (y >= 4 && (y - 4) % kStep < kStrip) continue;
    for (int x = 0; x < a.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (!(std::abs(a.at(x, y)[c] - b.at(x, y)[c]) <= difference)) return false;
      }
    }
  }
  return true;
}

std::string refused(const Arguments& arguments, int exit_code = 2) {
  const Outcome outcome = run_program(arguments);
  CAPTURE(arguments);
  CHECK(not_a_refusal(outcome, exit_code) == "");
  return outcome.err;
}

}  // namespace

TEST_CASE("preview draws the sheet by default, as the library does") {
  CHECK(same_panels(drawn({kSilk}, {}), arranged({{sheet("silk", {})}})));
}

TEST_CASE("exposure, light and eye of preview reach the sheet") {
  const Image picture =
      drawn({kSilk}, {"--exposure", "-1.5", "--light", "40,30", "--eye", "25.5,-100"});
  CHECK(same_panels(picture, arranged({{sheet("silk", {{40, 30}, {25.5, -100}, kSize, -1.5})}})));
}

TEST_CASE(
    "option --effects of preview reaches the materials, and is refused where there are none") {
  const Image picture = drawn({kSilk}, {"--effects", "internal:2,no-scatter", "--light", "20,0"});
  Effects effects;
  effects.specular = effects.diffuse = effects.scatter = false;
  effects.layers = 2;
  const auto shading =
      material_cloth(read_material(kSilk), kSilk, 1, effects)->shading(Part::kTotal);
  const Image expected = render_sheet(shading, {{20, 0}, {}, kSize, 0}, 1);
  CHECK(same_panels(picture, arranged({{expected}})));
  CHECK(!same_panels(picture, arranged({{sheet("silk", {{20, 0}, {}, kSize, 0})}})));

  const TemporaryFolder folder;
  const std::string table = (folder / "t.exr").string();
  write_table(preset_table("silk", inout(2, 4, 2, 4)), table);
  CHECK_THAT(refused(preview({table}, (folder / "p.png").string(), {"--effects", "internal"})),
             ContainsSubstring("--effects: not with tables alone"));
  CHECK(!std::filesystem::exists(folder / "p.png"));
  // Beside a table it is the material's.
  const Image both =
      drawn({kSilk, table}, {"--effects", "internal:2,no-scatter", "--light", "20,0"});
  CHECK(both.height > picture.height);
}

TEST_CASE("option --size is the edge of a panel in pixels") {
  const TemporaryFolder folder;
  const std::string png = (folder / "p.png").string();
  output_of({"preview", kSilk, kCotton, "-o", png, "--size", "20", "--show", "weave"});
  const Codes codes = read_png(png);
  CHECK(codes.width == 4 + 2 * (20 + 4));
  CHECK(codes.height == 4 + 2 * (20 + 10 + 4));
  output_of({"preview", kSilk, "-o", png});
  CHECK(read_png(png).width == 4 + 256 + 4);
}

TEST_CASE("option --show chooses the panels, one row a file") {
  const auto row_of = [](const std::string& name, const std::string& show) {
    const Image plain = sheet(name, {});
    const Image weave = sheet(name, {}, Part::kTotal, 45);
    const Image specular = sheet(name, {}, Part::kSpecular);
    const Image internal = sheet(name, {}, Part::kInternal);
    const Image diffuse = sheet(name, {}, Part::kDiffuse);
    if (show == "sheet") return std::vector{plain};
    if (show == "weave") return std::vector{plain, weave};
    if (show == "components") return std::vector{specular, internal, diffuse};
    if (show == "lobes") return std::vector{lobes(name, 30)};
    return std::vector{plain, weave, specular, internal, diffuse, lobes(name, 30)};
  };
  for (const char* show : {"sheet", "weave", "components", "lobes", "all"}) {
    CAPTURE(show);
    const Image picture = drawn({kSilk, preset("tamamushi").string()}, {"--show", show});
    CHECK(same_panels(picture, arranged({row_of("silk", show), row_of("tamamushi", show)})));
  }
}

TEST_CASE("option --light says the angle of the lobes' light, and 30 degrees where left out") {
  CHECK(same_panels(drawn({kSilk}, {"--show", "lobes"}), arranged({{lobes("silk", 30)}})));
  CHECK(same_panels(drawn({kSilk}, {"--show", "lobes", "--light", "55,10"}),
                    arranged({{lobes("silk", 55)}})));
  CHECK(same_panels(drawn({kSilk}, {"--show", "lobes", "--light", "0,0"}),
                    arranged({{lobes("silk", 0)}})));
}

TEST_CASE("a caption names the file, the view and what the ring of the lobes stands for") {
  const TemporaryFolder folder;
  std::filesystem::copy_file(kSilk, folder / "a.b.json");
  const std::string exr = (folder / "p.exr").string();
  constexpr int kWide = 160;  // for the longest of them
  output_of({"preview", (folder / "a.b.json").string(), "-o", exr, "--show", "all", "--size",
             std::to_string(kWide)});
  const Image picture = read_exr_picture(exr);
  std::vector<std::vector<Panel>> row(1);
  for (const char* view :
       {"", ", weave at 45 deg", ", specular", ", internal", ", diffuse", ", lobes: ring 0.2/sr"}) {
    row[0].push_back({std::string("a.b") + view, Image(kWide, kWide)});
  }
  const Image expected = arrange(row);
  REQUIRE(picture.width == expected.width);
  int other = 0;
  for (int y = 0; y < 14; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (picture.at(x, y)[1] != static_cast<float>(expected.at(x, y)[1])) ++other;
    }
  }
  CHECK(other == 0);
}

TEST_CASE("any number of threads draws the same bytes") {
  const TemporaryFolder folder;
  for (const std::string threads : {"1", "3"}) {
    output_of(preview({kSilk, kCotton}, (folder / (threads + ".png")).string(),
                      {"--show", "all", "--threads", threads}));
  }
  CHECK(read_file(folder / "1.png") == read_file(folder / "3.png"));
}

TEST_CASE("each output is written, and preview says so, with --json as one object a line") {
  const TemporaryFolder folder;
  const std::string png = (folder / "p.png").string();
  const std::string exr = (folder / "P.EXR").string();
  const std::string said = output_of(preview({kSilk}, png, {"-o", exr, "--show", "components"}));
  CHECK(said == png + ": 3 panels, 64 x 34 pixels\n" + exr + ": 3 panels, 64 x 34 pixels\n");
  CHECK(folder.entry_count() == 2);
  CHECK(read_png(png).width == 64);
  CHECK(read_exr_picture(exr).height == 34);
  CHECK(output_of(preview({kSilk}, png, {})) == png + ": 1 panel, 24 x 34 pixels\n");

  std::istringstream lines(output_of(preview({kSilk, kCotton}, png, {"-o", exr, "--json"})));
  for (const std::string& name : {png, exr}) {
    std::string line;
    REQUIRE(std::getline(lines, line));
    CHECK(json::parse(line) == json{{"file", name}, {"width", 24}, {"height", 64}, {"panels", 2}});
  }
}

TEST_CASE("materials and tables can be drawn in one picture") {
  const TemporaryFolder folder;
  const Table table = preset_table("silk", halfdiff4d(12, 8, 6, 6), true);
  const Table merl = preset_table("cotton", halfdiff3d());
  write_table(table, folder / "t.exr");
  write_table(merl, folder / "t.binary");
  const Image picture =
      drawn({kCotton, (folder / "t.exr").string(), (folder / "t.binary").string()}, {});
  std::vector<std::vector<Image>> rows = {{sheet("cotton", {})}};
  for (const char* name : {"t.exr", "t.binary"}) {
    const auto cloth = table_cloth(format_for(folder / name).read(folder / name), name);
    rows.push_back({render_sheet(cloth->shading(Part::kTotal), {{}, {}, kSize, 0}, 1)});
  }
  CHECK(same_panels(picture, arranged(rows)));
  CHECK(drawn({(folder / "t.exr").string()}, {"--show", "components"}).width == 64);
}

TEST_CASE("preview refuses what it cannot draw in one line and leaves nothing behind") {
  const TemporaryFolder folder;
  const TemporaryFolder inputs;
  const std::string png = (folder / "p.png").string();
  const auto why = [&](const Arguments& options) {
    return refused(preview({kSilk}, png, options));
  };
  CHECK(why({"--show", "sheets"}) ==
        "clothbrdf: --show: 'sheets' is not allowed: sheet, weave, components, lobes, all\n");
  for (const char* light : {"90,0", "-1,0", "30", "30,", "a,b", "30,0,0", "nan,0", "30,inf"}) {
    for (const char* option : {"--light", "--eye"}) {
      CHECK(why({option + std::string("=") + light}) ==
            std::string("clothbrdf: ") + option + ": '" + light +
                "' is not allowed: THETA,PHI in degrees, THETA from 0 to below 90\n");
    }
  }
  CHECK_THAT(why({"--exposure", "31"}),
             ContainsSubstring("--exposure: '31' is not allowed: a number from -30 to 30"));
  CHECK_THAT(why({"--threads", "0"}), ContainsSubstring("--threads: '0' is not allowed"));
  for (const char* size : {"15", "4097", "20.5", "big"}) {
    CHECK_THAT(refused({"preview", kSilk, "-o", png, "--size", size}),
               ContainsSubstring("' is not allowed: a whole number from 16 to 4096"));
  }
  CHECK_THAT(refused(preview({kSilk}, (folder / "p.jpg").string(), {"-o", png})),
             ContainsSubstring("p.jpg: the ending '.jpg' is not that of a picture"));
  CHECK_THAT(why({"-o", png}), ContainsSubstring("--output: " + png + " is given twice"));
  CHECK_THAT(refused({"preview", kSilk}), ContainsSubstring("--output"));
  CHECK_THAT(refused({"preview", "-o", png}), ContainsSubstring("FILE"));

  const auto why_file = [&](const std::string& file, const Arguments& options) {
    return refused(preview({kSilk, file}, png, options));
  };
  for (const char* name : {"missing.json", "missing.exr", "missing.binary"}) {
    const std::string file = (inputs / name).string();
    CHECK(why_file(file, {}).starts_with("clothbrdf: " + file + ": "));
  }
  CHECK_THAT(why_file((inputs / "a.txt").string(), {}),
             ContainsSubstring("a.txt: the ending '.txt' is not that of a table or a material; "
                               "known: .binary (MERL), .exr (EXR), "));
  for (const char* name : {"folder", "folder.exr", "folder.binary", "folder.json"}) {
    std::filesystem::create_directory(inputs / name);
    const std::string file = (inputs / name).string();
    CHECK(why_file(file, {}).starts_with("clothbrdf: " + file + ": "));
  }
  write_table(preset_table("silk", inout(2, 4, 2, 4)), inputs / "t.exr");
  for (const char* show : {"components", "all"}) {
    CHECK_THAT(why_file((inputs / "t.exr").string(), {"--show", show}),
               ContainsSubstring(std::string("t.exr: --show ") + show +
                                 ": the table holds totals only; write it with tabulate "
                                 "--components"));
  }
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("a picture never takes the place of a table it is drawn from") {
  const TemporaryFolder folder;
  const std::string exr = (folder / "t.exr").string();
  write_table(preset_table("silk", inout(2, 4, 2, 4)), exr);
  const std::string before = read_file(exr);
  CHECK_THAT(refused(preview({exr}, (folder / "." / "t.exr").string(), {})),
             ContainsSubstring("t.exr is also read; a picture needs another name"));
  CHECK(read_file(exr) == before);
}

TEST_CASE("a picture that cannot be written fails and leaves no other one behind") {
  const TemporaryFolder folder;
  const std::string png = (folder / "p.png").string();
  const std::string missing = (folder / "missing" / "p.png").string();
  CHECK_THAT(refused(preview({kSilk}, png, {"-o", missing}), 1),
             ContainsSubstring(missing + ": cannot write: No such file or directory"));
  // Enough for the PNG, not for the uncompressible EXR after it.
  const Outcome outcome = run_program(preview({kSilk}, png, {"-o", (folder / "p.exr").string()}),
                                      {.file_size_limit = 2500});
  CHECK(not_a_refusal(outcome, 1) == "");
  CHECK_THAT(outcome.err, ContainsSubstring("p.exr: cannot write: "));
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("a grey material of wavelengths is drawn as the grey RGB material") {
  const TemporaryFolder folder;
  Material grey = read_material(kSilk);
  for (Yarn* yarn : {&grey.warp, &grey.weft}) yarn->absorption = {0.3, 0.3, 0.3};
  write_file(folder / "rgb.json", material_to_json(grey));
  grey.wavelengths_nm = {420, 500, 580, 660};
  for (Yarn* yarn : {&grey.warp, &grey.weft}) yarn->absorption.assign(4, 0.3);
  write_file(folder / "spectral.json", material_to_json(grey));
  const Arguments options = {"--show", "components"};
  const Image rgb = drawn({(folder / "rgb.json").string()}, options);
  const Image spectral = drawn({(folder / "spectral.json").string()}, options);
  constexpr double kFloatRounding = 1e-6;
  CHECK(same_panels(rgb, spectral, kFloatRounding));
  CHECK_FALSE(same_panels(rgb, drawn({kSilk}, options), kFloatRounding));
}

}  // namespace clothbrdf::test
