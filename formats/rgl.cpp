#include "formats/rgl.h"

#include <limits>
#include <string>

#include "formats/rgl_layout.h"
#include "formats/rgl_reader.h"
#include "formats/rgl_writer.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr std::string_view kRglOptions[] = {"--flavour", "--size"};
constexpr std::uint64_t kDefaultBytes = 5'000'000;

bool spectral(const WriteOptions& options) {
  return options.flavour.value_or(Flavour::kRgb) == Flavour::kSpectral;
}

RglLayout layout_of(const TableSpec& spec, const WriteOptions& options, const std::string& name) {
  return rgl_layout(spec, spectral(options), options.bytes.value_or(kDefaultBytes), name);
}

void check_rgl(const TableSpec& spec, const WriteOptions& options, const std::string& name) {
  if (!std::holds_alternative<AnyPairs>(spec.samples)) {
    throw InputError(name + ": " + spec.description() +
                     " is not allowed: RGL files have nodes of their own; leave out --grid");
  }
  // As the file holds them: in floats.
  float before = 0;
  for (const Channel& channel : spec.channels) {
    if (!spectral(options)) break;
    const auto wavelength = static_cast<float>(named_wavelength(channel.name).value());
    if (!(wavelength > before)) {
      throw InputError(name + ": the wavelength " + number_text(double{wavelength}) + " nm after " +
                       number_text(double{before}) +
                       " is not allowed: RGL files hold ascending ones");
    }
    before = wavelength;
  }
  layout_of(spec, options, name);
}

}  // namespace

Format rgl_format() {
  return {
      .name = "RGL",
      .ending = ".bsdf",
      .summary = "anisotropic table that renderers sample from, of any size",
      .options = kRglOptions,
      .default_samples = [](Reflectance, bool isotropic) -> Samples { return AnyPairs{isotropic}; },
      .colours =
          [](const WriteOptions& options) {
            return spectral(options) ? Colours::kSpectrum : Colours::kRgb;
          },
      .keeps_description = true,
      .averages = "",
      .precision =
          [](const WriteOptions&) {
            return StoredPrecision{0x1p-24, 0x1p-149, std::numeric_limits<float>::max(), 4};
          },
      .check = check_rgl,
      .layout = [](const TableSpec& spec, const WriteOptions& options) -> Layout {
        const RglSizes s = layout_of(spec, options, "").sizes;
        const auto times = [](std::size_t a, std::size_t b) {
          return std::to_string(a) + "x" + std::to_string(b);
        };
        return {times(s.phi, s.theta) + " eyes of " + times(s.square, s.square) + " lights",
                s.cells()};
      },
      .write =
          [](const Producer& producer, AtomicFile& file, const WriteOptions& options) {
            const RglLayout layout = layout_of(producer.spec(), options, file.name().string());
            write_rgl(producer, layout, file, options.workers);
          },
      .read = read_rgl};
}

}  // namespace clothbrdf
