#include "table/reached_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <utility>

namespace clothbrdf {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kRightAngle = kHalfTurn / 2;
constexpr double kRadian = kHalfTurn / 180;
// Ranges are wider by more than all roundings, radians and cosines.
constexpr double kRounding = 1e-9;

struct Range {
  double low;
  double high;

  bool meets(const Range& other) const {
    return low <= other.high + kRounding && other.low <= high + kRounding;
  }
};

Range operator+(const Range& a, const Range& b) { return {a.low + b.low, a.high + b.high}; }
Range operator-(const Range& a, const Range& b) { return {a.low - b.high, a.high - b.low}; }
Range operator-(const Range& a) { return {-a.high, -a.low}; }
// Of a >= 0.
Range operator*(const Range& a, const Range& b) {
  return {(b.low < 0 ? a.high : a.low) * b.low, (b.high < 0 ? a.low : a.high) * b.high};
}

Range radians(const AngleRange& degrees) { return {degrees.low * kRadian, degrees.high * kRadian}; }

// Azimuths up to `half` to both sides of `middle`, which lies in [-pi, pi].
struct Arc {
  double middle = 0;
  double half = kHalfTurn;

  bool all_around() const { return half >= kHalfTurn; }
  bool meets(const Arc& other) const {
    const double apart = std::abs(middle - other.middle);
    return std::min(apart, 2 * kHalfTurn - apart) <= half + other.half + kRounding;
  }
};

Arc arc(const Range& azimuths) {
  const double half = (azimuths.high - azimuths.low) / 2;
  if (half >= kHalfTurn - kRounding) return {};
  return {std::remainder((azimuths.low + azimuths.high) / 2, 2 * kHalfTurn), half};
}

Arc operator-(const Arc& a, const Arc& b) {
  if (a.half + b.half >= kHalfTurn) return {};
  const double middle = a.middle - b.middle;
  const double turns = middle > kHalfTurn ? 1 : middle < -kHalfTurn ? -1 : 0;
  return {middle - turns * 2 * kHalfTurn, a.half + b.half};
}

// Directions from the origin to the points of a rectangle.
Arc azimuths(Range x, Range y) {
  const bool left = x.low <= kRounding;
  const bool right = x.high >= -kRounding;
  double turned = 0;
  if (left && right) {
    if (y.low <= kRounding && y.high >= -kRounding) return {};
    // Above or below the origin: seen from a quarter of a turn on.
    turned = y.low > 0 ? kRightAngle : -kRightAngle;
    const Range before = x;
    x = y.low > 0 ? y : -y;
    y = y.low > 0 ? -before : before;
  } else if (left) {
    turned = kHalfTurn;
    x = -x;
    y = -y;
  }
  const double low = std::atan2(y.low, y.low < 0 ? x.low : x.high);
  const double high = std::atan2(y.high, y.high > 0 ? x.low : x.high);
  const double middle = turned + (low + high) / 2;
  return {middle > kHalfTurn ? middle - 2 * kHalfTurn : middle, (high - low) / 2};
}

// Cosines of angles in [-pi, pi].
Range cosines(const Range& angles) {
  const double low = std::cos(angles.low);
  const double high = std::cos(angles.high);
  const bool holds_0 = angles.low <= 0 && angles.high >= 0;
  return {std::min(low, high), holds_0 ? 1 : std::max(low, high)};
}

// Sines of angles in [-pi / 2, pi].
Range sines(const Range& angles) {
  return cosines({angles.low - kRightAngle, angles.high - kRightAngle});
}

// Cells of an axis from `begin` to before `end`.
struct Block {
  int begin;
  int end;
};

std::vector<Block> blocks_of(const Axis& axis, int size) {
  std::vector<Block> blocks;
  for (int k = 0; k < axis.size; k += size) blocks.push_back({k, std::min(k + size, axis.size)});
  return blocks;
}

// The angles of a block and of the cells on both sides of it.
Range with_margin(const Axis& axis, const Block& block) {
  const int below = axis.periodic ? block.begin - 1 : std::max(block.begin - 1, 0);
  const int above = axis.periodic ? block.end + 1 : std::min(block.end + 1, axis.size);
  return {axis.edge_deg(below) * kRadian, axis.edge_deg(above) * kRadian};
}

Range thetas_of(const Axis& axis, const Block& block) {
  const Range thetas = with_margin(axis, block);
  // Readers continue a table beyond its last node.
  return {thetas.low, block.end + 1 >= axis.size ? kRightAngle : thetas.high};
}

// All azimuths that an axis keeps in a block and in the cells on both sides.
std::vector<Range> azimuths_of(const Axis& axis, const Block& block) {
  const Range own = with_margin(axis, block);
  const double period = axis.period_deg() * kRadian;
  if (period > 0 && own.high - own.low >= period) return {{-kHalfTurn, kHalfTurn}};
  std::vector<Range> images = {own};
  if (axis.mirrored) {
    const double twice = 2 * axis.lowest_deg * kRadian;
    images.push_back(Range{twice, twice} - own);
  }
  const std::size_t count = images.size();
  for (double turn = period; period > 0 && turn < 2 * kHalfTurn - kRounding; turn += period) {
    for (std::size_t n = 0; n < count; ++n) images.push_back(images[n] + Range{turn, turn});
  }
  return images;
}

std::vector<Arc> arcs_of(const Axis& axis, const Block& block) {
  std::vector<Arc> arcs;
  for (const Range& image : azimuths_of(axis, block)) arcs.push_back(arc(image));
  return arcs;
}

// Where light comes from and goes to, in the frame of the cloth.
struct Pair {
  Range theta_i;
  Arc phi_i;
  Range theta_o;
  Arc phi_o;
  Range cos_theta_i = cosines(theta_i);
  Range cos_theta_o = cosines(theta_o);
};

std::vector<Pair> pairs_of(const Reach& reach) {
  std::vector<Pair> pairs;
  for (const DirectionRange& light : reach.lights) {
    for (const DirectionRange& eye : reach.eyes) {
      for (const double rotation : reach.rotations_deg) {
        const Arc turn = {std::remainder(rotation, 360) * kRadian, 0};
        pairs.push_back({radians(light.theta_deg), arc(radians(light.phi_deg)) - turn,
                         radians(eye.theta_deg), arc(radians(eye.phi_deg)) - turn});
      }
    }
  }
  return pairs;
}

// Marks of all rows that share a cell of the first axis: 1 or 0 for each [row][column].
using Marks = std::vector<std::uint8_t>;

class Marker {
 public:
  virtual ~Marker() = default;
  /// Blocks of the first axis whose cells are marked alike.
  virtual const std::vector<Block>& blocks() const = 0;
  virtual void mark(std::size_t block, Marks& marks) const = 0;
};

class InOutMarker final : public Marker {
 public:
  InOutMarker(const Grid& grid, const Reach& reach)
      : theta_i_(blocks_of(grid.axes[0], 1)), phi_i_(blocks_of(grid.axes[1], 1)) {
    const bool any_azimuth = grid.axes[1].size == 1;
    for (Pair pair : pairs_of(reach)) {
      // An only azimuth of the light stands for any, and the eye's is counted from it.
      // At the pole the light has none, and readers count from any.
      if (any_azimuth) {
        const bool pole = pair.theta_i.low <= kRounding;
        pair = {pair.theta_i, {}, pair.theta_o, pole ? Arc{} : pair.phi_o - pair.phi_i};
      }
      lights_.push_back(cells_of(grid.axes[0], grid.axes[1], pair.theta_i, pair.phi_i));
      eyes_.push_back(cells_of(grid.axes[2], grid.axes[3], pair.theta_o, pair.phi_o));
    }
  }

