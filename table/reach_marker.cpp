#include "table/reach_marker.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "table/arc.h"

namespace clothbrdf {
namespace {

Interval radians(const AngleRange& degrees) {
  return {degrees.low * kRadian, degrees.high * kRadian};
}

std::vector<AxisBlock> blocks_of(const Axis& axis, int size) {
  std::vector<AxisBlock> blocks;
  for (int k = 0; k < axis.size; k += size) blocks.push_back({k, std::min(k + size, axis.size)});
  return blocks;
}

// As few cells as reach over so many degrees of an even axis.
int cells_in(const Axis& axis, double degrees) {
  return static_cast<int>(std::ceil(degrees * axis.size / (axis.highest_deg - axis.lowest_deg)));
}

// The angles of a block and of the cells on both sides of it.
Interval with_margin(const Axis& axis, const AxisBlock& block) {
  const int below = axis.periodic ? block.begin - 1 : std::max(block.begin - 1, 0);
  const int above = axis.periodic ? block.end + 1 : std::min(block.end + 1, axis.size);
  return {axis.edge_deg(below) * kRadian, axis.edge_deg(above) * kRadian};
}

Interval thetas_of(const Axis& axis, const AxisBlock& block) {
  const Interval thetas = with_margin(axis, block);
  // Readers continue a table beyond its last node.
  return {thetas.low, block.end + 1 >= axis.size ? kRightAngle : thetas.high};
}

// All azimuths that an axis keeps in a block and in the cells on both sides.
std::vector<Interval> phis_of(const Axis& axis, const AxisBlock& block) {
  const Interval own = with_margin(axis, block);
  const double period = axis.period_deg() * kRadian;
  if (period > 0 && own.width() >= period) return {{-kHalfTurn, kHalfTurn}};
  std::vector<Interval> images = {own};
  if (axis.mirrored) {
    const double twice = 2 * axis.lowest_deg * kRadian;
    images.push_back(Interval{twice, twice} - own);
  }
  const std::size_t count = images.size();
  for (double turn = period; period > 0 && turn < 2 * kHalfTurn - kArcRounding; turn += period) {
    for (std::size_t n = 0; n < count; ++n) images.push_back(images[n] + Interval{turn, turn});
  }
  return images;
}

std::vector<Arc> arcs_of(const Axis& axis, const AxisBlock& block) {
  std::vector<Arc> arcs;
  for (const Interval& image : phis_of(axis, block)) arcs.push_back(arc(image));
  return arcs;
}

bool any_meets(const std::vector<Arc>& arcs, const Arc& other) {
  return std::any_of(arcs.begin(), arcs.end(), [&](const Arc& a) { return a.meets(other); });
}

// Where light comes from and goes to, in the frame of the cloth.
struct LitPair {
  Interval theta_i;
  Arc phi_i;
  Interval theta_o;
  Arc phi_o;

  /// Seen from the light's azimuth: all that counts where a table has no other.
  LitPair from_light() const { return {theta_i, {}, theta_o, phi_o - phi_i}; }
};

// Each combination of a light, an eye and a rotation, once. `relative`: without their azimuths.
std::vector<LitPair> pairs_of(const Reach& reach, bool relative) {
  std::vector<LitPair> pairs;
  for (const DirectionRange& light : reach.lights) {
    for (const DirectionRange& eye : reach.eyes) {
      const LitPair pair = {radians(light.theta_deg), arc(radians(light.phi_deg)),
                            radians(eye.theta_deg), arc(radians(eye.phi_deg))};
      if (relative) {
        pairs.push_back(pair.from_light());
        continue;
      }
      for (const double rotation : reach.rotations_deg) {
        const Arc turn = {std::remainder(rotation, 360) * kRadian, 0};
        pairs.push_back({pair.theta_i, pair.phi_i - turn, pair.theta_o, pair.phi_o - turn});
        if (pair.phi_i.all_around() && pair.phi_o.all_around()) break;  // the same for all
      }
    }
  }
  return pairs;
}

class InOutMarker final : public ReachMarker {
 public:
  InOutMarker(const Grid& grid, const Reach& reach)
      : theta_i_(blocks_of(grid.axes[0], 1)), phi_i_(blocks_of(grid.axes[1], 1)) {
    // An only azimuth of the light stands for any, and the eye's is counted from it.
    const bool any_azimuth = grid.axes[1].size == 1;
    for (LitPair pair : pairs_of(reach, any_azimuth)) {
      // At the pole there is none: readers count from any.
      if (any_azimuth && pair.theta_i.low <= kArcRounding) pair.phi_o = {};
      lights_.push_back(cells_of(grid.axes[0], grid.axes[1], pair.theta_i, pair.phi_i));
      eyes_.push_back(cells_of(grid.axes[2], grid.axes[3], pair.theta_o, pair.phi_o));
    }
  }

