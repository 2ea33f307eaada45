#include "formats/tensor_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/shirley_chiu.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr std::size_t kChildren = 16;
// Every box is cut so often, lest a narrow lobe be missed.
constexpr int kSureDepth = 4;
// Subtrees from here on are built in parallel.
constexpr int kTaskDepth = 3;

struct TreePlace {
  int depth = 0;
  std::array<std::uint32_t, 4> at{};

  TreePlace child(std::size_t n) const {
    TreePlace result{depth + 1, at};
    for (std::size_t axis = 0; axis < 4; ++axis) {
      result.at[axis] = 2 * at[axis] + static_cast<std::uint32_t>(n >> axis & 1U);
    }
    return result;
  }
  // The light's own direction: the opposite point of the square.
  SquareCell light() const {
    const std::uint32_t last = (1U << depth) - 1;
    return {depth, last - at[0], last - at[1]};
  }
  SquareCell eye() const { return {depth, at[2], at[3]}; }
};

double largest(const std::array<float, 3>& rgb) {
  return std::max({std::abs(rgb[0]), std::abs(rgb[1]), std::abs(rgb[2])});
}

// How far children are from their mean, relative to its largest channel.
float deviation(const BoxTree::Box& parent, const std::array<float, 3>& child) {
  double difference = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    difference = std::max(difference, std::abs(double{child[c]} - parent.mean[c]));
  }
  return difference > 0 ? static_cast<float>(difference / largest(parent.mean)) : 0;
}

// Sets the mean and the error of a box of a depth whose children, and all below, follow it.
void summarise(std::vector<BoxTree::Box>& boxes, std::size_t parent, int depth) {
  const float width = std::ldexp(1.0F, -depth);
  std::array<std::size_t, kChildren> children{};
  std::size_t next = parent + 1;
  Rgb sum{};
  for (std::size_t& child : children) {
    child = next;
    next += boxes[child].size;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += boxes[child].mean[c];
  }
  BoxTree::Box& box = boxes[parent];
  for (std::size_t c = 0; c < 3; ++c) box.mean[c] = static_cast<float>(sum[c] / kChildren);
  box.error = 0;
  for (const std::size_t child : children) {
    box.error =
        std::max({box.error, boxes[child].error, width * deviation(box, boxes[child].mean)});
  }
  box.size = static_cast<std::uint32_t>(next - parent);
}

// The rules of all cells of the square at each depth.
class CellRules {
 public:
  explicit CellRules(int depth) {
    for (int d = kSureDepth + 1; d <= depth; ++d) {
      const std::uint32_t cells = 1U << d;
      std::vector<DirectionRule>& rules = of_depth_.emplace_back();
      for (std::uint32_t y = 0; y < cells; ++y) {
        for (std::uint32_t x = 0; x < cells; ++x) {
          rules.push_back(SquareCell{d, x, y}.rule(2));
        }
      }
    }
  }
  const DirectionRule& of(const SquareCell& cell) const {
    return of_depth_[static_cast<std::size_t>(cell.depth - kSureDepth - 1)]
                    [(std::size_t{cell.y} << cell.depth) + cell.x];
  }

 private:
  std::vector<std::vector<DirectionRule>> of_depth_;
};

// One subtree.
class Builder {
 public:
  Builder(const Producer& producer, const Workers& workers, const CellRules& rules,
          const BoxTree::Limits& limits)
      : producer_(producer), workers_(workers), rules_(rules), limits_(limits) {}

  void build(const TreePlace& place, std::vector<BoxTree::Box>& boxes) {
    const std::size_t parent = boxes.size();
    boxes.emplace_back();
    if (place.depth < kSureDepth) {
      for (std::size_t n = 0; n < kChildren; ++n) build(place.child(n), boxes);
      summarise(boxes, parent, place.depth);
      return;
    }
    if (place.depth == kSureDepth) {
      workers_.advance(std::size_t{1} << (4U * static_cast<unsigned>(limits_.depth - kSureDepth)));
    }
    if (place.depth == limits_.depth) return;  // its parent knows the mean
    const std::array<std::array<float, 3>, kChildren> means = child_means(place);
    for (const std::array<float, 3>& mean : means) boxes.push_back({mean, 0, 1});
    summarise(boxes, parent, place.depth);
    const bool cut = boxes[parent].error > static_cast<float>(limits_.error);
    if (cut && place.depth + 1 == limits_.depth) return;
    boxes.resize(parent + 1);
    boxes[parent].size = 1;
    boxes[parent].error = 0;
    if (!cut) return;
    for (std::size_t n = 0; n < kChildren; ++n) build(place.child(n), boxes);
    summarise(boxes, parent, place.depth);
  }