  const std::vector<Block>& blocks() const override { return theta_i_; }

  void mark(std::size_t block, Marks& marks) const override {
    for (std::size_t p = 0; p < lights_.size(); ++p) {
      for (std::size_t row = 0; row < phi_i_.size(); ++row) {
        if (lights_[p][block * phi_i_.size() + row] == 0) continue;
        const Marks& eye = eyes_[p];
        std::uint8_t* const to = marks.data() + row * eye.size();
        for (std::size_t k = 0; k < eye.size(); ++k) to[k] |= eye[k];
      }
    }
  }

 private:
  // Cells of two axes that directions of some ranges lie in or next to: [theta][phi].
  static Marks cells_of(const Axis& theta, const Axis& phi, const Range& thetas, const Arc& phis) {
    Marks cells;
    for (const Block& t : blocks_of(theta, 1)) {
      const Range of_cell = thetas_of(theta, t);
      // At the pole a direction has any azimuth.
      const bool pole = of_cell.low <= kRounding && thetas.low <= kRounding;
      for (const Block& p : blocks_of(phi, 1)) {
        const std::vector<Arc> arcs = arcs_of(phi, p);
        const bool meets = of_cell.meets(thetas) &&
                           (pole || std::any_of(arcs.begin(), arcs.end(),
                                                [&](const Arc& arc) { return arc.meets(phis); }));
        cells.push_back(meets ? 1 : 0);
      }
    }
    return cells;
  }

