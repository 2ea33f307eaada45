#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "model/directions.h"
#include "tests/formats/tensor_bytes.h"

namespace clothbrdf::test {

/// Evaluates an anisotropic file of the whole circle as renderers do, step by step as the format is
/// described: every slice by itself first, sums written out; nothing shared with the library.
class StrictRgl {
 public:
  explicit StrictRgl(const std::string& file) : fields_(strict_fields(file)) {
    for (const auto& [name, field] : fields_) {
      if (field.type == 10) values_[name] = floats_of(field);
    }
    color_ = fields_.contains("spectra") ? "spectra" : "rgb";
  }

  const TensorBytes& field(const std::string& name) const { return fields_.at(name); }
  const std::vector<float>& values(const std::string& name) const { return values_.at(name); }
  std::size_t channels() const { return field(color_).shape[2]; }

  /// f_r at a light and an eye.
  std::vector<double> f(const Vector3<double>& light, const Vector3<double>& eye) const {
    const double pi = std::acos(-1.0);
    double m[3];
    double length = 0;
    for (std::size_t a = 0; a < 3; ++a) length += std::pow(light[a] + eye[a], 2);
    for (std::size_t a = 0; a < 3; ++a) m[a] = (light[a] + eye[a]) / std::sqrt(length);
    const auto u_of = [&](double x, double y, double z, double u[2]) {
      u[0] = std::sqrt(2 * angle_from_normal(x, y, z) / pi);
      u[1] = (std::atan2(y, x) + pi) / (2 * pi);
    };
    double u_m[2];
    double u_i[2];
    u_of(m[0], m[1], m[2], u_m);
    u_m[1] -= std::floor(u_m[1]);
    u_of(eye[0], eye[1], eye[2], u_i);
    const double theta = angle_from_normal(eye[0], eye[1], eye[2]);
    const double phi = std::atan2(eye[1], eye[0]);
    double w_phi;
    double w_theta;
    const std::size_t p = place(values("phi_i"), phi, w_phi);
    const std::size_t t = place(values("theta_i"), theta, w_theta);
    std::vector<double> result(channels(), 0.0);
    double u[2] = {0, 0};
    double row_mass = 0;
    // Cumulative sums are blended between the four slices, and only then divided.
    for (std::size_t k = 0; k < 4; ++k) {
      const double w = (k / 2 ? w_phi : 1 - w_phi) * (k % 2 ? w_theta : 1 - w_theta);
      const std::size_t slice = (p + k / 2) * values("theta_i").size() + t + k % 2;
      add_cumulative(slice, u_m, w, u, row_mass);
    }
    u[0] /= row_mass;
    const std::size_t n = field("luminance").shape[2];
    for (std::size_t k = 0; k < 4; ++k) {
      const double w = (k / 2 ? w_phi : 1 - w_phi) * (k % 2 ? w_theta : 1 - w_theta);
      const std::size_t slice = (p + k / 2) * values("theta_i").size() + t + k % 2;
      for (std::size_t c = 0; c < channels(); ++c) {
        result[c] += w * look_up(values(color_).data() + (slice * channels() + c) * n * n, n, n, u);
      }
    }
    const auto table = [&](const std::string& name, const double at[2]) {
      return look_up(values(name).data(), field(name).shape[0], field(name).shape[1], at);
    };
    for (double& value : result) value *= table("ndf", u_m) / (4 * table("sigma", u_i) * light[2]);
    return result;
  }

 private:
  // From the chord: acos loses half of the digits near the normal.
  static double angle_from_normal(double x, double y, double z) {
    return 2 * std::asin(std::min(1.0, std::sqrt(x * x + y * y + (z - 1) * (z - 1)) / 2));
  }

  static std::size_t place(const std::vector<float>& nodes, double at, double& share) {
    std::size_t k = 0;
    while (k + 2 < nodes.size() && double{nodes[k + 1]} <= at) ++k;
    share = std::clamp((at - double{nodes[k]}) / (double{nodes[k + 1]} - double{nodes[k]}), 0., 1.);
    return k;
  }

  static double look_up(const float* v, std::size_t rows, std::size_t columns, const double u[2]) {
    const double x = std::clamp(u[0], 0., 1.) * static_cast<double>(columns - 1);
    const double y = std::clamp(u[1], 0., 1.) * static_cast<double>(rows - 1);
    const auto c = std::min(static_cast<std::size_t>(x), columns - 2);
    const auto r = std::min(static_cast<std::size_t>(y), rows - 2);
    const double fx = x - static_cast<double>(c);
    const double fy = y - static_cast<double>(r);
    const auto at = [&](std::size_t row, std::size_t column) {
      return double{v[row * columns + column]};
    };
    return (1 - fy) * ((1 - fx) * at(r, c) + fx * at(r, c + 1)) +
           fy * ((1 - fx) * at(r + 1, c) + fx * at(r + 1, c + 1));
  }

  // Integrals of a slice's bilinear density by the trapezoidal rule, exact patch by patch.
  void add_cumulative(std::size_t slice, const double u_m[2], double w, double u[2],
                      double& row_mass) const {
    const std::size_t rows = field("vndf").shape[2];
    const std::size_t columns = field("vndf").shape[3];
    const float* v = values("vndf").data() + slice * rows * columns;
    const auto row_integral = [&](std::size_t row, double to) {  // in columns
      double sum = 0;
      for (std::size_t c = 0; c + 1 < columns; ++c) {
        const double part = std::clamp(to - static_cast<double>(c), 0., 1.);
        const double a = double{v[row * columns + c]};
        const double b = double{v[row * columns + c + 1]};
        sum += part * (a + 0.5 * part * (b - a));
      }
      return sum;
    };
    const double last = static_cast<double>(columns - 1);
    double total = 0;
    double below = 0;
    const double y = u_m[1] * static_cast<double>(rows - 1);
    for (std::size_t r = 0; r + 1 < rows; ++r) {
      const double a = row_integral(r, last);
      const double b = row_integral(r + 1, last);
      const double part = std::clamp(y - static_cast<double>(r), 0., 1.);
      total += 0.5 * (a + b);
      below += part * (a + 0.5 * part * (b - a));
    }
    const auto r = std::min(static_cast<std::size_t>(y), rows - 2);
    const double fy = y - static_cast<double>(r);
    const double x = u_m[0] * last;
    u[0] += w / total * ((1 - fy) * row_integral(r, x) + fy * row_integral(r + 1, x));
    row_mass += w / total * ((1 - fy) * row_integral(r, last) + fy * row_integral(r + 1, last));
    u[1] += w / total * below;
  }

  std::map<std::string, TensorBytes> fields_;
  std::map<std::string, std::vector<float>> values_;
  std::string color_;
};

}  // namespace clothbrdf::test
