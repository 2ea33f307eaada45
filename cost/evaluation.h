#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "cost/timing.h"
#include "support/threads.h"
#include "tabulate/batch.h"

namespace clothbrdf {

/// Values at sampled pairs from a BatchEvaluator, and the time of that.
template <class T>
class Evaluation {
 public:
  Evaluation(std::span<const Directions> pairs, std::size_t channels)
      : count_(pairs.size()), channels_(channels) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Directions& pair : pairs) {
        in_[k].push_back(static_cast<T>(pair.wi[k]));
        in_[3 + k].push_back(static_cast<T>(pair.wo[k]));
      }
    }
  }

  /// [pair][channel]
  std::vector<double> values(const BatchEvaluator<T>& evaluator, const Workers& workers) const {
    std::vector<double> all(count_ * channels_);
    const std::size_t blocks = (count_ + kBlock - 1) / kBlock;
    with_threads(workers.threads, [&] {
      run_parallel(blocks, workers, [&](std::size_t block) {
        workers.check();
        const std::size_t first = block * kBlock;
        const std::vector<T> values = values_of(evaluator, first);
        const std::size_t pairs = pairs_from(first);
        for (std::size_t p = 0; p < pairs; ++p) {
          for (std::size_t c = 0; c < channels_; ++c)
            all[(first + p) * channels_ + c] = double{values[c * kBlock + p]};
        }
      });
    });
    return all;
  }

  Timing time(const BatchEvaluator<T>& evaluator, int repeats, const Workers& workers) const {
    return time_million_pairs(repeats, pairs_from(0), workers, [&] { values_of(evaluator, 0); });
  }

 private:
  // Few enough that what is read and written stays in the processor's caches.
  static constexpr std::size_t kBlock = 1024;

  std::size_t pairs_from(std::size_t first) const { return std::min(kBlock, count_ - first); }

  /// [channel][pair of the block]
  std::vector<T> values_of(const BatchEvaluator<T>& evaluator, std::size_t first) const {
    std::vector<T> values(channels_ * kBlock);
    std::vector<T*> to;
    for (std::size_t c = 0; c < channels_; ++c) to.push_back(values.data() + c * kBlock);
    const auto from = [&](std::size_t k) { return in_[k].data() + first; };
    evaluator.evaluate(
        {{from(0), from(1), from(2)}, {from(3), from(4), from(5)}, pairs_from(first)}, to);
    return values;
  }

  std::size_t count_;
  std::size_t channels_;
  std::array<std::vector<T>, 6> in_;  // coordinates of wi, of wo
};

}  // namespace clothbrdf
