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
///
/// The error of a box is how far one of its children is from its mean, relative to the mean's
/// largest channel, times the box's width: of two boxes that differ by as much inside, the wider
/// counts for more. (Without the width a silk's median and 99 % errors in 32 MB are 6.1 % and 26 %,
/// with it 2.2 % and 16 %.)
class BoxTree {
 public:
  /// In the order of a walk: a box, then its children's boxes.
  struct Box {
    std::array<float, 3> mean{};  ///< R, G, B
    float error = 0;              ///< the largest of it and all boxes below
    std::uint32_t size = 1;       ///< with all boxes below it; 1 has no children
  };

  struct Limits {
    int depth = 7;          ///< cuts of an axis at most, 2^depth boxes; from 4
    double error = 0;       ///< boxes of no more are not cut
    std::size_t boxes = 0;  ///< at most, but from 4369; the error grows until they suffice
  };

  /// Counts 16^depth cells into the workers' progress. The same tree for any number of threads.
  /// Memory: 40 bytes for each box allowed and 40 MB.
  static BoxTree build(const Producer& producer, const Workers& workers, const Limits& limits);

  /// Takes the children of boxes whose error is no more.
  void prune(double error);

  const std::vector<Box>& boxes() const { return boxes_; }
  /// No box has children but those of a larger error.
  double error() const { return error_; }

 private:
  std::vector<Box> boxes_;
  double error_ = 0;
};

}  // namespace clothbrdf
