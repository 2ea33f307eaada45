#include "table/nearest_sample.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <iterator>
#include <utility>

#include "model/degrees.h"

namespace clothbrdf {
namespace {

namespace bg = boost::geometry;

// Light and eye as one point: close points are close pairs.
using Point = bg::model::point<double, 6, bg::cs::cartesian>;
using Entry = std::pair<Point, std::size_t>;

// What tells an isotropic cloth's pairs apart: the light has no azimuth, the eye is on one side.
Directions without_rotation(const Directions& d) {
  const double sin_i = std::hypot(d.wi[0], d.wi[1]);
  const double sin_o = std::hypot(d.wo[0], d.wo[1]);
  if (!(sin_i > 0)) return {d.wi, {sin_o, 0, d.wo[2]}};
  const double along = (d.wi[0] * d.wo[0] + d.wi[1] * d.wo[1]) / sin_i;
  const double across = std::abs(d.wi[0] * d.wo[1] - d.wi[1] * d.wo[0]) / sin_i;
  return {{sin_i, 0, d.wi[2]}, {along, across, d.wo[2]}};
}

Point point_at(const Directions& d, bool isotropic) {
  const Directions turned = isotropic ? without_rotation(d) : d;
  Point point;
  bg::set<0>(point, turned.wi[0]);
  bg::set<1>(point, turned.wi[1]);
  bg::set<2>(point, turned.wi[2]);
  bg::set<3>(point, turned.wo[0]);
  bg::set<4>(point, turned.wo[1]);
  bg::set<5>(point, turned.wo[2]);
  return point;
}

}  // namespace

struct NearestSample::Index {
  bool isotropic;
  std::vector<double> values;
  bg::index::rtree<Entry, bg::index::rstar<16>> tree;
};

NearestSample::NearestSample(const TableSpec& spec, std::span<const double> values,
                             std::span<const std::uint8_t> valid) {
  std::vector<Entry> entries;
  for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
    const std::span<const double> of_cell =
        values.subspan(cell * spec.channels.size(), spec.channels.size());
    const bool finite =
        std::all_of(of_cell.begin(), of_cell.end(), [](double v) { return std::isfinite(v); });
    if (valid[cell] == 0 || !finite) continue;
    entries.emplace_back(point_at(spec.directions(cell), spec.isotropic()), cell);
  }
  index_ = std::make_unique<const Index>(
      Index{spec.isotropic(),
            {values.begin(), values.end()},
            bg::index::rtree<Entry, bg::index::rstar<16>>(entries.begin(), entries.end())});
}

NearestSample::~NearestSample() = default;

bool NearestSample::interpolate(const Directions& directions, std::span<double> values) const {
  std::fill(values.begin(), values.end(), 0.0);
  const Point asked = point_at(directions, index_->isotropic);
  const auto nearest = index_->tree.qbegin(bg::index::nearest(asked, 1));
  if (nearest == index_->tree.qend()) return false;
  // The chord of both angles together is no shorter than that of the larger one.
  static const double kFarthest = 2 * std::sin(kFarthestDeg * kRadian / 2);
  if (bg::distance(asked, nearest->first) > kFarthest) return false;
  const auto first =
      index_->values.begin() + static_cast<std::ptrdiff_t>(nearest->second * values.size());
  std::copy_n(first, values.size(), values.begin());
  return true;
}

std::string NearestSample::rule() const {
  return "the nearest sample, at most " + std::to_string(static_cast<int>(kFarthestDeg)) +
         " degrees away";
}

}  // namespace clothbrdf
