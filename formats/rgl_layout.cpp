#include "formats/rgl_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "formats/table_metadata.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

// Readers index files by 32-bit integers.
constexpr std::uint64_t kMostBytes = (std::uint64_t{1} << 31) - 1;
// One azimuth is written from memory as a whole, and 64 MB of it are 300 nodes along each axis.
constexpr std::uint64_t kMostIsotropicBytes = std::uint64_t{1} << 26;
constexpr std::size_t kLeastSquare = 4;

// One azimuth is isotropic. -pi ... pi: readers do not wrap, so that the first azimuth is there
// again as the last one.
std::vector<float> phi_nodes(std::size_t count) {
  std::vector<float> nodes(count);
  for (std::size_t k = 0; k < count && count > 1; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    nodes[k] = static_cast<float>((2 * part - 1) * std::numbers::pi);
  }
  return nodes;
}

// Denser towards the horizon, where f_r times the cosine changes fastest, but not at it: there is
// nothing to be seen, and readers would divide by a cosine of 0.
std::vector<float> theta_nodes(std::size_t count) {
  constexpr double kLast = 89 * std::numbers::pi / 180;
  std::vector<float> nodes(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(count - 1);
    nodes[k] = static_cast<float>(kLast * (t + std::sin(std::numbers::pi * t / 2)) / 2);
  }
  return nodes;
}

std::vector<float> wavelengths_of(const TableSpec& spec) {
  std::vector<float> wavelengths;
  for (const Channel& channel : spec.channels) {
    wavelengths.push_back(static_cast<float>(named_wavelength(channel.name).value()));
  }
  return wavelengths;
}

TensorHeader header_of(const RglSizes& s, const std::string& description, bool spectral) {
  constexpr TensorType kFloat = TensorType::kFloat32;
  std::vector<Tensor> fields = {
      {"description", TensorType::kUint8, {description.size()}},
      {"jacobian", TensorType::kUint8, {1}},
      {"phi_i", kFloat, {s.phi}},
      {"theta_i", kFloat, {s.theta}},
      {"ndf", kFloat, {kNdfSide, kNdfSide}},
      {"sigma", kFloat, {kSigmaRows, kSigmaColumns}},
      {"vndf", kFloat, {s.phi, s.theta, s.density, s.density}},
      {"luminance", kFloat, {s.phi, s.theta, s.square, s.square}},
      {spectral ? "spectra" : "rgb", kFloat, {s.phi, s.theta, s.channels, s.square, s.square}}};
  if (spectral) fields.insert(fields.begin() + 2, {"wavelengths", kFloat, {s.channels}});
  return tensor_header(std::move(fields));
}

// The nodes along the other axes for so many along each side of a slice: what gave the least error
// for a number of bytes, over presets.
RglSizes sizes_for(std::size_t square, bool isotropic, std::size_t channels) {
  return {.phi = isotropic ? 1 : square - 1,
          .theta = std::max<std::size_t>(3, square / 2),
          .square = square,
          .density = std::max<std::size_t>(4, (square * 2 + 2) / 5),
          .channels = channels};
}

}  // namespace

const Tensor& RglLayout::field(const std::string& name) const {
  return *std::find_if(header.fields.begin(), header.fields.end(),
                       [&](const Tensor& field) { return field.name == name; });
}

const std::string& RglLayout::values_field() const { return header.fields.back().name; }

std::string rgl_description(const TableSpec& spec) {
  const Provenance& from = spec.provenance;
  std::string text = "Cloth";
  if (from.material && !from.material->name.empty()) text = from.material->name;
  if (!from.program.empty()) text += ", by " + from.program;
  return text + "\n" + table_metadata(spec);
}

RglLayout rgl_layout(const TableSpec& spec, bool spectral, std::uint64_t bytes,
                     const std::string& name) {
  RglLayout layout;
  layout.description = rgl_description(spec);
  const auto bytes_of = [&](const RglSizes& sizes) {
    return header_of(sizes, layout.description, spectral).file_size;
  };
  const std::size_t channels = spec.channels.size();
  const bool isotropic = spec.isotropic();
  const std::uint64_t most = std::min(bytes, isotropic ? kMostIsotropicBytes : kMostBytes);
  RglSizes best = sizes_for(kLeastSquare, isotropic, channels);
  if (bytes_of(best) > most) {
    throw InputError(name + ": --size " + std::to_string(bytes) + " is too small: the smallest " +
                     "file of this table has " + std::to_string(bytes_of(best)) + " bytes");
  }
  for (std::size_t square = kLeastSquare; bytes_of(sizes_for(square, isotropic, channels)) <= most;
       ++square) {
    best = sizes_for(square, isotropic, channels);
  }
  // What is left goes to one axis at a time.
  for (std::size_t RglSizes::*const axis : {&RglSizes::theta, &RglSizes::square, &RglSizes::phi}) {
    RglSizes finer = best;
    finer.*axis += 1;
    if ((axis != &RglSizes::phi || !isotropic) && bytes_of(finer) <= most) best = finer;
  }
  layout.sizes = best;
  layout.phi_i = phi_nodes(best.phi);
  layout.theta_i = theta_nodes(best.theta);
  if (spectral) layout.wavelengths_nm = wavelengths_of(spec);
  layout.header = header_of(best, layout.description, spectral);
  return layout;
}

}  // namespace clothbrdf
