#include "formats/rgl_tensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "formats/square.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
// Angles are floats: half pi is rounded up.
constexpr double kAngleRounding = 1e-6;

struct AxisRange {
  double lowest;
  double highest;
  const char* unit;
};

[[noreturn]] void refuse_node(const TensorFile& file, const std::string& name, std::size_t index,
                              double node, const AxisRange& allowed) {
  throw InputError(file.name() + ": field '" + name + "': node " + std::to_string(index) + " is " +
                   number_text(node) + "; ascending values from " + number_text(allowed.lowest) +
                   " to " + number_text(allowed.highest) + " " + allowed.unit + " are allowed");
}

std::vector<float> read_axis(const TensorFile& file, const std::string& name,
                             const AxisRange& range) {
  const Tensor& field = file.field(name);
  if (field.shape.size() != 1) file.refuse_shape(field, "one dimension is");
  std::vector<float> nodes = file.numbers(field);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double node = double{nodes[k]};
    const bool inside = node >= range.lowest && node <= range.highest;
    if (!inside || (k > 0 && nodes[k] <= nodes[k - 1])) refuse_node(file, name, k, node, range);
  }
  return nodes;
}

void check_no_densities_below_zero(const TensorFile& file, const std::string& name,
                                   std::span<const float> values) {
  for (const float value : values) {
    if (std::isfinite(value) && value >= 0) continue;
    throw InputError(file.name() + ": field '" + name + "' holds " + number_text(double{value}) +
                     "; finite values of at least 0 are allowed");
  }
}

}  // namespace

RglTensors::RglTensors(const TensorFile& file)
    : phi_i_(read_axis(file, "phi_i",
                       {-2 * kPi - kAngleRounding, 2 * kPi + kAngleRounding, "radians"})),
      theta_i_(read_axis(file, "theta_i", {0, kPi / 2 + kAngleRounding, "radians"})),
      ndf_(read_grid(file, "ndf")),
      sigma_(read_grid(file, "sigma")),
      warp_(read_warp(file)) {
  read_axes(file);
  read_values(file);
}

RglTensors::Grid2d RglTensors::read_grid(const TensorFile& file, const std::string& name) {
  const Tensor& field = file.field(name);
  if (field.shape.size() != 2 || field.shape[0] < 2 || field.shape[1] < 2) {
    file.refuse_shape(field, "two dimensions of at least 2 are");
  }
  Grid2d grid{file.numbers(field), field.shape[0], field.shape[1]};
  check_no_densities_below_zero(file, name, grid.values);
  return grid;
}

Warp RglTensors::read_warp(const TensorFile& file) const {
  const Tensor& field = file.field("vndf");
  if (field.shape.size() != 4 || field.shape[0] != phi_i_.size() ||
      field.shape[1] != theta_i_.size() || field.shape[2] < 2 || field.shape[3] < 2) {
    file.refuse_shape(field, "phi_i x theta_i x rows x columns, at least 2 of these, are");
  }
  const std::vector<float> densities = file.numbers(field);
  check_no_densities_below_zero(file, "vndf", densities);
  return {field.shape[2], field.shape[3], densities};
}

void RglTensors::read_axes(const TensorFile& file) {
  if (file.field("description").shape.size() != 1) {
    file.refuse_shape(file.field("description"), "one dimension is");
  }
  // A writer that leaves the mark out means scaled values, as most readers take all.
  if (const Tensor* jacobian = file.find("jacobian")) {
    if (jacobian->count() != 1) file.refuse_shape(*jacobian, "one number is");
    scaled_ = file.numbers(*jacobian).front() != 0;
  }
  if (isotropic()) return;
  const double range = double{phi_i_.back()} - double{phi_i_.front()};
  symmetry_ = static_cast<int>(std::lrint(std::min(2 * kPi / range, 1e3)));
  if (symmetry_ != 1 && symmetry_ != 2 && symmetry_ != 4) {
    throw InputError(file.name() + ": field 'phi_i' covers " + number_text(range) +
                     " radians; a whole, half or quarter circle is allowed");
  }
}

