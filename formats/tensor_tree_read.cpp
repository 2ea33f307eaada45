#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "formats/shirley_chiu.h"
#include "formats/tensor_tree_xml.h"
#include "formats/tristimulus.h"
#include "formats/window_read.h"

namespace clothbrdf {
namespace {

// Cuts of an axis; what is finer is no measurement, and recursion ends.
constexpr int kDeepest = 16;

using Point = std::array<double, 4>;

// A tree of one spectrum as its readers see it: constant in each box.
class ValueTree {
 public:
  ValueTree(const WindowFile& file, const char* spectrum, int rank)
      : file_(&file), spectrum_(spectrum), rank_(static_cast<unsigned>(rank)) {
    NumberText text(file.find(spectrum)->numbers);
    nodes_.resize(1);
    parse(text, 0, 0);
    if (text.peek() != '\0') refuse(text, "nothing more");
    file_ = nullptr;  // for messages only
  }

  double at(Point point) const {
    std::size_t node = 0;
    while (nodes_[node].grid < 0) {
      std::size_t child = 0;
      for (unsigned axis = 0; axis < rank_; ++axis) {
        point[axis] *= 2;
        if (point[axis] >= 1) {
          point[axis] -= 1;
          child |= std::size_t{1} << axis;
        }
      }
      node = nodes_[node].first + child;
    }
    // The first axis is slowest.
    const auto log_size = static_cast<unsigned>(nodes_[node].grid);
    const double size = std::ldexp(1.0, nodes_[node].grid);
    std::size_t index = 0;
    for (unsigned axis = 0; axis < rank_; ++axis) {
      index = index << log_size | static_cast<std::size_t>(std::min(point[axis] * size, size - 1));
    }
    return values_[nodes_[node].first + index];
  }

  // Calls `visit` with the lowest corner and the width of each box.
  template <class Visit>
  void each_box(const Visit& visit) const {
    walk(0, {}, 1, visit);
  }

 private:
  struct Node {
    std::size_t first = 0;  // child or value
    int grid = -1;          // 2^grid values along each axis; -1 has children
  };

  [[noreturn]] void refuse(NumberText& text, const char* wanted) const {
    file_->refuse("ScatteringData of " + std::string(spectrum_) + ": " + text.next_words() +
                  " after " + std::to_string(values_.size()) + " numbers; allowed: " + wanted);
  }

  void parse(NumberText& text, std::size_t node, int depth) {
    if (!text.take('{')) refuse(text, "'{'");
    if (text.peek() == '{') {
      if (depth == kDeepest) refuse(text, "a tree of depth 16");
      const std::size_t first = nodes_.size();
      nodes_.resize(first + (std::size_t{1} << rank_));
      nodes_[node].first = first;
      for (std::size_t n = 0; n < std::size_t{1} << rank_; ++n) parse(text, first + n, depth + 1);
    } else {
      const std::size_t first = values_.size();
      while (const std::optional<double> number = text.number()) {
        values_.push_back(*number < 0 ? 0 : *number);
      }
      const std::size_t count = values_.size() - first;
      int grid = 0;
      while (std::size_t{1} << (rank_ * static_cast<unsigned>(grid)) < count) ++grid;
      if (std::size_t{1} << (rank_ * static_cast<unsigned>(grid)) != count) {
        refuse(text, rank_ == 4 ? "1, 16, 256 ... numbers between braces"
                                : "1, 8, 64 ... numbers between braces");
      }
      nodes_[node] = {first, grid};
    }
    if (!text.take('}')) refuse(text, "a number or '}'");
    text.take(',');
  }

  template <class Visit>
  void walk(std::size_t node, const Point& low, double width, const Visit& visit) const {
    const Node& at = nodes_[node];
    const auto log_size = static_cast<unsigned>(at.grid < 0 ? 1 : at.grid);
    const double part = std::ldexp(width, -static_cast<int>(log_size));
    for (std::size_t n = 0; n < std::size_t{1} << (rank_ * log_size); ++n) {
      Point corner = low;
      for (unsigned axis = 0; axis < rank_; ++axis) {
        // Children have the first axis fastest, values slowest.
        const unsigned digit = at.grid < 0 ? axis : rank_ - 1 - axis;
        corner[axis] += part * static_cast<double>(n >> (digit * log_size) &
                                                   ((std::size_t{1} << log_size) - 1));
      }
      if (at.grid < 0) {
        walk(at.first + n, corner, part, visit);
      } else {
        visit(corner, part);
      }
    }
  }

