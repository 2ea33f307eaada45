#include "formats/image.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "formats/exr_stream.h"
#include "support/errors.h"
#include "support/srgb.h"

namespace clothbrdf {
namespace {

// In small letters: A.PNG is a picture, too, as A.EXR is a table.
std::string ending(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_png(const std::filesystem::path& path) { return ending(path) == ".png"; }

void write_png(const Image& image, AtomicFile& file) {
  std::vector<png_byte> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    for (const double value : pixel) {
      // A value that is not a number is black.
      const double encoded = value > 0 ? linear_to_srgb(std::min(value, 1.0)) : 0;
      bytes.push_back(static_cast<png_byte>(std::lround(encoded * 255)));
    }
  }
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::vector<std::byte> png(size);
  if (png_image_write_to_memory(&header, png.data(), &size, 0, bytes.data(), 0, nullptr) == 0) {
    throw WorkError(file.name().string() + ": cannot write: " + header.message);
  }
  file.write_at(0, std::span(png).first(size));
}

void write_exr_picture(const Image& image, AtomicFile& file) {
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<float> samples;
  samples.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    for (const double value : pixel) samples.push_back(static_cast<float>(value));
  }
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    const char* const names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
      frame.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data() + c),
                                        3 * sizeof(float), 3 * width * sizeof(float)));
    }
    AtomicOStream stream(file);
    {
      Imf::OutputFile out(stream, header);
      out.setFrameBuffer(frame);
      out.writePixels(image.height);
    }
    stream.finish();
  } catch (const Iex::BaseExc& error) {
    throw WorkError(file.name().string() + ": cannot write: " + error.what());
  }
}

}  // namespace

void check_picture_name(const std::filesystem::path& path) {
  if (is_png(path) || ending(path) == ".exr") return;
  throw InputError(path.string() + ": the ending '" + path.extension().string() +
                   "' is not that of a picture; known: .png (sRGB), .exr (linear)");
}

void write_picture(const Image& image, AtomicFile& file) {
  check_picture_name(file.name());
  if (is_png(file.name())) {
    write_png(image, file);
  } else {
    write_exr_picture(image, file);
  }
}

}  // namespace clothbrdf
