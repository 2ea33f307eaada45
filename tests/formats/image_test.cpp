#include "formats/image.h"

#include <ImfChannelList.h>

#include <cmath>
#include <limits>

#include "support/errors.h"
#include "support/srgb.h"
#include "tests/catch.h"
#include "tests/support/mounted_folder.h"
#include "tests/support/read_picture.h"

namespace clothbrdf::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void write(const Image& image, const std::filesystem::path& path) {
  AtomicFile file(path);
  write_picture(image, file);
  file.commit();
}

// What a call throws, as text.
template <class Error, class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

TEST_CASE("a PNG holds the sRGB code of each value, cut off beyond 0 and 1, rows from the top") {
  const TemporaryFolder folder;
  Image image(3, 2);
  image.at(0, 0) = {0, 1, 0.5};
  image.at(1, 0) = {1.5, -0.25, kNaN};
  image.at(2, 0) = {kInfinity, -kInfinity, 1e-9};
  image.at(0, 1) = {0.18, 0.0031308, 0.0025};
  image.at(1, 1) = {srgb_to_linear(100.0 / 255), srgb_to_linear(1.0 / 255), 254.9 / 255};
  write(image, folder / "p.png");
  const Codes codes = read_png(folder / "p.png");
  CHECK(codes.width == 3);
  CHECK(codes.height == 2);
  // By hand from IEC 61966-2-1: 0.5 is 187.516, 0.18 is 117.65, 0.0031308 is 10.315, 0.0025 is
  // 8.236; 0.99961 is 254.96.
  const std::vector<std::uint8_t> expected = {0,   255, 188, 255, 0, 0,   255, 0, 0,
                                              118, 10,  8,   100, 1, 255, 0,   0, 0};
  CHECK(codes.values == expected);
}

TEST_CASE("every code of sRGB can be written and read back") {
  const TemporaryFolder folder;
  Image image(256, 1);
  for (int code = 0; code < 256; ++code) {
    const double value = srgb_to_linear(code / 255.0);
    image.at(code, 0) = {value, value, value};
  }
  write(image, folder / "codes.png");
  const Codes codes = read_png(folder / "codes.png");
  REQUIRE(codes.values.size() == 768);
  for (std::size_t k = 0; k < 768; ++k) CHECK(codes.values[k] == k / 3);
}

TEST_CASE("an EXR picture holds the linear floats, whatever they are, and only R, G, B") {
  const TemporaryFolder folder;
  Image image(3, 2);
  for (int k = 0; k < 6; ++k) image.at(k % 3, k / 3) = {0.1 * k, -2.5 * k, 1e6 / 3 + k};
  image.at(2, 1) = {kNaN, kInfinity, 1e-20};
  write(image, folder / "p.exr");
  const Image back = read_exr_picture(folder / "p.exr");
  REQUIRE(back.width == 3);
  REQUIRE(back.height == 2);
  for (std::size_t p = 0; p < 5; ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(back.pixels[p][c] == static_cast<float>(image.pixels[p][c]));
    }
  }
  CHECK(std::isnan(back.pixels[5][0]));
  CHECK(back.pixels[5][1] == kInfinity);
  CHECK(back.pixels[5][2] == 1e-20F);
  const Imf::InputFile in((folder / "p.exr").c_str());
  int channels = 0;
  for (auto at = in.header().channels().begin(); at != in.header().channels().end(); ++at) {
    ++channels;
    CHECK(at.channel().type == Imf::FLOAT);
  }
  CHECK(channels == 3);
}

TEST_CASE("endings of pictures are known in any case, others refused in one line") {
  const TemporaryFolder folder;
  const Image image(2, 1, {1, 0, 0.5});
  write(image, folder / "A.PNG");
  write(image, folder / "A.Exr");
  CHECK(read_png(folder / "A.PNG").values == std::vector<std::uint8_t>{255, 0, 188, 255, 0, 188});
  CHECK(read_exr_picture(folder / "A.Exr").pixels == image.pixels);
  for (const char* name : {"a.jpg", "a.pn", "png", "a", ".png", "a.png.", "a.binary"}) {
    const std::string why = error_of<InputError>([&] { check_picture_name(name); });
    CAPTURE(name);
    CHECK(why.starts_with(std::string(name) + ": the ending '"));
    CHECK(why.ends_with("' is not that of a picture; known: .png (sRGB), .exr (linear)"));
  }
}

TEST_CASE("a picture that cannot be written is a WorkError and leaves nothing") {
  const TemporaryFolder folder;
  const Image image(2, 2);
  for (const char* name : {"p.png", "p.exr"}) {
    const std::filesystem::path path = folder / "missing" / name;
    CHECK(error_of<WorkError>([&] { write(image, path); }) ==
          path.string() + ": cannot write: No such file or directory");
  }
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("a picture for which the disk is too small is a WorkError and leaves the old file") {
  const MountedFolder disk(1);
  if (!disk.ready()) {
    WARN("the system allows no mounts: not tested here");
    return;
  }
  // Noise, so that it takes more than a mebibyte however it is packed.
  Image image(800, 600);
  std::uint32_t state = 1;
  for (Rgb& pixel : image.pixels) {
    for (double& value : pixel) value = (state = state * 1664525 + 1013904223) * 0x1p-32;
  }
  for (const char* name : {"p.png", "p.exr"}) {
    const std::filesystem::path path = disk / name;
    write_file(path, "old");
    CAPTURE(path);
    CHECK_THAT(error_of<WorkError>([&] { write(image, path); }),
               ContainsSubstring("cannot write: No space left on device"));
    CHECK(read_file(path) == "old");
  }
  CHECK(disk.entry_count() == 2);
}

}  // namespace clothbrdf::test