  const std::vector<AxisBlock>& blocks() const override { return theta_i_; }

  void mark(std::size_t block, CellMarks& marks) const override {
    for (std::size_t p = 0; p < lights_.size(); ++p) {
      for (std::size_t row = 0; row < phi_i_.size(); ++row) {
        if (lights_[p][block * phi_i_.size() + row] == 0) continue;
        const CellMarks& eye = eyes_[p];
        std::uint8_t* const to = marks.data() + row * eye.size();
        for (std::size_t k = 0; k < eye.size(); ++k) to[k] |= eye[k];
      }
    }
  }

 private:
  // Cells of two axes that directions of some ranges lie in or next to: [theta][phi].
  static CellMarks cells_of(const Axis& theta, const Axis& phi, const Interval& thetas,
                            const Arc& phis) {
    CellMarks in_reach;
    for (const AxisBlock& p : blocks_of(phi, 1)) {
      in_reach.push_back(any_meets(arcs_of(phi, p), phis) ? 1 : 0);
    }
    CellMarks cells;
    for (const AxisBlock& t : blocks_of(theta, 1)) {
      const Interval of_cell = thetas_of(theta, t);
      const bool meets = meet(of_cell, thetas);
      // At the pole a direction has any azimuth.
      const bool pole = of_cell.low <= kArcRounding && thetas.low <= kArcRounding;
      for (const std::uint8_t phi_in_reach : in_reach) {
        cells.push_back(meets && (pole || phi_in_reach != 0) ? 1 : 0);
      }
    }
    return cells;
  }

  std::vector<AxisBlock> theta_i_;
  std::vector<AxisBlock> phi_i_;
  std::vector<CellMarks> lights_;  // of each pair [theta_i][phi_i]
  std::vector<CellMarks> eyes_;    // of each pair [theta_o][phi_o]
};

// Cosines and sines of phi_d.
struct Turn {
  Interval cos;
  Interval sin;
};
constexpr Turn kAnyTurn = {{-1, 1}, {-1, 1}};

// Cells of theta_h and theta_d. With x = cos(phi_d), s = theta_h + theta_d and
// d = theta_h - theta_d the cosines of incidence are
//
//     (cos(s) (1 + x) + cos(d) (1 - x)) / 2    of the light,
//     (cos(s) (1 - x) + cos(d) (1 + x)) / 2    of the eye,
//
// and, seen from the azimuth of the half vector, light and eye lie at
//
//     ((sin(s) (1 + x) + sin(d) (1 - x)) / 2, sin(theta_d) sin(phi_d)),
//     ((sin(s) (1 - x) + sin(d) (1 + x)) / 2, -sin(theta_d) sin(phi_d)).
class HalfAndDifference {
 public:
  HalfAndDifference(const Interval& theta_h, const Interval& theta_d)
      : cos_sum_(cosines(theta_h + theta_d)),
        cos_difference_(cosines(theta_h - theta_d)),
        sin_sum_(sines(theta_h + theta_d)),
        sin_difference_(sines(theta_h - theta_d)),
        sin_theta_d_(sines(theta_d)) {}

