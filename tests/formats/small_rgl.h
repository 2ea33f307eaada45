#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/formats/tensor_bytes.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {

using Fields = std::vector<TensorBytes>;
using Shape = std::vector<std::uint64_t>;

/// A small file of random content: phi_i from -pi on.
inline Fields small_fields(RandomInputs& random, std::size_t phi, double phi_range) {
  std::vector<float> phi_i(phi);
  for (std::size_t k = 0; k < phi; ++k) {
    phi_i[k] =
        static_cast<float>(-std::acos(-1.0) + phi_range * static_cast<double>(k) /
                                                  std::max(1.0, static_cast<double>(phi - 1)));
  }
  const auto randoms = [&](const std::string& name, Shape shape) {
    std::size_t count = 1;
    for (const std::uint64_t size : shape) count *= size;
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random.uniform(0.5, 2));
    return tensor_of(name, 10, std::move(shape), values);
  };
  const std::string text = "random";
  return {tensor_of("description", 1, {text.size()}, std::vector<char>(text.begin(), text.end())),
          tensor_of("phi_i", 10, {phi}, phi_i),
          tensor_of("theta_i", 10, {2}, std::vector<float>{0, 1.5F}),
          randoms("ndf", {2, 3}),
          randoms("sigma", {2, 2}),
          randoms("vndf", {phi, 2, 2, 3}),
          randoms("luminance", {phi, 2, 2, 2}),
          randoms("rgb", {phi, 2, 3, 2, 2}),
          tensor_of("jacobian", 1, {1}, std::vector<char>{1})};
}

inline TensorBytes& field_of(Fields& fields, const std::string& name) {
  return *std::find_if(fields.begin(), fields.end(),
                       [&](const TensorBytes& f) { return f.name == name; });
}

inline Table read_bytes(const TemporaryFolder& folder, const std::string& bytes) {
  write_file(folder / "t.bsdf", bytes);
  return format_for("t.bsdf").read(folder / "t.bsdf");
}

}  // namespace clothbrdf::test