  std::vector<Block> theta_i_;
  std::vector<Block> phi_i_;
  std::vector<Marks> lights_;  // of each pair [theta_i][phi_i]
  std::vector<Marks> eyes_;    // of each pair [theta_o][phi_o]
};

// With x = cos(phi_d), s = theta_h + theta_d and d = theta_h - theta_d the cosines of incidence are
//
//     (cos(s) (1 + x) + cos(d) (1 - x)) / 2    of the light,
//     (cos(s) (1 - x) + cos(d) (1 + x)) / 2    of the eye,
//
// and, seen from the azimuth of the half vector, light and eye lie at
//
//     ((sin(s) (1 + x) + sin(d) (1 - x)) / 2, sin(theta_d) sin(phi_d)),
//     ((sin(s) (1 - x) + sin(d) (1 + x)) / 2, -sin(theta_d) sin(phi_d)).
class HalfDifferenceMarker final : public Marker {
 public:
  HalfDifferenceMarker(const Grid& grid, const Reach& reach)
      : pairs_(pairs_of(reach)),
        columns_(static_cast<std::size_t>(grid.axes.back().size)),
        row_cells_(grid.column_count()) {
    const Axis& theta_h = grid.axes.front();
    const Axis& theta_d = grid.axes[grid.axes.size() - 2];
    const Axis& phi_d = grid.axes.back();
    constexpr double kThetaBlock = 3;
    constexpr double kPhiBlock = 6;
    theta_h_blocks_ = blocks_of(theta_h, cells_in(theta_h, kThetaBlock));
    for (const Block& block : theta_h_blocks_) theta_h_.push_back(thetas_of(theta_h, block));
    theta_d_blocks_ = blocks_of(theta_d, cells_in(theta_d, kThetaBlock));
    for (const Block& block : theta_d_blocks_) theta_d_.push_back(thetas_of(theta_d, block));
    phi_d_blocks_ = blocks_of(phi_d, cells_in(phi_d, kPhiBlock));
    for (const Block& block : phi_d_blocks_) {
      phi_d_.emplace_back();
      for (const Range& image : azimuths_of(phi_d, block)) phi_d_.back().push_back(turned(image));
    }
    if (grid.kind == GridKind::kHalfDifference4d) {
      for (const Block& block : blocks_of(grid.axes[1], 1)) {
        phi_h_.push_back(arcs_of(grid.axes[1], block));
      }
    }
  }

