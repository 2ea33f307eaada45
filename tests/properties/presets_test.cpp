#include <cmath>
#include <iostream>
#include <vector>

#include "tests/catch.h"
#include "tests/support/make_table.h"

namespace clothbrdf::test {
namespace {

constexpr int kThetas = 90;     // nodes k degrees
constexpr int kAzimuths = 180;  // nodes 2 k degrees

// Integral of f cos(theta_o) over the outgoing hemisphere, the largest channel; by the rectangle
// rule on the grid's nodes, whose steps are well below the presets' lobes (half-widths of 6 degrees
// and more).
double albedo(const Producer& producer, std::size_t theta_i_deg, std::size_t phi_i) {
  const TableSpec& spec = producer.spec();
  std::vector<double> row(spec.row_values());
  producer.fill_rows(theta_i_deg * kAzimuths + phi_i, row);
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (std::size_t k = 0; k < spec.column_count(); ++k) {
      const SinCos<double> theta_o =
          sincosd(spec.grid().axes[2].node_deg(static_cast<int>(k / kAzimuths)));
      sum += row[c * spec.column_count() + k] * theta_o.cos * theta_o.sin;
    }
    largest =
        std::fmax(largest, sum * degrees_to_radians(1.0) * degrees_to_radians(360.0 / kAzimuths));
  }
  return largest;
}

}  // namespace

TEST_CASE("the presets reflect no more than they receive, up to 85 degrees") {
  for (const char* name :
       {"silk", "cotton", "tamamushi", "silk_paper", "cotton_paper", "tamamushi_paper"}) {
    const auto producer =
        make_producer(material_spec(read_material(preset(name)), {},
                                    inout(kThetas, kAzimuths, kThetas, kAzimuths)),
                      2);
    double largest = 0;
    for (const std::size_t theta_i : {0U, 60U, 85U}) {
      for (const std::size_t phi_i : {0U, 23U, 45U})
        largest = std::fmax(largest, albedo(*producer, theta_i, phi_i));
    }
    std::cout << name << ": largest directional albedo up to 85 degrees " << largest << '\n';
    CHECK(largest <= 1);
    CHECK(largest > 0.1);
  }
}

}  // namespace clothbrdf::test
