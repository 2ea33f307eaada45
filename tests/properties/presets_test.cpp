#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <vector>

#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

// wi: nodes every 5 degrees and every 45 degrees of azimuth.
constexpr int kThetasIn = 18;
constexpr int kAzimuthsIn = 8;
// wo: fine enough for three digits of the narrowest preset's albedo at 85 degrees.
constexpr int kThetasOut = 120;
constexpr int kAzimuthsOut = 360;

// Integral of f cos(theta_o) over the outgoing hemisphere, the largest channel; by the rectangle
// rule on the grid's nodes.
double albedo(const Producer& producer, std::size_t theta_i, std::size_t phi_i) {
  const TableSpec& spec = producer.spec();
  std::vector<double> row(spec.row_values());
  producer.fill_rows(theta_i * kAzimuthsIn + phi_i, row);
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (std::size_t k = 0; k < spec.column_count(); ++k) {
      const SinCos<double> theta_o =
          sincosd(spec.grid().axes[2].node_deg(static_cast<int>(k / kAzimuthsOut)));
      sum += row[c * spec.column_count() + k] * theta_o.cos * theta_o.sin;
    }
    largest = std::fmax(largest, sum * degrees_to_radians(90.0 / kThetasOut) *
                                     degrees_to_radians(360.0 / kAzimuthsOut));
  }
  return largest;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(preset("silk").parent_path())) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("the presets reflect no more than they receive, up to 85 degrees") {
  const std::vector<std::string> names = preset_names();
  CHECK(names.size() >= 10);
  for (const std::string& name : names) {
    const auto producer =
        make_producer(material_spec(read_material(preset(name)), {},
                                    inout(kThetasIn, kAzimuthsIn, kThetasOut, kAzimuthsOut)),
                      2);
    double largest = 0;
    std::cout << name << ": largest directional albedo";
    for (const std::size_t theta_i : {0U, 12U, 17U}) {
      double of_theta = 0;
      for (const std::size_t phi_i : {0U, 1U, 2U}) {
        of_theta = std::fmax(of_theta, albedo(*producer, theta_i, phi_i));
      }
      std::cout << (theta_i == 0 ? " " : ", ") << of_theta << " at " << 5 * theta_i;
      largest = std::fmax(largest, of_theta);
    }
    std::cout << " degrees\n";
    CAPTURE(name);
    CHECK(largest <= 1);
    CHECK(largest > 0.1);
  }
}

}  // namespace clothbrdf::test
