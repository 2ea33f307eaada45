#include <algorithm>
#include <cmath>
#include <iostream>

#include "formats/warp.h"
#include "tests/catch.h"
#include "tests/formats/strict_rgl.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

struct Sampling {
  double lost = 0;            // samples below the horizon
  double albedo = 0;          // by samples
  double integrated = 0;      // by a regular rule
  double largest_weight = 0;  // over the mean
};

// Samples lights as renderers do: luminance, then half vectors; the green channel.
Sampling sample_file(const StrictRgl& file, const Table& table, const Vector3<double>& eye) {
  const std::size_t n = file.field("luminance").shape[2];
  const std::size_t v = file.field("vndf").shape[2];
  const Warp luminance(n, n, file.values("luminance"));
  const Warp half_vectors(v, v, file.values("vndf"));
  const SliceBlend blend = blend_slices(file.values("phi_i"), file.values("theta_i"),
                                        std::atan2(eye[1], eye[0]), std::acos(eye[2]));
  constexpr int kSide = 200;
  constexpr double kCount = double{kSide} * kSide;
  Sampling result;
  std::vector<double> f(3);
  for (int k = 0; k < kSide * kSide; ++k) {
    const double a = (k % kSide + 0.5) / kSide;
    const int row = k / kSide;
    const double b = (row + 0.5) / kSide;
    const RglPoint u = luminance.sample({a, b}, blend);
    const RglPoint u_m = half_vectors.sample(u, blend);
    const double theta = square_theta(u_m.x);
    const Vector3<double> m = direction_at(theta, square_phi(u_m.y));
    const double cosine = eye[0] * m[0] + eye[1] * m[1] + eye[2] * m[2];
    const Vector3<double> light = {2 * cosine * m[0] - eye[0], 2 * cosine * m[1] - eye[1],
                                   2 * cosine * m[2] - eye[2]};
    if (light[2] <= 0) {
      result.lost += 1 / kCount;
    } else {
      const double solid_angle =
          std::max(1e-6, 2 * kPi * kPi * u_m.x * std::sin(theta)) * 4 * cosine;
      const double pdf =
          half_vectors.density(u_m, blend) * luminance.density(u, blend) / solid_angle;
      table.interpolate({light, eye}, f);
      const double weight = f[1] * light[2] / pdf;
      result.albedo += weight / kCount;
      result.largest_weight = std::max(result.largest_weight, weight);
    }
    // Equal parts of the solid angle: f_r peaks at the horizon, where projected ones are coarse.
    const double sine = std::sqrt(1 - b * b);
    table.interpolate({{sine * std::cos(2 * kPi * a), sine * std::sin(2 * kPi * a), b}, eye}, f);
    result.integrated += f[1] * b * 2 * kPi / kCount;
  }
  result.largest_weight /= result.albedo;
  return result;
}

}  // namespace

TEST_CASE("lights sampled from an RGL file tell its albedo, and few are lost") {
  const TemporaryFolder folder;
  Sampling worst;
  for (const char* name : {"silk", "tamamushi"}) {
    const auto exact = make_producer(material_spec(read_material(preset(name)), {}, AnyPairs{}), 2);
    write_table(*exact, folder / "t.bsdf", {.bytes = 5000000, .workers = 2});
    const Table table = format_for("t.bsdf").read(folder / "t.bsdf");
    const StrictRgl file(read_file(folder / "t.bsdf"));
    for (const double theta : {0.0, 30.0, 60.0, 70.0, 75.0, 79.0}) {
      for (const double phi : {20.0, 90.0, 200.0}) {
        const Sampling s = sample_file(file, table, direction(theta, phi));
        INFO(name << ", theta " << theta << " phi " << phi << ": lost " << s.lost << ", albedo "
                  << s.albedo << " by samples, " << s.integrated << " integrated");
        CHECK(s.lost <= 0.01);
        CHECK(std::abs(s.albedo / s.integrated - 1) <= 0.005);
        CHECK(s.largest_weight <= 8);
        worst.lost = std::max(worst.lost, s.lost);
        worst.albedo = std::max(worst.albedo, std::abs(s.albedo / s.integrated - 1));
        worst.largest_weight = std::max(worst.largest_weight, s.largest_weight);
      }
    }
  }
  std::cout << "lights sampled from RGL files of 5 MB: lost at most " << 100 * worst.lost
            << " %, albedo to " << 100 * worst.albedo << " %, largest weight "
            << worst.largest_weight << " times the mean\n";
}

}  // namespace clothbrdf::test
