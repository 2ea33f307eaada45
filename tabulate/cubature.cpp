#include "tabulate/cubature.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace clothbrdf {
namespace {

// The two rules can agree by chance: they must agree ten times better than asked.
constexpr double kSafety = 0.1;

struct Piece {
  Box4 box;
  std::vector<double> integral;
  std::vector<double> error;
  std::size_t roughest = 0;  // variable to halve
  double worst = 0;          // largest error, relative to the whole
};

class GenzMalik {
 public:
  GenzMalik(const Integrand4& integrand, std::size_t count)
      : integrand_(integrand), count_(count) {}

  Piece apply(const Box4& box) {
    static const double kNear = std::sqrt(9.0 / 70);
    static const double kFar = std::sqrt(9.0 / 10);
    static const double kCorner = std::sqrt(9.0 / 19);
    constexpr double kRatio = 1.0 / 7;  // (near / far)^2
    double volume = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      centre_[i] = (box.low[i] + box.high[i]) / 2;
      half_[i] = (box.high[i] - box.low[i]) / 2;
      volume *= 2 * half_[i];
    }
    points_.clear();
    add({});
    for (std::size_t i = 0; i < 4; ++i) {
      add({{i, kNear}});
      add({{i, kFar}});
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) add({{i, kFar}, {j, kFar}});
    }
    add({{0, kCorner}, {1, kCorner}, {2, kCorner}, {3, kCorner}});
    values_.resize(points_.size() * count_);
    integrand_(points_, values_);

    // In the same order.
    next_ = 0;
    Piece part{box, std::vector<double>(count_), std::vector<double>(count_)};
    const std::vector<double> centre = sum(1);
    std::vector<double> near(count_);
    std::vector<double> far(count_);
    double roughest = -1;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::vector<double> n = sum(2);
      const std::vector<double> f = sum(2);
      double difference = 0;
      for (std::size_t c = 0; c < count_; ++c) {
        difference += std::abs(n[c] - 2 * centre[c] - kRatio * (f[c] - 2 * centre[c]));
        near[c] += n[c];
        far[c] += f[c];
      }
      if (difference > roughest) {
        roughest = difference;
        part.roughest = i;
      }
    }
    const std::vector<double> edges = sum(24);
    const std::vector<double> corners = sum(16);
    for (std::size_t c = 0; c < count_; ++c) {
      // The weights for four variables.
      part.integral[c] = volume / 19683 *
                         (-17256 * centre[c] + 2940 * near[c] + 220 * far[c] + 200 * edges[c] +
                          6859.0 / 16 * corners[c]);
      const double weak =
          volume / 1458 * (-4542 * centre[c] + 735 * near[c] - 135 * far[c] + 50 * edges[c]);
      part.error[c] = std::abs(part.integral[c] - weak);
    }
    return part;
  }

 private:
  struct Offset {
    std::size_t variable;
    double steps;  // of half the box's width
  };

  // The points at all signs of the offsets.
  void add(std::initializer_list<Offset> offsets) {
    for (std::size_t signs = 0; signs < (std::size_t{1} << offsets.size()); ++signs) {
      Point4 at = centre_;
      std::size_t k = 0;
      for (const Offset& offset : offsets) {
        const double step = offset.steps * half_[offset.variable];
        at[offset.variable] += (signs >> k++ & 1U) != 0 ? -step : step;
      }
      points_.push_back(at);
    }
  }

  // The sums of the next so many values.
  std::vector<double> sum(std::size_t points) {
    std::vector<double> sum(count_);
    for (; points > 0; --points, ++next_) {
      for (std::size_t c = 0; c < count_; ++c) sum[c] += values_[next_ * count_ + c];
    }
    return sum;
  }

  const Integrand4& integrand_;
  std::size_t count_;
  Point4 centre_{};
  Point4 half_{};
  std::vector<Point4> points_;
  std::vector<double> values_;  // [point][function]
  std::size_t next_ = 0;
};

std::vector<double> total(const std::vector<Piece>& parts, std::vector<double> Piece::*what,
                          std::size_t count) {
  std::vector<double> sum(count);
  for (const Piece& part : parts) {
    for (std::size_t c = 0; c < count; ++c) sum[c] += (part.*what)[c];
  }
  return sum;
}

}  // namespace

std::optional<std::vector<double>> integrate4(const Integrand4& integrand, const Box4& box,
                                              std::size_t count, double tolerance,
                                              const CoarseVariable& coarse) {
  GenzMalik rule(integrand, count);
  std::vector<Piece> parts;
  std::vector<Box4> open = {box};
  while (!open.empty()) {
    Box4 lower = open.back();
    open.pop_back();
    if (parts.size() + open.size() > kMostParts) return std::nullopt;
    if (const std::optional<std::size_t> v = coarse(lower)) {
      Box4 upper = lower;
      lower.high[*v] = upper.low[*v] = (lower.low[*v] + lower.high[*v]) / 2;
      open.push_back(lower);
      open.push_back(upper);
    } else {
      parts.push_back(rule.apply(lower));
    }
  }
  std::vector<double> whole = total(parts, &Piece::integral, count);
  std::vector<double> error = total(parts, &Piece::error, count);
  const auto rate = [&](Piece& part) {
    part.worst = 0;
    for (std::size_t c = 0; c < count; ++c) {
      if (part.error[c] > 0) part.worst = std::max(part.worst, part.error[c] / std::abs(whole[c]));
    }
  };
  const auto by_worst = [](const Piece& a, const Piece& b) { return a.worst < b.worst; };
  const auto done = [&] {
    for (std::size_t c = 0; c < count; ++c) {
      if (error[c] > kSafety * tolerance * std::abs(whole[c])) return false;
    }
    return true;
  };
  for (Piece& part : parts) rate(part);
  std::make_heap(parts.begin(), parts.end(), by_worst);
  while (!done()) {
    if (parts.size() > kMostParts) return std::nullopt;
    std::pop_heap(parts.begin(), parts.end(), by_worst);
    const Piece worst = std::move(parts.back());
    parts.pop_back();
    for (const bool upper : {false, true}) {
      Box4 half = worst.box;
      const std::size_t v = worst.roughest;
      (upper ? half.low : half.high)[v] = (worst.box.low[v] + worst.box.high[v]) / 2;
      Piece part = rule.apply(half);
      for (std::size_t c = 0; c < count; ++c) {
        whole[c] += part.integral[c] - (upper ? 0 : worst.integral[c]);
        error[c] += part.error[c] - (upper ? 0 : worst.error[c]);
      }
      rate(part);
      parts.push_back(std::move(part));
      std::push_heap(parts.begin(), parts.end(), by_worst);
    }
  }
  return total(parts, &Piece::integral, count);
}

}  // namespace clothbrdf
