#include "scene/maximum.h"

#include <algorithm>
#include <cmath>

namespace clothbrdf {
namespace {

struct BoundedBox {
  double high;
  LitBox lit;

  bool operator<(const BoundedBox& other) const { return high < other.high; }
};

// Azimuths count by how far they move a direction.
std::size_t widest_dimension(const AngleBox& box) {
  const auto& a = box.angles;
  const std::array<double, 4> extents = {a[0].width(), a[1].width() * std::sin(a[0].high),
                                         a[2].width(), a[3].width() * std::sin(a[2].high)};
  return static_cast<std::size_t>(std::max_element(extents.begin(), extents.end()) -
                                  extents.begin());
}

// Too narrow for halves.
bool is_point(const AngleBox& box) {
  constexpr double kNarrowest = 1e-9;
  return box.angles[widest_dimension(box)].width() < kNarrowest;
}

}  // namespace

Maximum maximum(const BoxBounds& bounds, std::span<const LitBox> boxes, const Enough& enough,
                const Workers& workers) {
  std::vector<BoundedBox> heap;
  double low = enough.reached;
  double settled = 0;  // the largest upper bound of boxes that are points
  const auto add = [&](const LitBox& lit, double at_most) {
    const Interval value = bounds(lit);
    low = std::max(low, value.low);
    heap.push_back({std::min(value.high, at_most), lit});
    std::push_heap(heap.begin(), heap.end());
  };
  for (const LitBox& lit : boxes) add(lit, 1e300);
  std::size_t count = boxes.size();
  const auto high = [&] { return std::max(settled, heap.empty() ? 0 : heap.front().high); };
  while (!heap.empty() && count < enough.most_boxes) {
    if (high() <= std::max(enough.ratio * low, enough.negligible) || low > enough.too_much) break;
    workers.check();
    std::pop_heap(heap.begin(), heap.end());
    const BoundedBox top = heap.back();
    heap.pop_back();
    if (is_point(top.lit.box)) {
      settled = std::max(settled, top.high);
      continue;
    }
    const auto [first, second] = top.lit.box.halves(widest_dimension(top.lit.box));
    add({first, top.lit.radiance}, top.high);
    add({second, top.lit.radiance}, top.high);
    count += 2;
  }
  Maximum found{{std::min(low, high()), high()}, {}};
  std::sort_heap(heap.begin(), heap.end());
  constexpr std::size_t kBest = 8;
  for (std::size_t k = 0; k < std::min(kBest, heap.size()); ++k) {
    const BoundedBox& candidate = heap[heap.size() - 1 - k];
    found.best.push_back({candidate.high, candidate.lit});
  }
  return found;
}

}  // namespace clothbrdf
