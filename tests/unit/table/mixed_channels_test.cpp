#include "table/mixed_channels.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/errors.h"
#include "table/table.h"
#include "tests/catch.h"
#include "tests/support/make_table.h"
#include "tests/support/random_inputs.h"

namespace clothbrdf::test {
namespace {

Material spectral_silk(std::vector<double> wavelengths_nm) {
  Material material = read_material(preset("silk"));
  material.wavelengths_nm = std::move(wavelengths_nm);
  for (Yarn* yarn : {&material.warp, &material.weft}) {
    yarn->absorption.clear();
    for (const double nm : material.wavelengths_nm) yarn->absorption.push_back(300 / nm - 0.3);
  }
  return material;
}

std::vector<Directions> random_pairs(std::size_t count) {
  RandomInputs random(seed_from_environment());
  std::vector<Directions> pairs;
  for (std::size_t k = 0; k < count; ++k) {
    const DirectionPair pair = random.pair();
    pairs.push_back({direction(pair.theta_i, pair.phi_i), direction(pair.theta_o, pair.phi_o)});
  }
  return pairs;
}

std::vector<double> pair_values(const Producer& producer, std::span<const Directions> pairs) {
  std::vector<double> values(pairs.size() * producer.spec().channels.size());
  producer.fill_pairs(pairs, values);
  return values;
}

// One pair; its channels in this order.
Table one_pair(const std::vector<std::string>& names, const std::vector<double>& values) {
  TableSpec spec;
  spec.samples = PairList{{{10, 0, 20, 0}}};
  for (const std::string& name : names) {
    spec.channels.push_back({name, Part::kTotal, spec.channels.size()});
  }
  return {spec, values, {1}};
}

std::vector<double> row_of(const Producer& producer) {
  std::vector<double> values(producer.spec().row_values());
  producer.fill_rows(0, values);
  return values;
}

}  // namespace

TEST_CASE("RGB of a spectral cloth are its channels' weighted sums, in pairs and in rows") {
  const Material material = spectral_silk({420, 500.5, 560, 610, 690});
  const ChannelMatrix weights = rgb_weights(material.wavelengths_nm);
  const std::vector<Directions> pairs = random_pairs(5000);  // more than are mixed at a time
  const auto any = make_producer(material_spec(material, {}, AnyPairs{}), 1);
  const auto rgb = to_rgb(*any);
  const std::vector<double> from = pair_values(*any, pairs);
  const std::vector<double> mixed = pair_values(*rgb, pairs);
  double worst = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 5; ++k) sum += weights[c][k] * from[5 * p + k];
      worst = std::max(worst, std::abs(mixed[3 * p + c] - sum));
    }
  }
  CHECK(worst == 0);

  // Rows with many columns, and with components that are left out: the same as each wavelength's
  // own table.
  const Grid grid = halfdiff4d(6, 4, 5, 9);
  const auto with_parts = make_producer(material_spec(material, {}, grid, {}, true), 1);
  const Table whole = collect(*with_parts, 1);
  const auto of_table = to_rgb(whole);
  const Table table = collect(*to_rgb(*with_parts), 1);
  REQUIRE(table.spec().channels.size() == 3);
  // All rows in one call, more than are mixed at a time.
  std::vector<double> all_rows(table.values().size());
  of_table->fill_rows(0, all_rows);
  CHECK(std::equal(all_rows.begin(), all_rows.end(), table.values().begin()));
  double lit = 0;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 5; ++k) sum += weights[c][k] * whole.value(cell, k);
      worst = std::max(worst, std::abs(table.value(cell, c) - sum));
      lit += sum;
    }
  }
  CHECK(worst == 0);
  CHECK(lit > 1);
}

TEST_CASE("a cloth's RGB come back from its spectrum") {
  const auto source =
      make_producer(material_spec(read_material(preset("tamamushi")), {}, AnyPairs{}), 1);
  const auto spectrum = to_spectrum(*source);
  REQUIRE(spectrum->spec().channels.size() == kSpectrumSize);
  const auto back = to_rgb(*spectrum);
  const std::vector<Directions> pairs = random_pairs(2000);
  const std::vector<double> exact = pair_values(*source, pairs);
  const std::vector<double> values = pair_values(*back, pairs);
  double worst = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const double largest = std::max({exact[3 * p], exact[3 * p + 1], exact[3 * p + 2]});
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(values[3 * p + c] - exact[3 * p + c]) / largest);
    }
  }
  std::cout << "RGB back from a spectrum: off by " << worst << " of the largest channel (seed "
            << seed_from_environment() << ")\n";
  CHECK(worst <= 1e-12);
}