  // Whether light and eye can be at polar angles of these cosines.
  bool lit(const Turn& turn, const Interval& cos_theta_i, const Interval& cos_theta_o) const {
    return meet(between(cos_sum_, cos_difference_, turn.cos), cos_theta_i) &&
           meet(between(cos_sum_, cos_difference_, -turn.cos), cos_theta_o);
  }
  Arc light(const Turn& turn) const {
    return azimuths_of(between(sin_sum_, sin_difference_, turn.cos), sin_theta_d_ * turn.sin);
  }
  Arc eye(const Turn& turn) const {
    return azimuths_of(between(sin_sum_, sin_difference_, -turn.cos), -(sin_theta_d_ * turn.sin));
  }

 private:
  static Interval sines(const Interval& angles) {
    return cosines(angles - Interval{kRightAngle, kRightAngle});
  }

  // (a (1 + x) + b (1 - x)) / 2.
  static Interval between(const Interval& a, const Interval& b, const Interval& x) {
    const auto at = [](double from, double to, double cosine) {
      return (from * (1 + cosine) + to * (1 - cosine)) / 2;
    };
    return {std::min(at(a.low, b.low, x.low), at(a.low, b.low, x.high)),
            std::max(at(a.high, b.high, x.low), at(a.high, b.high, x.high))};
  }

  Interval cos_sum_;
  Interval cos_difference_;
  Interval sin_sum_;
  Interval sin_difference_;
  Interval sin_theta_d_;
};

class HalfDifferenceMarker final : public ReachMarker {
 public:
  HalfDifferenceMarker(const Grid& grid, const Reach& reach)
      : pairs_(pairs_of(reach, grid.kind == GridKind::kHalfDifference3d)),
        columns_(static_cast<std::size_t>(grid.axes.back().size)),
        row_cells_(grid.column_count()) {
    for (const LitPair& pair : pairs_) {
      cosines_.push_back({cosines(pair.theta_i), cosines(pair.theta_o)});
    }
    // Small enough to leave out most of what is not reached, large enough to cost less than that.
    constexpr double kThetaBlock = 3;
    constexpr double kPhiBlock = 6;
    const Axis& theta_h = grid.axes.front();
    theta_h_blocks_ = blocks_of(theta_h, cells_in(theta_h, kThetaBlock));
    for (const AxisBlock& block : theta_h_blocks_) theta_h_.push_back(thetas_of(theta_h, block));
    const Axis& theta_d = grid.axes[grid.axes.size() - 2];
    theta_d_blocks_ = blocks_of(theta_d, cells_in(theta_d, kThetaBlock));
    for (const AxisBlock& block : theta_d_blocks_) theta_d_.push_back(thetas_of(theta_d, block));
    const Axis& phi_d = grid.axes.back();
    phi_d_blocks_ = blocks_of(phi_d, cells_in(phi_d, kPhiBlock));
    for (const AxisBlock& block : phi_d_blocks_) {
      std::vector<Turn>& turns = phi_d_.emplace_back();
      for (const Interval& phis : phis_of(phi_d, block)) {
        turns.push_back({cosines(phis), cosines(phis - Interval{kRightAngle, kRightAngle})});
      }
    }
    if (grid.kind == GridKind::kHalfDifference4d) {
      for (const AxisBlock& block : blocks_of(grid.axes[1], 1)) {
        phi_h_.push_back(arcs_of(grid.axes[1], block));
      }
    }
  }

  const std::vector<AxisBlock>& blocks() const override { return theta_h_blocks_; }

  void mark(std::size_t block, CellMarks& marks) const override {
    std::vector<std::size_t> lit;
    for (std::size_t d = 0; d < theta_d_.size(); ++d) {
      const HalfAndDifference half(theta_h_[block], theta_d_[d]);
      lit.clear();
      for (std::size_t p = 0; p < pairs_.size(); ++p) {
        if (half.lit(kAnyTurn, cosines_[p].light, cosines_[p].eye)) lit.push_back(p);
      }
      for (std::size_t k = 0; k < phi_d_.size() && !lit.empty(); ++k) {
        const std::vector<std::uint8_t> rows = rows_in_reach(half, phi_d_[k], lit);
        for (std::size_t row = 0; row < rows.size(); ++row) {
          if (rows[row] != 0) {
            mark_columns(theta_d_blocks_[d], phi_d_blocks_[k], marks.data() + row * row_cells_);
          }
        }
      }
    }
  }

