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
    int depth = 7;          ///< cuts of an axis at most, 2^depth boxes; from 4
    double error = 0;       ///< boxes whose children are closer to their mean are not cut
    std::size_t boxes = 0;  ///< at most, but from 4369; the error grows until they suffice
  };

  /// Counts 16^depth cells into the workers' progress. The same tree for any number of threads.
  /// Memory: 40 bytes for each box allowed and 100 MB.
  static BoxTree build(const Producer& producer, const Workers& workers, const Limits& limits);

  /// Takes the children of boxes that are all within `error` of the means of theirs: relative to
  /// the largest of R, G and B.
  void prune(double error);

  const std::vector<Box>& boxes() const { return boxes_; }
  /// What was cut farther than this, is whole; no box left whole has parts farther from its mean.
  double error() const { return error_; }

 private:
  std::vector<Box> boxes_;
  double error_ = 0;
};

}  // namespace clothbrdf
