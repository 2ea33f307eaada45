#include "formats/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <cmath>
#include <iostream>

#include "formats/table_metadata.h"
#include "support/errors.h"
#include "table/mixed_channels.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

Table read_exr(const std::filesystem::path& path) { return format_for(path).read(path); }

Table constant_table(const Grid& grid, double value) {
  TableSpec spec = material_spec(read_material(preset("silk")), {}, grid);
  const std::size_t count = spec.cell_count();
  return {spec, std::vector<double>(3 * count, value), std::vector<std::uint8_t>(count, 1)};
}

}  // namespace

TEST_CASE("an EXR file alone rebuilds its table: grid, channels, provenance and values to float") {
  const TemporaryFolder folder;
  for (const Grid& grid : {halfdiff4d(5, 4, 6, 8), halfdiff3d(9, 7, 8), inout(4, 6, 3, 5)}) {
    for (const bool components : {false, true}) {
      for (const bool compress : {false, true}) {
        const Table table = preset_table("tamamushi", grid, components, {true, 1e-2});
        write_table(table, folder / "t.exr", {.compress = compress});
        const Table back = read_exr(folder / "t.exr");
        CHECK(back.spec() == table.spec());
        for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
          CHECK(back.valid(cell) == table.valid(cell));
          for (std::size_t c = 0; c < table.spec().channels.size(); ++c) {
            CHECK(back.value(cell, c) == static_cast<float>(table.value(cell, c)));
          }
        }
      }
    }
  }
}

TEST_CASE("mixed channels, which are no one absorption value, come back as such") {
  const TemporaryFolder folder;
  const Table silk = preset_table("silk", inout(2, 4, 2, 4));
  const Table spectrum = collect(*to_spectrum(silk), 1);
  REQUIRE(spectrum.spec().channels[3].colour == kNoColour);
  write_table(spectrum, folder / "t.exr");
  CHECK(read_exr(folder / "t.exr").spec() == spectrum.spec());
}

TEST_CASE("rows of the picture are the first pair of axes, columns the second") {
  const TemporaryFolder folder;
  const Table table = preset_table("silk", halfdiff4d(5, 4, 6, 8), true);
  write_table(table, folder / "t.exr");
  Imf::InputFile in((folder / "t.exr").c_str());
  const Imath::Box2i window = in.header().dataWindow();
  REQUIRE(window.max.x + 1 == 48);
  REQUIRE(window.max.y + 1 == 20);
  std::vector<float> g(20 * 48);
  std::vector<float> specular(20 * 48);
  Imf::FrameBuffer frame;
  frame.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(g.data()), 4, 48 * 4));
  frame.insert("specular.G",
               Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(specular.data()), 4, 48 * 4));
  in.setFrameBuffer(frame);
  in.readPixels(0, 19);
  // theta_h 3, phi_h 2, theta_d 1, phi_d 5.
  const std::size_t cell = ((3 * 4 + 2) * 6 + 1) * 8 + 5;
  CHECK(g[(3 * 4 + 2) * 48 + 1 * 8 + 5] == static_cast<float>(table.value(cell, 1)));
  CHECK(specular[(3 * 4 + 2) * 48 + 1 * 8 + 5] == static_cast<float>(table.value(cell, 4)));
  CHECK(full_name(table.spec().channels[4]) == "specular.G");
}

TEST_CASE(
    "half floats are exact to 2^-11, and a value that does not fit is an error that says where") {
  const TemporaryFolder folder;
  const Grid grid = halfdiff4d(5, 4, 6, 8);
  const Table table = preset_table("cotton", grid);
  write_table(table, folder / "t.exr", {.half = true});
  const Table back = read_exr(folder / "t.exr");
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    CHECK(std::abs(back.value(cell, 0) - table.value(cell, 0)) <=
          0x1p-11 * table.value(cell, 0) + 1e-7);
  }
  AtomicFile file(folder / "big.exr");
  CHECK_THROWS_WITH(format_for("big.exr").write(constant_table(grid, 65520), file, {.half = true}),
                    ContainsSubstring("R is 65520") && ContainsSubstring("theta_h") &&
                        ContainsSubstring("65504") && ContainsSubstring("leave out --half"));
  CHECK_NOTHROW(format_for("big.exr").write(constant_table(grid, 65504), file, {.half = true}));
  CHECK_THROWS_WITH(format_for("big.exr").write(constant_table(grid, 1e39), file, {}),
                    ContainsSubstring("R is 1e+39"));
}

TEST_CASE(
    "the description of a table follows its schema and reads back, for every grid and material") {
  RandomInputs random(seed_from_environment());
  const MaterialRanges ranges;
  for (int n = 0; n < 100; ++n) {
    const Grid grids[] = {halfdiff3d(random.integer(1, 99), 2, 3), halfdiff4d(3, 4, 5, 6, 360),
                          inout(2, 3, 4, 5)};
    const CellRule rule{random.chance(0.5), random.log_uniform(1e-9, 1)};
    TableSpec spec =
        material_spec(random.material(ranges), {random.chance(0.5), true, random.chance(0.5)},
                      grids[n % 3], rule, random.chance(0.5));
    if (!rule.average) spec.cells.tolerance = CellRule{}.tolerance;
    CHECK(parse_table_metadata(table_metadata(spec), "t.exr") == spec);
  }
}

