#include <iostream>

#include "tests/catch.h"
#include "tests/pictures/sheets.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

constexpr int kSize = 64;
const SheetView kAbove = {{}, {}, kSize, 0};
const SheetView kNearlyAbove = {{12, 30}, {8, 190}, kSize, 0};
const SheetView kOblique = {{35, 30}, {25, 190}, kSize, 0};

// A preset's table, written to a file and read back.
std::unique_ptr<Cloth> tabulated(const std::string& name, const Grid& grid, const char* file,
                                 bool components = false) {
  const TemporaryFolder folder;
  write_table(preset_table(name, grid, components), folder / file);
  return table_cloth(format_for(folder / file).read(folder / file), file);
}

Difference against_material(const Cloth& table, const std::string& name, const SheetView& view,
                            Part part = Part::kTotal) {
  return difference(sheet_of(*preset_cloth(name), view, part), sheet_of(table, view, part));
}

void print(const std::string& what, const Difference& d) {
  std::cout << what << ": rms " << d.rms << ", largest " << d.max << "\n";
}

}  // namespace

TEST_CASE("an EXR table of the default grid draws its material's sheet") {
  for (const char* name : {"silk", "tamamushi"}) {
    const auto table = tabulated(name, halfdiff4d(), "t.exr");
    for (const SheetView& view : {kAbove, kOblique}) {
      const Difference d = against_material(*table, name, view);
      print(std::string(name) + "'s default EXR table, light at " +
                std::to_string(static_cast<int>(view.light.theta_deg)),
            d);
      // Of second order in cells of 2 to 5 degrees.
      CHECK(d.rms <= 0.002);
      CHECK(d.max <= 0.01);
    }
  }
}

TEST_CASE("a grid twice as fine draws the sheet four times as well") {
  for (const char* name : {"silk", "tamamushi"}) {
    const auto coarse = tabulated(name, halfdiff4d(30, 24, 20, 12), "t.exr");
    const auto fine = tabulated(name, halfdiff4d(60, 48, 40, 24), "t.exr");
    const auto gain = [&](const SheetView& view) {
      const double before = against_material(*coarse, name, view).rms;
      const double after = against_material(*fine, name, view).rms;
      std::cout << name << ", light at " << view.light.theta_deg << ": rms " << before
                << " with 30x24x20x12, " << after << " with 60x48x40x24: " << before / after
                << " times better\n";
      CHECK(before <= 0.005);
      return before / after;
    };
    CHECK_THAT(gain(kAbove), Catch::Matchers::WithinAbs(4, 0.2));
    // The one theta_d of the picture lies elsewhere between the nodes of each grid.
    CHECK_THAT(gain(kNearlyAbove), Catch::Matchers::WithinAbs(4, 0.5));
    // Less where facets cross the edge at which shadowing sets in: first order in a strip one cell
    // wide, 2^1.5 in all.
    CHECK_THAT(gain(kOblique), Catch::Matchers::WithinAbs(std::pow(2, 1.5), 0.3));
  }
}

TEST_CASE("a table with components draws each of them") {
  const auto table = tabulated("tamamushi", halfdiff4d(), "t.exr", true);
  for (const Part part : {Part::kTotal, Part::kSpecular, Part::kInternal, Part::kDiffuse}) {
    const Difference d = against_material(*table, "tamamushi", kAbove, part);
    print("tamamushi's part " + std::to_string(static_cast<int>(part)), d);
    // The diffuse part is constant: the rounding to float is left.
    CHECK(d.rms <= (part == Part::kDiffuse ? 0x1p-24 : 0.005));
  }
}

TEST_CASE("a MERL table draws the mean over the rotations of the weave") {
  for (const char* name : {"silk", "tamamushi"}) {
    const auto table = tabulated(name, halfdiff3d(), "t.binary");
    const auto material = preset_cloth(name);
    for (const SheetView& view : {kAbove, kOblique}) {
      // The trapezoid rule converges geometrically for a periodic function.
      constexpr int kTurns = 40;
      Image rotations(kSize, kSize);
      for (int k = 0; k < kTurns; ++k) {
        const Image image = sheet_of(*material, view, Part::kTotal, 180.0 * k / kTurns);
        for (std::size_t p = 0; p < image.pixels.size(); ++p) {
          for (std::size_t c = 0; c < 3; ++c) {
            rotations.pixels[p][c] += image.pixels[p][c] / kTurns;
          }
        }
      }
      const Difference d = difference(rotations, sheet_of(*table, view));
      print(std::string(name) + "'s MERL table against the mean over rotations", d);
      CHECK(d.rms <= 0.0005);
      CHECK(d.max <= 0.01);
      const Difference lost = difference(sheet_of(*material, view), sheet_of(*table, view));
      print("  and against the weave as it is", lost);
      CHECK(lost.rms >= 0.03);
    }
  }
}

}  // namespace clothbrdf::test