TEST_CASE("a mixed table keeps all of its source's description but the channels") {
  const TableSpec spec = material_spec(spectral_silk({450, 550, 650}), {.internal = false},
                                       halfdiff3d(4, 4, 4), {true, 0.01}, true);
  const auto source = make_producer(spec, 1);
  TableSpec expected = spec;
  expected.channels = {{"R", Part::kTotal, kNoColour},
                       {"G", Part::kTotal, kNoColour},
                       {"B", Part::kTotal, kNoColour}};
  const auto rgb = to_rgb(*source);
  CHECK(rgb->spec() == expected);
  CHECK(to_spectrum(*rgb)->spec().channels[1] == Channel{"405nm", Part::kTotal, kNoColour});
  // No absorption value of the material is one of the mixed channels.
  CHECK_THROWS_AS(check_producible(rgb->spec()), InputError);
}

TEST_CASE("channels are found by name, whatever their order") {
  const Table mixed_up = one_pair({"650nm", "450_5nm", "550nm"}, {0.7, 0.2, 0.4});
  const Table in_order = one_pair({"450_5nm", "550nm", "650nm"}, {0.2, 0.4, 0.7});
  CHECK(row_of(*to_rgb(mixed_up)) == row_of(*to_rgb(in_order)));
  const Table bgr = one_pair({"B", "G", "R"}, {0.2, 0.4, 0.7});
  const Table rgb = one_pair({"R", "G", "B"}, {0.7, 0.4, 0.2});
  CHECK(row_of(*to_spectrum(bgr)) == row_of(*to_spectrum(rgb)));
}

TEST_CASE("other channels are told apart, and not mixed") {
  const auto spec = [](const std::vector<std::string>& names) {
    return one_pair(names, std::vector<double>(names.size(), 1)).spec();
  };
  CHECK(has_rgb(spec({"G", "B", "R"})));
  CHECK_FALSE(has_rgb(spec({"R", "G"})));
  CHECK_FALSE(has_rgb(spec({"R", "G", "B", "550nm"})));
  CHECK(has_wavelengths(spec({"550nm"})));
  CHECK(has_wavelengths(spec({"550nm", "400_5nm"})));
  CHECK_FALSE(has_wavelengths(spec({"550nm", "R"})));
  CHECK_FALSE(has_wavelengths(spec({"550nm", "550_0nm"})));
  CHECK_FALSE(has_wavelengths(spec({"infnm"})));
  CHECK_FALSE(has_wavelengths(spec({})));
  const Table rgb = one_pair({"R", "G", "B"}, {1, 1, 1});
  const Table spectral = one_pair({"450nm", "550nm"}, {1, 1});
  CHECK_THROWS_AS(to_rgb(rgb), std::invalid_argument);
  CHECK_THROWS_AS(to_spectrum(spectral), std::invalid_argument);
  CHECK_THROWS_AS(MixedChannels(rgb, {"Y"}, {0, 1, 2}, {{1, 2}}), std::invalid_argument);
  CHECK_THROWS_AS(MixedChannels(rgb, {"Y"}, {0, 1, 3}, {{1, 2, 3}}), std::invalid_argument);
  CHECK_THROWS_AS(MixedChannels(rgb, {"Y", "X"}, {0}, {{1}}), std::invalid_argument);
}

TEST_CASE("marks of cells not measured survive, colours outside Rec. 709 end at 0") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto rgb = [](double blue, double green, double red) {
    return row_of(*to_rgb(one_pair({"450nm", "550nm", "650nm"}, {blue, green, red})));
  };
  const std::vector<double> unmeasured(3, kNotMeasured);
  CHECK(rgb(-1, -1, -1) == unmeasured);
  CHECK(rgb(0.5, -1, 0.5) == unmeasured);
  CHECK(std::isnan(rgb(0.5, nan, 0.5)[1]));
  // Light from 580 nm on is redder than any red of Rec. 709: its blue would be -0.03.
  const std::vector<double> red =
      row_of(*to_rgb(one_pair({"500nm", "575nm", "580nm", "650nm"}, {0, 0, 1, 1})));
  CHECK(rgb_weights(std::vector<double>{500, 575, 580, 650})[2][2] < 0);
  CHECK(red[0] > 1);
  CHECK(red[2] == 0);
  CHECK(rgb(0, 0, 0) == std::vector<double>(3, 0));
}

}  // namespace clothbrdf::test
