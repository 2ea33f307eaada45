#include "table/grid.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr const char* kSizes = "sizes are whole numbers from 1 to 1000000, joined by 'x'";

constexpr double kDegree = std::numbers::pi / 180;

struct Kind {
  GridKind kind;
  const char* name;
  std::vector<const char*> axes;
};

const std::array<Kind, 3>& kinds() {
  static const std::array<Kind, 3> kAll = {{
      {GridKind::kHalfDifference3d, "halfdiff3d", {"theta_h", "theta_d", "phi_d"}},
      {GridKind::kHalfDifference4d, "halfdiff4d", {"theta_h", "phi_h", "theta_d", "phi_d"}},
      {GridKind::kInOut, "inout", {"theta_i", "phi_i", "theta_o", "phi_o"}},
  }};
  return kAll;
}

const Kind& kind_of(GridKind kind) {
  return *std::find_if(kinds().begin(), kinds().end(),
                       [&](const Kind& k) { return k.kind == kind; });
}

Vector3<double> rotate_y(const Vector3<double>& v, const SinCos<double>& turn) {
  return {v[0] * turn.cos + v[2] * turn.sin, v[1], v[2] * turn.cos - v[0] * turn.sin};
}

double elevation_deg(const Vector3<double>& v) {
  return std::atan2(std::hypot(v[0], v[1]), v[2]) / kDegree;
}
double azimuth_deg(const Vector3<double>& v) {
  const double phi = std::atan2(v[1], v[0]) / kDegree;
  return phi < 0 ? phi + 360 : phi;
}

bool is_halfdiff(GridKind kind) { return kind != GridKind::kInOut; }

Grid halfdiff(GridKind kind, const std::vector<int>& sizes, double phi_d_range_deg) {
  Grid grid{kind, {{"theta_h", Spacing::kSquared, sizes.front(), 0, 90, false}}};
  if (kind == GridKind::kHalfDifference4d) {
    grid.axes.push_back({"phi_h", Spacing::kUniform, sizes[1], 0, 180, true});
  }
  grid.axes.push_back({"theta_d", Spacing::kUniform, sizes[sizes.size() - 2], 0, 90, false});
  grid.axes.push_back({"phi_d", Spacing::kUniform, sizes.back(), 0, phi_d_range_deg, true});
  return grid;
}

// Where along an axis a cell is asked for the sky: at its node, or where it sees most of it. That
// is at the lowest theta, and at the phi_d nearest to a right angle.
SinCos<double> sight(const Grid& grid, std::size_t axis, int k, CellPart part) {
  const Axis& a = grid.axes[axis];
  if (part == CellPart::kNode) return sincosd(a.node_deg(k));
  if (grid.kind == GridKind::kInOut || axis + 1 < grid.axes.size()) return sincosd(a.edge_deg(k));
  SinCos<double> best{0, 1};
  for (const double right_angle : {90.0, 270.0}) {
    const SinCos<double> phi = sincosd(std::clamp(right_angle, a.edge_deg(k), a.edge_deg(k + 1)));
    if (std::abs(phi.cos) < best.cos) best = {phi.sin, std::abs(phi.cos)};
  }
  return best;
}

// By the sights along the first axis and the last two.
bool seen(GridKind kind, const SinCos<double>& first, const SinCos<double>& second,
          const SinCos<double>& last) {
  if (kind == GridKind::kInOut) return first.cos > 0 && second.cos > 0;
  const IncidenceCosines<double> c = incidence_cosines(first, second, last.cos);
  return c.i > 0 && c.o > 0;
}

bool cell_above_horizon(const Grid& grid, std::size_t cell, CellPart part) {
  const std::array<int, 4> index = grid.indices(cell);
  const auto at = [&](std::size_t axis) { return sight(grid, axis, index[axis], part); };
  const std::size_t last = grid.axes.size() - 1;
  return seen(grid.kind, at(0), at(last - 1), at(last));
}

}  // namespace

Directions from_half_difference(const SinCos<double>& theta_h, const SinCos<double>& phi_h,
                                const Vector3<double>& wd) {
  const auto to_cloth = [&](const Vector3<double>& v) {
    return turned(rotate_y(v, theta_h), phi_h);
  };
  return {to_cloth(wd), to_cloth({-wd[0], -wd[1], wd[2]})};
}

std::size_t Grid::cell_count() const {
  return std::accumulate(
      axes.begin(), axes.end(), std::size_t{1},
      [](std::size_t n, const Axis& a) { return n * static_cast<std::size_t>(a.size); });
}

