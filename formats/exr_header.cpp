#include "formats/exr_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "formats/json_text.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "EXR's integers are read as they are");

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kLongNames = 0x400;  // the only flag of a picture of scan lines in one part
// Deflate shrinks zeros by 1032 at most.
constexpr double kMostShrunk = 1100;

// What a header says of the picture.
struct Picture {
  std::array<std::int32_t, 4> window{0, 0, 0, 0};  // x and y of its corners
  double channels = 1;
};

struct FixedType {
  std::string_view name;
  std::uint32_t bytes;
};
// Of these OpenEXR reads so many bytes, whatever their size is said to be.
constexpr FixedType kFixedTypes[] = {{"box2f", 16},
                                     {"box2i", 16},
                                     {"chromaticities", 32},
                                     {"compression", 1},
                                     {"deepImageState", 1},
                                     {"double", 8},
                                     {"envmap", 1},
                                     {"float", 4},
                                     {"int", 4},
                                     {"keycode", 28},
                                     {"lineOrder", 1},
                                     {"m33d", 72},
                                     {"m33f", 36},
                                     {"m44d", 128},
                                     {"m44f", 64},
                                     {"rational", 8},
                                     {"tiledesc", 9},
                                     {"timecode", 8},
                                     {"v2d", 16},
                                     {"v2f", 8},
                                     {"v2i", 8},
                                     {"v3d", 24},
                                     {"v3f", 12},
                                     {"v3i", 12}};

double extent(std::int32_t low, std::int32_t high) {
  return std::max(static_cast<double>(high) - low + 1, 1.0);
}

class HeaderReader {
 public:
  explicit HeaderReader(const std::filesystem::path& path)
      : name_(path.string()),
        in_(path, std::ios::binary),
        bytes_(std::filesystem::file_size(path)) {}

  void check() {
    if (integer() != kMagic) refuse("this is no EXR picture");
    const std::uint32_t version = integer();
    if ((version & ~kLongNames) != kVersion) {
      refuse("this is no EXR picture of scan lines in one part");
    }
    Picture picture;
    for (std::string attribute = text(); !attribute.empty(); attribute = text()) {
      const std::string type = text();
      const std::uint32_t size = integer();
      const auto at = static_cast<std::uint64_t>(in_.tellg());
      if (size > bytes_ - at) {
        refuse("its attribute '" + one_line(attribute) + "' claims " + std::to_string(size) +
               " bytes; " + std::to_string(bytes_ - at) + " are left");
      }
      note(attribute, type, size, picture);
      in_.seekg(static_cast<std::streamoff>(at + size));
    }
    const auto& [left, top, right, bottom] = picture.window;
    const double halves =
        extent(left, right) * extent(top, bottom) * picture.channels * sizeof(std::uint16_t);
    if (halves > kMostShrunk * static_cast<double>(bytes_)) {
      refuse("the file is too short for its picture");
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(name_ + ": cannot read: " + what);
  }

  void read(char* to, std::size_t count) {
    if (!in_.read(to, static_cast<std::streamsize>(count))) refuse("the file is cut off");
  }

  std::uint32_t integer() {
    std::array<char, sizeof(std::uint32_t)> bytes;
    read(bytes.data(), bytes.size());
    return std::bit_cast<std::uint32_t>(bytes);
  }

  std::string text() {
    std::string found;
    if (!std::getline(in_, found, '\0') || in_.eof()) refuse("the file is cut off");
    return found;
  }

  void note(const std::string& attribute, const std::string& type, std::uint32_t size,
            Picture& picture) {
    for (const FixedType& fixed : kFixedTypes) {
      if (type != fixed.name || size == fixed.bytes) continue;
      refuse("its attribute '" + one_line(attribute) + "' has " + std::to_string(size) +
             " bytes; a " + type + " has " + std::to_string(fixed.bytes));
    }
    if (type == "box2i" && attribute == "dataWindow") {
      std::array<char, sizeof(picture.window)> bytes;
      read(bytes.data(), bytes.size());
      picture.window = std::bit_cast<std::array<std::int32_t, 4>>(bytes);
    } else if (type == "chlist") {
      // Each a name and 16 bytes; an empty name ends them.
      const std::uint64_t end = static_cast<std::uint64_t>(in_.tellg()) + size;
      double channels = 0;
      for (; !text().empty(); ++channels) in_.seekg(16, std::ios::cur);
      if (static_cast<std::uint64_t>(in_.tellg()) != end) {
        refuse("its list of channels is not as long as it claims");
      }
      picture.channels = std::max(channels, 1.0);
    }
  }

  std::string name_;
  std::ifstream in_;
  std::uint64_t bytes_;
};

}  // namespace

void require_honest_exr_header(const std::filesystem::path& path) { HeaderReader(path).check(); }

}  // namespace clothbrdf