 private:
  std::array<std::array<float, 3>, kChildren> child_means(const TreePlace& place) {
    const std::array<SquareCell, 4> eyes = place.eye().quarters();
    std::array<std::array<float, 3>, kChildren> means{};
    pairs_.clear();
    for (std::size_t n = 0; n < kChildren; ++n) {
      const DirectionRule& light = rules_.of(place.child(n).light());
      const DirectionRule& eye = rules_.of(eyes[n >> 2U]);
      for (const Vector3<double>& wi : light.directions) {
        for (const Vector3<double>& wo : eye.directions) pairs_.push_back({wi, wo});
      }
    }
    values_.resize(3 * pairs_.size());
    producer_.fill_pairs(pairs_, values_);
    const double* value = values_.data();
    for (std::size_t n = 0; n < kChildren; ++n) {
      Rgb sum{};
      for (const double weight_i : rules_.of(place.child(n).light()).weights) {
        for (const double weight_o : rules_.of(eyes[n >> 2U]).weights) {
          for (double& channel : sum) channel += weight_i * weight_o * *value++;
        }
      }
      for (std::size_t c = 0; c < 3; ++c) means[n][c] = static_cast<float>(sum[c]);
    }
    return means;
  }

  const Producer& producer_;
  const Workers& workers_;
  const CellRules& rules_;
  BoxTree::Limits limits_;
  std::vector<Directions> pairs_;
  std::vector<double> values_;
};

using Boxes = std::vector<BoxTree::Box>;

void prune_boxes(Boxes& boxes, double error) {
  std::size_t kept = 0;
  // A box's children follow it, so what is kept moves down, never up.
  const auto keep = [&](const auto& self, std::size_t from) -> void {
    const BoxTree::Box box = boxes[from];
    const std::size_t to = kept++;
    boxes[to] = box;
    boxes[to].size = 1;
    if (box.size == 1) return;
    if (box.error <= error) {
      boxes[to].error = 0;
      return;
    }
    std::size_t next = from + 1;
    for (std::size_t n = 0; n < kChildren; ++n) {
      const std::size_t size = boxes[next].size;
      self(self, next);
      next += size;
    }
    boxes[to].size = static_cast<std::uint32_t>(kept - to);
  };
  keep(keep, 0);
  boxes.resize(kept);
  if (boxes.size() < boxes.capacity() / 2) boxes.shrink_to_fit();
}

}  // namespace

BoxTree BoxTree::build(const Producer& producer, const Workers& workers, const Limits& limits) {
  constexpr std::size_t kParts = kChildren * kChildren * kChildren;
  // A round of parts fits into memory however finely they are cut.
  constexpr std::size_t kRound = 16;
  const CellRules rules(limits.depth);
  Limits now = limits;
  std::vector<Boxes> parts(kParts);
  std::size_t total = 0;
  for (std::size_t first = 0; first < kParts; first += kRound) {
    with_threads(workers.threads, [&] {
      run_parallel(kRound, workers, [&](std::size_t n) {
        const std::size_t k = first + n;
        const TreePlace place = TreePlace{}.child(k >> 8U).child(k >> 4U & 15U).child(k & 15U);
        Builder(producer, workers, rules, now).build(place, parts[k]);
        prune_boxes(parts[k], now.error);
      });
    });
    for (std::size_t k = first; k < first + kRound; ++k) total += parts[k].size();
    while (total > std::max(limits.boxes, kParts)) {
      now.error *= 1.25;
      total = 0;
      for (std::size_t k = 0; k < first + kRound; ++k) {
        prune_boxes(parts[k], now.error);
        total += parts[k].size();
      }
    }
  }
  BoxTree tree;
  tree.error_ = now.error;
  tree.boxes_.reserve(total + kParts / 8);
  std::size_t next = 0;
  const auto assemble = [&](const auto& self, int depth) -> void {
    if (depth == kTaskDepth) {
      tree.boxes_.insert(tree.boxes_.end(), parts[next].begin(), parts[next].end());
      Boxes().swap(parts[next++]);
      return;
    }
    const std::size_t parent = tree.boxes_.size();
    tree.boxes_.emplace_back();
    for (std::size_t n = 0; n < kChildren; ++n) self(self, depth + 1);
    summarise(tree.boxes_, parent, depth);
  };
  assemble(assemble, 0);
  prune_boxes(tree.boxes_, now.error);
  return tree;
}

void BoxTree::prune(double error) {
  prune_boxes(boxes_, error);
  error_ = std::max(error_, error);
}

}  // namespace clothbrdf