void RglTensors::read_values(const TensorFile& file) {
  const bool spectral = file.find("wavelengths") != nullptr;
  if (spectral) wavelengths_nm_ = read_axis(file, "wavelengths", {1, 1e6, "nm"});
  const std::string name = spectral ? "spectra" : "rgb";
  channels_ = spectral ? wavelengths_nm_.size() : 3;
  const Tensor& luminance = file.field("luminance");
  if (luminance.shape.size() != 4 || luminance.shape[0] != phi_i_.size() ||
      luminance.shape[1] != theta_i_.size() || luminance.shape[2] < 2 ||
      luminance.shape[3] != luminance.shape[2]) {
    file.refuse_shape(luminance, "phi_i x theta_i x N x N, N at least 2, is");
  }
  rows_ = luminance.shape[2];
  columns_ = luminance.shape[3];
  const Tensor& field = file.field(name);
  if (field.shape !=
      std::vector<std::uint64_t>{phi_i_.size(), theta_i_.size(), channels_, rows_, columns_}) {
    file.refuse_shape(field, "phi_i x theta_i x " + std::to_string(channels_) +
                                 " channels x luminance's N x N is");
  }
  values_ = file.numbers(field);
  node_count_ = values_.size() / channels_;
}

std::string RglTensors::rule() const {
  return "linear between nodes of the warped square, as renderers read RGL files";
}

Directions RglTensors::folded(const Directions& directions) const {
  if (symmetry_ == 1) return directions;
  // To negative y and, of a quarter, negative x: by mirrors; of a half by turning.
  Directions result = directions;
  const auto flip = [&](std::size_t axis) {
    result.wi[axis] = -result.wi[axis];
    result.wo[axis] = -result.wo[axis];
  };
  const bool upper = !std::signbit(directions.wo[1]);
  if (upper) flip(1);
  if (symmetry_ == 2 ? upper : !std::signbit(directions.wo[0])) flip(0);
  return result;
}

RglPoint RglTensors::half_vector_point(const Directions& directions) const {
  Vector3<double> m{};
  for (std::size_t a = 0; a < 3; ++a) m[a] = directions.wi[a] + directions.wo[a];
  const double turn = isotropic() ? azimuth(directions.wo) : 0;
  return {theta_to_square(elevation(m)), phi_to_square(azimuth(m) - turn)};
}

double RglTensors::scale(RglPoint u_m, const Directions& directions) const {
  const double light_cosine = directions.wi[2];
  if (!scaled_) return 1 / light_cosine;
  const RglPoint u_i = {theta_to_square(elevation(directions.wo)),
                        (azimuth(directions.wo) + kPi) / (2 * kPi)};
  return bilinear(ndf_.values, ndf_.rows, ndf_.columns, u_m) /
         (4 * bilinear(sigma_.values, sigma_.rows, sigma_.columns, u_i) * light_cosine);
}

bool RglTensors::interpolate(const Directions& directions, std::span<double> values) const {
  const Directions d = folded(directions);
  const RglPoint u_m = half_vector_point(d);
  const SliceBlend blend = blend_slices(phi_i_, theta_i_, azimuth(d.wo), elevation(d.wo));
  const RglPoint u = warp_.invert(u_m, blend);
  const double factor = scale(u_m, d);
  const std::size_t slice = rows_ * columns_;
  std::fill(values.begin(), values.end(), 0.0);
  for (const SliceBlend::Share& share : blend.span()) {
    for (std::size_t c = 0; c < channels_; ++c) {
      const auto of_channel =
          std::span(values_).subspan((share.slice * channels_ + c) * slice, slice);
      values[c] += share.weight * factor * bilinear(of_channel, rows_, columns_, u);
    }
  }
  return true;
}

Directions RglTensors::node(std::size_t index) const {
  const std::size_t slice = index / (rows_ * columns_);
  const std::size_t row = index / columns_ % rows_;
  const std::size_t column = index % columns_;
  const double phi = double{phi_i_[slice / theta_i_.size()]};
  const double theta = double{theta_i_[slice % theta_i_.size()]};
  const RglPoint u = {static_cast<double>(column) / static_cast<double>(columns_ - 1),
                      static_cast<double>(row) / static_cast<double>(rows_ - 1)};
  const RglPoint u_m = warp_.sample(u, only_slice(slice));
  const Vector3<double> wo = direction_at(theta, phi);
  const Vector3<double> m =
      direction_at(square_theta(u_m.x), square_phi(u_m.y) + (isotropic() ? phi : 0));
  const double cosine = dot(wo, m);
  return {{2 * cosine * m[0] - wo[0], 2 * cosine * m[1] - wo[1], 2 * cosine * m[2] - wo[2]}, wo};
}

void RglTensors::node_values(std::size_t index, const Directions& node,
                             std::span<double> values) const {
  const std::size_t cells = rows_ * columns_;
  const double factor = scale(half_vector_point(node), node);
  for (std::size_t c = 0; c < channels_; ++c) {
    const std::size_t at = (index / cells * channels_ + c) * cells + index % cells;
    values[c] = factor * double{values_[at]};
  }
}

}  // namespace clothbrdf