 private:
  struct Cosines {
    Interval light;
    Interval eye;
  };

  // 1 or 0 for each phi_h, from whose half vectors some pair's light and eye are seen where they
  // can be; of a grid without phi_h for its one row.
  std::vector<std::uint8_t> rows_in_reach(const HalfAndDifference& half,
                                          const std::vector<Turn>& turns,
                                          const std::vector<std::size_t>& lit) const {
    std::vector<std::uint8_t> rows(std::max<std::size_t>(1, phi_h_.size()));
    std::size_t left = rows.size();
    for (const Turn& turn : turns) {
      std::optional<Arc> light;  // as azimuths take long, only once they are asked for
      std::optional<Arc> eye;
      for (const std::size_t p : lit) {
        if (left == 0) return rows;
        if (!half.lit(turn, cosines_[p].light, cosines_[p].eye)) continue;
        const LitPair& pair = pairs_[p];
        if (!light && !(pair.phi_i.all_around() && pair.phi_o.all_around())) {
          light = half.light(turn);
          eye = half.eye(turn);
        }
        left -= phi_h_.empty() ? mark_only_row(pair, light, eye, rows)
                               : mark_rows(pair, light, eye, rows);
      }
    }
    return rows;
  }

  // Pairs are seen from the light's azimuth. Returns how many rows are new.
  static std::size_t mark_only_row(const LitPair& pair, const std::optional<Arc>& light,
                                   const std::optional<Arc>& eye, std::vector<std::uint8_t>& rows) {
    if (!pair.phi_o.all_around() && !(*eye - *light).meets(pair.phi_o)) return 0;
    rows[0] = 1;
    return 1;
  }

  std::size_t mark_rows(const LitPair& pair, const std::optional<Arc>& light,
                        const std::optional<Arc>& eye, std::vector<std::uint8_t>& rows) const {
    // Where the half vector is when the light is, and the eye, where it can be.
    const Arc for_light = pair.phi_i.all_around() ? Arc{} : pair.phi_i - *light;
    const Arc for_eye = pair.phi_o.all_around() ? Arc{} : pair.phi_o - *eye;
    std::size_t more = 0;
    for (std::size_t h = 0; h < rows.size(); ++h) {
      const bool meets =
          rows[h] == 0 && std::any_of(phi_h_[h].begin(), phi_h_[h].end(), [&](const Arc& arc) {
            return arc.meets(for_light) && arc.meets(for_eye);
          });
      if (!meets) continue;
      rows[h] = 1;
      ++more;
    }
    return more;
  }

  void mark_columns(const AxisBlock& theta_d, const AxisBlock& phi_d, std::uint8_t* row) const {
    for (int d = theta_d.begin; d < theta_d.end; ++d) {
      std::uint8_t* const first = row + static_cast<std::size_t>(d) * columns_;
      std::fill(first + phi_d.begin, first + phi_d.end, std::uint8_t{1});
    }
  }

  std::vector<LitPair> pairs_;
  std::vector<Cosines> cosines_;  // of the pairs' polar angles
  std::vector<AxisBlock> theta_h_blocks_;
  std::vector<Interval> theta_h_;
  std::vector<std::vector<Arc>> phi_h_;  // of each cell; none without that axis
  std::vector<AxisBlock> theta_d_blocks_;
  std::vector<Interval> theta_d_;
  std::vector<AxisBlock> phi_d_blocks_;
  std::vector<std::vector<Turn>> phi_d_;
  std::size_t columns_;  // of one theta_d
  std::size_t row_cells_;
};

}  // namespace

std::unique_ptr<const ReachMarker> make_reach_marker(const Grid& grid, const Reach& reach) {
  if (grid.kind == GridKind::kInOut) return std::make_unique<InOutMarker>(grid, reach);
  return std::make_unique<HalfDifferenceMarker>(grid, reach);
}

}  // namespace clothbrdf