std::size_t Grid::column_count() const {
  return static_cast<std::size_t>(axes[axes.size() - 2].size) *
         static_cast<std::size_t>(axes.back().size);
}

std::array<int, 4> Grid::indices(std::size_t cell) const {
  std::array<int, 4> index{};
  for (std::size_t a = axes.size(); a-- > 0;) {
    const auto size = static_cast<std::size_t>(axes[a].size);
    index[a] = static_cast<int>(cell % size);
    cell /= size;
  }
  return index;
}

Directions Grid::directions(std::size_t cell) const {
  const std::array<int, 4> index = indices(cell);
  std::array<double, 4> angle{};
  for (std::size_t a = 0; a < axes.size(); ++a) angle[a] = axes[a].node_deg(index[a]);
  if (kind == GridKind::kInOut)
    return {direction(angle[0], angle[1]), direction(angle[2], angle[3])};
  const bool anisotropic = kind == GridKind::kHalfDifference4d;
  const SinCos<double> theta_h = sincosd(angle[0]);
  const SinCos<double> phi_h = sincosd(anisotropic ? angle[1] : 0.0);
  const Vector3<double> wd = direction(angle[anisotropic ? 2 : 1], angle[anisotropic ? 3 : 2]);
  return from_half_difference(theta_h, phi_h, wd);
}

bool Grid::node_above_horizon(std::size_t cell) const {
  return cell_above_horizon(*this, cell, CellPart::kNode);
}

bool Grid::any_above_horizon(std::size_t cell) const {
  return cell_above_horizon(*this, cell, CellPart::kAny);
}

std::vector<std::uint8_t> Grid::above_horizon(CellPart part) const {
  const auto sights = [&](std::size_t axis) {
    std::vector<SinCos<double>> result;
    result.reserve(static_cast<std::size_t>(axes[axis].size));
    for (int k = 0; k < axes[axis].size; ++k) result.push_back(sight(*this, axis, k, part));
    return result;
  };
  const std::vector<SinCos<double>> first = sights(0);
  const std::vector<SinCos<double>> second = sights(axes.size() - 2);
  const std::vector<SinCos<double>> last = sights(axes.size() - 1);
  const std::size_t rows_of_first = row_count() / first.size();
  std::vector<std::uint8_t> above;
  above.reserve(cell_count());
  for (std::size_t row = 0; row < row_count(); ++row) {
    for (const SinCos<double>& theta : second) {
      for (const SinCos<double>& phi : last) {
        above.push_back(seen(kind, first[row / rows_of_first], theta, phi) ? 1 : 0);
      }
    }
  }
  return above;
}

std::array<double, 4> Grid::angles(const Vector3<double>& wi, const Vector3<double>& wo) const {
  if (kind == GridKind::kInOut) {
    return {elevation_deg(wi), azimuth_deg(wi), elevation_deg(wo), azimuth_deg(wo)};
  }
  const Vector3<double> h = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
  const double theta_h = elevation_deg(h);
  const double phi_h = h[0] == 0 && h[1] == 0 ? 0 : azimuth_deg(h);
  const Vector3<double> wd = rotate_y(turned(wi, sincosd(-phi_h)), sincosd(-theta_h));
  double phi_d = azimuth_deg(wd);
  if (folds_orders() && phi_d >= 180) phi_d -= 180;
  const double theta_d = std::min(elevation_deg(wd), 90.0);
  if (kind == GridKind::kHalfDifference4d) return {theta_h, phi_h, theta_d, phi_d};
  return {theta_h, theta_d, phi_d, 0};
}

std::optional<std::size_t> Grid::cell_of(const Vector3<double>& wi,
                                         const Vector3<double>& wo) const {
  const std::array<double, 4> angle = angles(wi, wo);
  std::size_t cell = 0;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const std::optional<int> index = axes[a].cell_of(angle[a]);
    if (!index) return std::nullopt;
    cell = cell * static_cast<std::size_t>(axes[a].size) + static_cast<std::size_t>(*index);
  }
  return cell;
}