  const WindowFile* file_;
  const char* spectrum_;
  unsigned rank_;
  std::vector<Node> nodes_;
  std::vector<double> values_;
};

// Where a pair lies in the tree's cube.
Point cube_point(const Directions& d, int rank) {
  if (rank == 4) {
    const SquarePoint light = to_square(-d.wi[0], -d.wi[1]);
    const SquarePoint eye = to_square(d.wo[0], d.wo[1]);
    return {light[0], light[1], eye[0], eye[1]};
  }
  // Turned so that light travels along +x. The half above 0.5 is unused.
  const double sine = std::hypot(d.wi[0], d.wi[1]);
  const SinCos<double> turn =
      sine > 0 ? SinCos<double>{d.wi[1] / sine, -d.wi[0] / sine} : SinCos<double>{0, 1};
  const Vector3<double> out = turned(d.wo, turn);
  const SquarePoint eye = to_square(out[0], out[1]);
  constexpr double kBelowHalf = 0.5 - 1e-6;
  return {std::max(0.0, kBelowHalf - sine / 2), eye[0], eye[1], 0};
}

DirectionPair box_centre(const Point& low, double width, int rank) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const auto angles = [&](const Vector3<double>& v) {
    return std::pair(std::atan2(std::hypot(v[0], v[1]), v[2]) * kDegrees,
                     std::atan2(v[1], v[0]) * kDegrees);
  };
  const double half = width / 2;
  if (rank == 4) {
    const Vector3<double> travel = from_square({low[0] + half, low[1] + half});
    const auto [theta_i, phi_i] = angles({-travel[0], -travel[1], travel[2]});
    const auto [theta_o, phi_o] = angles(from_square({low[2] + half, low[3] + half}));
    return {theta_i, phi_i, theta_o, phi_o};
  }
  const double centre = (low[0] + std::min(low[0] + width, 0.5)) / 2;
  const auto [theta_o, phi_o] = angles(from_square({low[1] + half, low[2] + half}));
  return {std::asin(1 - 2 * centre) * kDegrees, 180, theta_o, phi_o};
}

class TreeLookup final : public Interpolant {
 public:
  TreeLookup(const WindowFile& file, int rank) : rank_(rank), visible_(file, "Visible", rank) {
    if (file.find("CIE-u") == nullptr || file.find("CIE-v") == nullptr) return;
    u_.emplace(file, "CIE-u", rank);
    v_.emplace(file, "CIE-v", rank);
  }

  const ValueTree& visible() const { return visible_; }
  std::size_t channels() const { return v_ ? 3 : 1; }

  bool interpolate(const Directions& directions, std::span<double> values) const override {
    const Rgb rgb = found(directions);
    return take_finite(std::span(rgb).first(values.size()), values);
  }

  // As stored, also where it is no number.
  Rgb found(const Directions& directions) const {
    const Point point = cube_point(directions, rank_);
    const double y = visible_.at(point);
    if (!v_) return {y, 0, 0};
    const double u = u_->at(point);
    const double v = v_->at(point);
    if (y == 0) return {0, 0, 0};
    return to_rgb({.x = y * 9 * u / (4 * v), .y = y, .z = y * (12 - 3 * u - 20 * v) / (4 * v)});
  }

  std::string rule() const override { return "that of the tree's box"; }

 private:
  int rank_;
  ValueTree visible_;
  std::optional<ValueTree> u_;
  std::optional<ValueTree> v_;
};

}  // namespace

Table read_tensor_tree(const WindowFile& file, int rank) {
  for (const char* spectrum : {"Visible", "CIE-u", "CIE-v"}) {
    const ScatteringBlock* block = file.find(spectrum);
    if (block != nullptr && !same_word(block->angle_basis, "LBNL/Shirley-Chiu")) {
      file.refuse("AngleBasis of " + std::string(spectrum) + " is '" +
                  std::string(block->angle_basis.substr(0, 40)) + "'; allowed: LBNL/Shirley-Chiu");
    }
  }
  auto lookup = std::make_shared<TreeLookup>(file, rank);
  PairList list;
  list.isotropic = rank == 3;
  std::vector<double> values;
  lookup->visible().each_box([&](const Point& low, double width) {
    if (rank == 3 && low[0] >= 0.5) return;
    const DirectionPair pair = box_centre(low, width, rank);
    list.pairs.push_back(pair);
    const Rgb rgb =
        lookup->found({direction(pair.theta_i, pair.phi_i), direction(pair.theta_o, pair.phi_o)});
    values.insert(values.end(), rgb.begin(),
                  rgb.begin() + static_cast<std::ptrdiff_t>(lookup->channels()));
  });
  return window_table(std::move(list), std::move(values), kTensorTreePrecision, std::move(lookup));
}

}  // namespace clothbrdf
