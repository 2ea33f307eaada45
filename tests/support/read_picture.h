#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <png.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/image.h"

namespace clothbrdf::test {

/// The sRGB codes of a PNG file, three a pixel, rows from the top.
struct Codes {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> values;
};

inline Codes read_png(const std::filesystem::path& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&header, path.c_str()) == 0) {
    throw std::runtime_error(path.string() + ": " + header.message);
  }
  // Anything else, libpng would convert.
  if (header.format != PNG_FORMAT_RGB) throw std::runtime_error(path.string() + ": not 8-bit RGB");
  Codes codes{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  codes.values.resize(PNG_IMAGE_SIZE(header));
  if (png_image_finish_read(&header, nullptr, codes.values.data(), 0, nullptr) == 0) {
    throw std::runtime_error(path.string() + ": " + header.message);
  }
  return codes;
}

/// The linear values of an EXR file's channels R, G, B.
inline Image read_exr_picture(const std::filesystem::path& path) {
  Imf::InputFile in(path.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  Image image(window.max.x + 1, window.max.y + 1);
  std::vector<float> samples(image.pixels.size() * 3);
  const std::size_t row_bytes = 3 * sizeof(float) * static_cast<std::size_t>(image.width);
  Imf::FrameBuffer frame;
  const char* const names[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    if (in.header().channels().findChannel(names[c]) == nullptr) {
      throw std::runtime_error(path.string() + ": no channel " + names[c]);
    }
    frame.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data() + c),
                                      3 * sizeof(float), row_bytes));
  }
  in.setFrameBuffer(frame);
  in.readPixels(0, window.max.y);
  for (std::size_t p = 0; p < image.pixels.size(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) image.pixels[p][c] = samples[3 * p + c];
  }
  return image;
}

}  // namespace clothbrdf::test