double Grid::measure(std::size_t cell) const {
  const std::array<int, 4> index = indices(cell);
  const auto azimuths = [&](std::size_t axis) {
    return (axes[axis].edge_deg(index[axis] + 1) - axes[axis].edge_deg(index[axis])) * kDegree;
  };
  const auto cap = [&](std::size_t axis, auto&& integral) {
    return integral(sincosd(axes[axis].edge_deg(index[axis] + 1))) -
           integral(sincosd(axes[axis].edge_deg(index[axis])));
  };
  const auto solid_angle = [](const SinCos<double>& theta) { return 1 - theta.cos; };
  const auto halved = [](const SinCos<double>& theta) { return 2 * theta.sin * theta.sin; };
  if (kind == GridKind::kInOut) {
    return cap(0, solid_angle) * azimuths(1) * cap(2, solid_angle) * azimuths(3);
  }
  const std::size_t d = axes.size() - 2;
  const double phi_h = kind == GridKind::kHalfDifference4d ? azimuths(1) : 360 * kDegree;
  return cap(0, solid_angle) * phi_h * cap(d, halved) * azimuths(d + 1);
}

std::string Grid::place(std::size_t cell) const {
  const std::array<int, 4> index = indices(cell);
  std::ostringstream text;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    text << (a == 0 ? "" : " ") << axes[a].name << ' ' << axes[a].node_deg(index[a]);
  }
  return text.str();
}

bool Grid::folds_orders() const {
  const double period = axes.back().period_deg();
  return kind != GridKind::kInOut && period > 0 && period <= 180;
}

bool Grid::regular() const {
  return std::none_of(axes.begin(), axes.end(), [](const Axis& axis) {
    return axis.mirrored || axis.spacing == Spacing::kListed;
  });
}

std::string Grid::sizes() const {
  std::string text = kind_of(kind).name;
  for (std::size_t a = 0; a < axes.size(); ++a)
    text += (a == 0 ? ":" : "x") + std::to_string(axes[a].size);
  return text;
}

std::string Grid::description() const { return regular() ? sizes() : sizes() + " at chosen nodes"; }

Grid halfdiff3d(int theta_h, int theta_d, int phi_d, double phi_d_range_deg) {
  return halfdiff(GridKind::kHalfDifference3d, {theta_h, theta_d, phi_d}, phi_d_range_deg);
}

Grid halfdiff4d(int theta_h, int phi_h, int theta_d, int phi_d, double phi_d_range_deg) {
  return halfdiff(GridKind::kHalfDifference4d, {theta_h, phi_h, theta_d, phi_d}, phi_d_range_deg);
}

Grid inout(int theta_i, int phi_i, int theta_o, int phi_o) {
  return {GridKind::kInOut,
          {{"theta_i", Spacing::kNodes, theta_i, 0, 90, false},
           {"phi_i", Spacing::kNodes, phi_i, 0, 360, true},
           {"theta_o", Spacing::kNodes, theta_o, 0, 90, false},
           {"phi_o", Spacing::kNodes, phi_o, 0, 360, true}}};
}

Grid parse_grid(const std::string& text, double phi_d_range_deg) {
  const auto fail = [&](const std::string& allowed) -> InputError {
    return InputError("--grid: '" + text + "' is not allowed: " + allowed);
  };
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const auto kind =
      std::find_if(kinds().begin(), kinds().end(), [&](const Kind& k) { return name == k.name; });
  if (kind == kinds().end())
    throw fail("halfdiff3d[:THxTDxPD], halfdiff4d[:THxPHxTDxPD] or inout[:TIxPIxTOxPO]");
  std::vector<int> sizes;
  if (colon == std::string::npos) {
    const Grid standard = kind->kind == GridKind::kHalfDifference3d   ? halfdiff3d()
                          : kind->kind == GridKind::kHalfDifference4d ? halfdiff4d()
                                                                      : inout();
    for (const Axis& axis : standard.axes) sizes.push_back(axis.size);
  } else {
    const char* at = text.data() + colon + 1;
    const char* end = text.data() + text.size();
    double cells = 1;
    while (true) {
      int size = 0;
      const auto [next, error] = std::from_chars(at, end, size);
      if (error != std::errc() || size < 1 || size > kMaxAxisSize) throw fail(kSizes);
      sizes.push_back(size);
      cells *= size;
      if (next == end) break;
      if (*next != 'x') throw fail(kSizes);
      at = next + 1;
    }
    if (sizes.size() != kind->axes.size()) {
      throw fail(name + " takes " + std::to_string(kind->axes.size()) + " sizes");
    }
    if (cells > kMaxCells) throw fail("at most 1e15 cells");
  }
  if (is_halfdiff(kind->kind)) return halfdiff(kind->kind, sizes, phi_d_range_deg);
  return inout(sizes[0], sizes[1], sizes[2], sizes[3]);
}

}  // namespace clothbrdf