  const std::vector<Block>& blocks() const override { return theta_h_blocks_; }

  void mark(std::size_t block, Marks& marks) const override {
    for (std::size_t d = 0; d < theta_d_.size(); ++d) {
      const Half half(theta_h_[block], theta_d_[d]);
      for (const Pair& pair : pairs_) {
        if (!half.lit({{-1, 1}, {-1, 1}}, pair)) continue;
        for (std::size_t k = 0; k < phi_d_.size(); ++k) {
          for (const Turn& turn : phi_d_[k]) {
            if (half.lit(turn, pair)) mark_rows(half, turn, pair, {theta_d_blocks_[d], k}, marks);
          }
        }
      }
    }
  }

 private:
  // Cosines and sines of phi_d.
  struct Turn {
    Range cos;
    Range sin;
  };

  static Turn turned(const Range& azimuths) {
    const auto along = [&](double direction) {
      const Range off = {azimuths.low - direction, azimuths.high - direction};
      const double low = std::cos(off.low);
      const double high = std::cos(off.high);
      const bool least = arc(off).meets({kHalfTurn, 0});
      const bool most = arc(off).meets({0, 0});
      return Range{least ? -1 : std::min(low, high), most ? 1 : std::max(low, high)};
    };
    return {along(0), along(kRightAngle)};
  }

  // Cells of theta_h and theta_d.
  struct Half {
    Half(const Range& theta_h, const Range& theta_d)
        : cos_sum(cosines(theta_h + theta_d)),
          cos_difference(cosines(theta_h - theta_d)),
          sin_sum(sines(theta_h + theta_d)),
          sin_difference(sines(theta_h - theta_d)),
          sin_theta_d(sines(theta_d)) {}

    // Whether light and eye can be at the polar angles of a pair.
    bool lit(const Turn& turn, const Pair& pair) const {
      return between(cos_sum, cos_difference, turn.cos).meets(pair.cos_theta_i) &&
             between(cos_sum, cos_difference, -turn.cos).meets(pair.cos_theta_o);
    }
    Arc light(const Turn& turn) const {
      return azimuths(between(sin_sum, sin_difference, turn.cos), sin_theta_d * turn.sin);
    }
    Arc eye(const Turn& turn) const {
      return azimuths(between(sin_sum, sin_difference, -turn.cos), -(sin_theta_d * turn.sin));
    }

    Range cos_sum;
    Range cos_difference;
    Range sin_sum;
    Range sin_difference;
    Range sin_theta_d;
  };

  // (a (1 + x) + b (1 - x)) / 2.
  static Range between(const Range& a, const Range& b, const Range& x) {
    const auto at = [](double from, double to, double cosine) {
      return (from * (1 + cosine) + to * (1 - cosine)) / 2;
    };
    return {std::min(at(a.low, b.low, x.low), at(a.low, b.low, x.high)),
            std::max(at(a.high, b.high, x.low), at(a.high, b.high, x.high))};
  }

  static int cells_in(const Axis& axis, double degrees) {
    return static_cast<int>(std::ceil(degrees * axis.size / (axis.highest_deg - axis.lowest_deg)));
  }

  // Columns: all of theta_d by a block of phi_d.
  struct Columns {
    Block theta_d;
    std::size_t phi_d;
  };

  // In the rows of all phi_h from which light and eye are seen where they can be.
  void mark_rows(const Half& half, const Turn& turn, const Pair& pair, const Columns& columns,
                 Marks& marks) const {
    const bool some_light = !pair.phi_i.all_around();
    const bool some_eye = !pair.phi_o.all_around();
    if (phi_h_.empty()) {
      const bool meet = !some_light || !some_eye ||
                        (pair.phi_i - half.light(turn)).meets(pair.phi_o - half.eye(turn));
      if (meet) mark_columns(columns, marks.data());
      return;
    }
    // Where the half vector is when the light is, or the eye, where it can be.
    const Arc for_light = some_light ? pair.phi_i - half.light(turn) : Arc{};
    const Arc for_eye = some_eye ? pair.phi_o - half.eye(turn) : Arc{};
    for (std::size_t h = 0; h < phi_h_.size(); ++h) {
      const bool meets = std::any_of(phi_h_[h].begin(), phi_h_[h].end(), [&](const Arc& arc) {
        return arc.meets(for_light) && arc.meets(for_eye);
      });
      if (meets) mark_columns(columns, marks.data() + h * row_cells_);
    }
  }

