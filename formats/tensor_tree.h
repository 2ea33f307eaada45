#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/pair_mean.h"
#include "table/producer.h"

namespace clothbrdf {

// Internal to formats/.

/// The means of f_r over nested boxes of the 4-D cube: the square of the opposite of wi (axes 0 and
/// 1) times the square of wo (2 and 3), by Shirley and Chiu's map. A box is cut into 16, child n in
/// the upper half of axis k where bit k of n is set.
class BoxTree {
 public:
  /// In the order of a walk: a box, then its children's boxes.
  struct Box {
    std::array<float, 3> mean{};  ///< R, G, B
    float error = 0;              ///< how far boxes below are from the mean of theirs; see prune()
    std::uint32_t size = 1;       ///< with all boxes below it; 1 has no children
  };

  struct Limits {
    int depth = 6;        ///< cuts of an axis at most: 2^depth boxes; 4 at least
    double error = 0.02;  ///< boxes whose children are closer are not cut
    std::size_t boxes = std::size_t{1} << 22U;  ///< at most; the error grows until they suffice
  };

  /// Counts 16^depth cells into the workers' progress. 20 bytes a box; the same tree for any number
  /// of threads.
  static BoxTree build(const Producer& producer, const Workers& workers, const Limits& limits);

  /// Takes the children of boxes that are all within `error` of the means of theirs: relative to
  /// the largest of R, G and B.
  void prune(double error);

  const std::vector<Box>& boxes() const { return boxes_; }

 private:
  std::vector<Box> boxes_;
};

}  // namespace clothbrdf
