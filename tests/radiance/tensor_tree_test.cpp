#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "formats/tensor_tree_xml.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/function_producer.h"
#include "tests/support/make_table.h"
#include "tests/support/window_xml_text.h"

namespace clothbrdf::test {
namespace {

using Point = std::array<double, 4>;

// A reader that shares nothing with the writer: the tree as Radiance's description has it.
struct Tree {
  std::vector<Tree> children;  // axis k in the upper half where bit k is set
  std::vector<double> values;  // 2^levels along each axis, axis 0 slowest
  int levels = 0;

  double at(Point p, double* width = nullptr) const {
    if (width != nullptr) *width /= children.empty() ? std::pow(2.0, levels) : 2;
    if (!children.empty()) {
      std::size_t n = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        p[k] *= 2;
        if (p[k] >= 1) {
          n += std::size_t{1} << k;
          p[k] -= 1;
        }
      }
      return children[n].at(p, width);
    }
    std::size_t index = 0;
    const double size = std::pow(2.0, levels);
    for (const double x : p)
      index = index * static_cast<std::size_t>(size) + static_cast<std::size_t>(x * size);
    return values[index];
  }
};

Tree parse_tree(const std::string& text, std::size_t& at) {
  const auto skip = [&] { at = text.find_first_not_of(" \n", at); };
  skip();
  REQUIRE(text[at] == '{');
  ++at;
  skip();
  Tree tree;
  if (text[at] == '{') {
    for (int n = 0; n < 16; ++n) tree.children.push_back(parse_tree(text, at));
    skip();
  } else {
    const std::size_t end = text.find('}', at);
    tree.values = listed_numbers(text.substr(at, end - at));
    while (std::pow(16, tree.levels) < static_cast<double>(tree.values.size())) ++tree.levels;
    REQUIRE(std::pow(16, tree.levels) == static_cast<double>(tree.values.size()));
    at = end;
  }
  REQUIRE(text[at] == '}');
  ++at;
  return tree;
}

Tree whole_tree(const std::string& file, const std::string& spectrum) {
  const std::string text = scattering_text(file, spectrum);
  std::size_t at = 0;
  Tree tree = parse_tree(text, at);
  CHECK(text.find_first_not_of(" \n", at) == std::string::npos);
  return tree;
}

// Shirley and Chiu 1997, by their four regions.
std::array<double, 2> disk(double u, double v) {
  constexpr double kQuarter = std::numbers::pi / 4;
  const double a = 2 * u - 1;
  const double b = 2 * v - 1;
  double r = 0;
  double phi = 0;
  if (a > -b) {
    if (a > b) {
      r = a;
      phi = kQuarter * (b / a);
    } else {
      r = b;
      phi = kQuarter * (2 - a / b);
    }
  } else if (a < b) {
    r = -a;
    phi = kQuarter * (4 + b / a);
  } else {
    r = -b;
    phi = b != 0 ? kQuarter * (6 - a / b) : 0;
  }
  return {r * std::cos(phi), r * std::sin(phi)};
}

Directions directions_at(const Point& p) {
  const std::array<double, 2> i = disk(p[0], p[1]);
  const std::array<double, 2> o = disk(p[2], p[3]);
  return {{-i[0], -i[1], std::sqrt(1 - i[0] * i[0] - i[1] * i[1])},
          {o[0], o[1], std::sqrt(1 - o[0] * o[0] - o[1] * o[1])}};
}

std::array<double, 3> dense_mean(const Producer& producer, const Point& low, double width,
                                 int steps) {
  std::vector<Directions> pairs;
  for (int k = 0; k < steps * steps * steps * steps; ++k) {
    Point p = low;
    int rest = k;
    for (double& at : p) {
      at += width * (rest % steps + 0.5) / steps;
      rest /= steps;
    }
    pairs.push_back(directions_at(p));
  }
  std::vector<double> values(3 * pairs.size());
  producer.fill_pairs(pairs, values);
  std::array<double, 3> mean{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    mean[k % 3] += values[k] / static_cast<double>(pairs.size());
  }
  return mean;
}

double luminance(const std::array<double, 3>& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

}  // namespace

TEST_CASE("a tensor tree holds the means of its boxes, where its readers look") {
  const TemporaryFolder folder;
  Material material = read_material(preset("tamamushi"));
  material.rotation_deg = 25;
  const auto producer = pair_producer(material);
  write_table(*producer, folder / "t.tree.xml", {.bytes = 4000000});
  const std::string file = read_file(folder / "t.tree.xml");
  CHECK(file.size() <= 4000000);
  CHECK(file.size() > 3600000);
  CHECK(between(file, "<IncidentDataStructure>", "</IncidentDataStructure>") == "TensorTree4");
  CHECK(between(file, "<AngleBasis>", "</AngleBasis>") == "LBNL/Shirley-Chiu");
  const Tree y = whole_tree(file, "Visible");
  const Tree u = whole_tree(file, "CIE-u");
  const Tree v = whole_tree(file, "CIE-v");
  const unsigned seed = 20261123;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(0, 1);
  double worst = 0;
  double worst_colour = 0;
  double worst_at_horizon = 0;
  std::array<int, 8> of_depth{};
  for (int k = 0; k < 200; ++k) {
    const Point p = {anywhere(random), anywhere(random), anywhere(random), anywhere(random)};
    double width = 1;
    const double found = y.at(p, &width);
    Point low = p;
    for (double& at : low) at = std::floor(at / width) * width;
    const std::array<double, 3> exact = dense_mean(*producer, low, width, 14);
    const double error = std::abs(found / luminance(exact) - 1);
    const auto high = [](double a, double b) {
      return std::max(std::abs(2 * a - 1), std::abs(2 * b - 1)) >
             std::sin(75 * std::numbers::pi / 180);
    };
    double& of_kind = high(p[0], p[1]) && high(p[2], p[3]) ? worst_at_horizon : worst;
    of_kind = std::max(of_kind, error);
    const double x = (0.4124 * exact[0] + 0.3576 * exact[1] + 0.1805 * exact[2]) / 0.9505;
    const double z = (0.0193 * exact[0] + 0.1192 * exact[1] + 0.9505 * exact[2]) / 1.0890;
    const double sum = x + 15 * luminance(exact) + 3 * z;
    worst_colour = std::max({worst_colour, std::abs(u.at(p) - 4 * x / sum),
                             std::abs(v.at(p) - 9 * luminance(exact) / sum)});
    ++of_depth[static_cast<std::size_t>(std::lround(-std::log2(width)))];
  }
  WARN("worst relative error of a mean " << worst << ", with light and eye beyond 75 degrees "
                                         << worst_at_horizon << ", of u' and v' " << worst_colour);
  CHECK(worst <= 0.003);
  // Where light and eye meet at the horizon, f_r has a pole that four points do not follow.
  CHECK(worst_at_horizon <= 0.03);
  CHECK(worst_colour <= 5e-4);
  for (std::size_t depth = 2; depth < 6; ++depth) {
    INFO("depth " << depth);
    CHECK(of_depth[depth] > 5);
  }
}

TEST_CASE("a tensor tree reads back: nodes, values and lookups") {
  const TemporaryFolder folder;
  Material material = read_material(preset("silk"));
  material.rotation_deg = 40;
  const auto producer = pair_producer(material);
  write_table(*producer, folder / "t.tree.xml", {.bytes = 1000000});
  const std::string file = read_file(folder / "t.tree.xml");
  const Tree y = whole_tree(file, "Visible");
  const Table table = format_for("t.tree.xml").read(folder / "t.tree.xml");
  CHECK(table.spec().channels == rgb_channels());
  CHECK(!table.spec().isotropic());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(0, 1);
  double worst = 0;
  for (int k = 0; k < 5000; ++k) {
    const Point p = {anywhere(random), anywhere(random), anywhere(random), anywhere(random)};
    std::array<double, 3> rgb{};
    REQUIRE(table.interpolate(directions_at(p), rgb));
    worst = std::max(worst, std::abs(luminance(rgb) / y.at(p) - 1));
  }
  WARN("worst relative difference of Y " << worst << ", of which 1e-4 are the matrix's digits");
  CHECK(worst <= 2e-4);
  worst = 0;
  for (std::size_t cell = 0; cell < table.spec().cell_count(); ++cell) {
    std::array<double, 3> rgb{};
    REQUIRE(table.interpolate(table.spec().directions(cell), rgb));
    for (std::size_t c = 0; c < 3; ++c) REQUIRE(rgb[c] == table.value(cell, c));
  }
  // The same file may be read under Klems' ending.
  write_file(folder / "t.xml", file);
  CHECK(format_for("t.xml").read(folder / "t.xml").values().size() == table.values().size());
}

TEST_CASE("writing a tensor tree takes its time, its size and the same bytes for any threads") {
  const TemporaryFolder folder;
  const auto producer = pair_producer(read_material(preset("cotton")));
  const auto start = std::chrono::steady_clock::now();
  write_table(*producer, folder / "one.tree.xml", {.bytes = 500000});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  WARN("0.5 MB took " << seconds.count() << " s on one thread");
  write_table(*producer, folder / "two.tree.xml", {.bytes = 500000, .workers = 2});
  CHECK(read_file(folder / "one.tree.xml") == read_file(folder / "two.tree.xml"));
  write_table(*producer, folder / "small.tree.xml", {.bytes = kLeastTreeBytes});
  CHECK(read_file(folder / "small.tree.xml").size() <= kLeastTreeBytes);
  CHECK_THROWS_WITH(write_table(*producer, folder / "x.tree.xml", {.bytes = kLeastTreeBytes - 1}),
                    ContainsSubstring("--size 4095") && ContainsSubstring("from 4096"));
}

TEST_CASE("a constant f_r is one box, black too") {
  const TemporaryFolder folder;
  for (const double value : {0.25, 0.0}) {
    const FunctionProducer producer([&](const Directions&) {
      return std::array<double, 3>{value, value, value};
    });
    write_table(producer, folder / "c.tree.xml");
    const std::string file = read_file(folder / "c.tree.xml");
    CHECK(listed_numbers(between(scattering_text(file, "Visible"), "{", "}")).size() == 1);
    const Table table = format_for("c.tree.xml").read(folder / "c.tree.xml");
    REQUIRE(table.spec().cell_count() == 1);
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(std::abs(table.value(0, c) - value) <= 1e-6 * value);
    }
  }
}

TEST_CASE("an isotropic tree of three axes is read") {
  const TemporaryFolder folder;
  // Cut once; the upper half of the first axis is unused. Children 0, 2, 4, 6: eye in y, x.
  const std::string basis = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>";
  write_file(folder / "i.xml",
             window_file("TensorTree3", basis, "{{1}{9}{2}{9}{3}{9}{4 4 4 4 4 4 4 4}{9}}"));
  const Table table = format_for("i.xml").read(folder / "i.xml");
  CHECK(table.spec().isotropic());
  CHECK(table.spec().cell_count() == 3 + 8);
  const auto at = [&](double phi_i, double phi_o) {
    double value = 0;
    CHECK(
        table.interpolate({direction(50.0, phi_i), direction(40.0, phi_o)}, std::span(&value, 1)));
    return value;
  };
  // Light from 180 travels towards 0: the tree's own frame.
  CHECK(at(180, 225) == 1);
  CHECK(at(180, 315) == 2);
  CHECK(at(180, 135) == 3);
  CHECK(at(180, 45) == 4);
  CHECK(at(270, 225 + 90) == 1);
  CHECK(at(20, 45 - 160) == 4);
}

}  // namespace clothbrdf::test