  void mark_columns(const Columns& columns, std::uint8_t* row) const {
    const Block& phi_d = phi_d_blocks_[columns.phi_d];
    for (int d = columns.theta_d.begin; d < columns.theta_d.end; ++d) {
      std::uint8_t* const first = row + static_cast<std::size_t>(d) * columns_;
      std::fill(first + phi_d.begin, first + phi_d.end, std::uint8_t{1});
    }
  }

  std::vector<Pair> pairs_;
  std::vector<Block> theta_h_blocks_;
  std::vector<Range> theta_h_;
  std::vector<std::vector<Arc>> phi_h_;  // of each cell; none without that axis
  std::vector<Block> theta_d_blocks_;
  std::vector<Range> theta_d_;
  std::vector<Block> phi_d_blocks_;
  std::vector<std::vector<Turn>> phi_d_;
  std::size_t columns_;  // of one theta_d
  std::size_t row_cells_;
};

}  // namespace

ReachedCells::ReachedCells(const Grid& grid, const Reach& reach)
    : row_cells_(grid.column_count()), columns_{row_cells_, 0} {
  std::unique_ptr<const Marker> marker;
  if (grid.kind == GridKind::kInOut) {
    marker = std::make_unique<InOutMarker>(grid, reach);
  } else {
    marker = std::make_unique<HalfDifferenceMarker>(grid, reach);
  }
  const std::size_t rows = grid.row_count() / static_cast<std::size_t>(grid.axes.front().size);
  first_range_.reserve(grid.row_count() + 1);
  Marks marks(rows * row_cells_);
  for (std::size_t b = 0; b < marker->blocks().size(); ++b) {
    std::fill(marks.begin(), marks.end(), std::uint8_t{0});
    marker->mark(b, marks);
    const Block& block = marker->blocks()[b];
    for (int cell = block.begin; cell < block.end; ++cell) {
      for (std::size_t row = 0; row < rows; ++row) {
        add_row(std::span(marks).subspan(row * row_cells_, row_cells_));
      }
    }
  }
  if (count_ == 0) columns_ = {0, 0};
}

void ReachedCells::add_row(std::span<const std::uint8_t> marks) {
  const auto next = [&](std::size_t from, int wanted) {
    const void* const found = std::memchr(marks.data() + from, wanted, marks.size() - from);
    return found == nullptr
               ? marks.size()
               : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - marks.data());
  };
  for (std::size_t begin = next(0, 1); begin < marks.size();) {
    const std::size_t end = next(begin, 0);
    ranges_.push_back({begin, end});
    columns_ = {std::min(columns_.begin, begin), std::max(columns_.end, end)};
    count_ += end - begin;
    begin = next(end, 1);
  }
  first_range_.push_back(ranges_.size());
}

void ReachedCells::restrict(std::span<std::uint8_t> cells) const {
  for (std::size_t at = 0; at + 1 < first_range_.size(); ++at) {
    std::uint8_t* const of_row = cells.data() + at * row_cells_;
    std::size_t from = 0;
    for (const ColumnRange& range : row(at)) {
      std::fill(of_row + from, of_row + range.begin, std::uint8_t{0});
      from = range.end;
    }
    std::fill(of_row + from, of_row + row_cells_, std::uint8_t{0});
  }
}

}  // namespace clothbrdf