TEST_CASE("an EXR picture that is not one of our tables is refused in one line") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& part) {
    CHECK_THROWS_WITH(read_exr(folder / name), ContainsSubstring((folder / name).string() + ": ") &&
                                                   ContainsSubstring(part) &&
                                                   !ContainsSubstring("\n"));
    CHECK_THROWS_AS(read_exr(folder / name), InputError);
  };
  const auto picture = [&](const std::string& name, int width, int height,
                           const std::string& attribute, const std::vector<std::string>& channels) {
    Imf::Header header(width, height);
    if (!attribute.empty()) header.insert("clothbrdf", Imf::StringAttribute(attribute));
    Imf::FrameBuffer frame;
    std::vector<float> line(static_cast<std::size_t>(width));
    for (const std::string& channel : channels) {
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(line.data()), 4, 0));
    }
    Imf::OutputFile out((folder / name).c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(height);
  };
  const TableSpec spec = material_spec(read_material(preset("silk")), {}, halfdiff4d(5, 4, 6, 8));
  const std::string good = table_metadata(spec);
  picture("plain.exr", 4, 4, "", {"R"});
  refused("plain.exr", "no attribute 'clothbrdf'");
  picture("size.exr", 48, 21, good, {"R", "G", "B"});
  refused("size.exr", "not of the size of its grid halfdiff4d:5x4x6x8");
  picture("missing.exr", 48, 20, good, {"R", "G"});
  refused("missing.exr", "channel B is missing");
  picture("more.exr", 48, 20, good, {"R", "G", "B", "A"});
  refused("more.exr", "4 channels");
  picture("text.exr", 48, 20, "not JSON", {"R", "G", "B"});
  refused("text.exr", "attribute 'clothbrdf'");
  std::string changed = good;
  changed.replace(changed.find("\"point\""), 7, "\"other\"");
  picture("rule.exr", 48, 20, changed, {"R", "G", "B"});
  refused("rule.exr", "/cells/rule");
  changed = good;
  changed.replace(changed.find("\"size\":5"), 8, "\"size\":0");
  picture("zero.exr", 48, 20, changed, {"R", "G", "B"});
  refused("zero.exr", "/grid/axes/0/size");
  changed = good;
  changed.replace(changed.find("\"phi_h\""), 7, "\"phi_d\"");
  picture("axes.exr", 48, 20, changed, {"R", "G", "B"});
  refused("axes.exr", "not the axes of a halfdiff4d grid");
  write_file(folder / "noise.exr", std::string(1000, 'x'));
  refused("noise.exr", "cannot read: this is no EXR picture");
  write_table(preset_table("silk", halfdiff4d(5, 4, 6, 8)), folder / "whole.exr");
  const std::string whole = read_file(folder / "whole.exr");
  // What OpenEXR would believe, and set aside memory for.
  const auto claims = [&](std::size_t at, const std::string& bytes, const std::string& part) {
    std::string claiming = whole;
    claiming.replace(at, bytes.size(), bytes);
    write_file(folder / "claims.exr", claiming);
    refused("claims.exr", part);
  };
  const std::size_t type = whole.find("string");
  claims(type + 7, "\xf0\xff\xff\x70", "its attribute 'clothbrdf' claims 1895825392 bytes");
  claims(whole.find("box2i") + 18, "\xff\xff\xff\x7f", "too short for its picture");
  claims(5, "\x02", "scan lines in one part");
  write_file(folder / "header.exr", whole.substr(0, type));
  refused("header.exr", "the file is cut off");
  write_file(folder / "cut.exr", whole.substr(0, whole.size() - 100));
  refused("cut.exr", "");
  write_file(folder / "more_bytes.exr", whole + "x");
  refused("more_bytes.exr", "bytes follow the end of the picture");
  write_table(preset_table("silk", halfdiff4d(5, 4, 6, 8)), folder / "zip.exr", {.compress = true});
  write_file(folder / "zip.exr", read_file(folder / "zip.exr") + std::string(1000, '\0'));
  refused("zip.exr", "bytes follow the end of the picture");
  CHECK_THROWS_AS(read_exr(folder / "absent.exr"), InputError);
  CHECK_THROWS_AS(read_exr(folder.path()), InputError);
}

TEST_CASE("random damage to an EXR file gives a table or an InputError, nothing else") {
  const TemporaryFolder folder;
  write_table(preset_table("silk", halfdiff4d(3, 2, 2, 3)), folder / "t.exr");
  const std::string whole = read_file(folder / "t.exr");
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  int read = 0;
  int refused = 0;
  for (int n = 0; n < 400; ++n) {
    std::string damaged = whole;
    for (int k = random.integer(1, 4); k > 0; --k) {
      // Most of the damage goes to the header.
      const double share = random.chance(0.8) ? 0.8 : 1.0;
      const auto at =
          static_cast<std::size_t>(random.unit() * share * static_cast<double>(damaged.size()));
      damaged[at] = static_cast<char>(random.integer(0, 255));
    }
    if (random.chance(0.2))
      damaged.resize(static_cast<std::size_t>(random.unit() * static_cast<double>(damaged.size())));
    write_file(folder / "d.exr", damaged);
    try {
      static_cast<void>(read_exr(folder / "d.exr"));
      ++read;
    } catch (const InputError& error) {
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
      ++refused;
    }
  }
  std::cout << "damaged EXR files: " << read << " read, " << refused << " refused (seed " << seed
            << ")\n";
  CHECK(read > 10);
  CHECK(refused > 100);
}

}  // namespace clothbrdf::test
