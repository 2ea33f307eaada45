#include "tabulate/pair_evaluator.h"

#include <algorithm>

namespace clothbrdf {
namespace {

// Few enough that both layouts of a block stay in the processor's first cache.
constexpr std::size_t kPairsOfBlock = 256;

template <class T>
void fill_with(const BatchEvaluator<T>& evaluator, std::size_t channels,
               std::span<const Directions> pairs, std::span<double> values) {
  const std::size_t block = std::min(kPairsOfBlock, pairs.size());
  std::vector<T> arrays((6 + channels) * block);
  const auto array = [&](std::size_t k) { return arrays.data() + k * block; };
  std::vector<T*> to;
  for (std::size_t c = 0; c < channels; ++c) to.push_back(array(6 + c));
  for (std::size_t first = 0; first < pairs.size(); first += block) {
    const std::size_t count = std::min(block, pairs.size() - first);
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t k = 0; k < 3; ++k) {
        array(k)[p] = static_cast<T>(pairs[first + p].wi[k]);
        array(3 + k)[p] = static_cast<T>(pairs[first + p].wo[k]);
      }
    }
    evaluator.evaluate({{array(0), array(1), array(2)}, {array(3), array(4), array(5)}, count}, to);
    double* next = values.data() + first * channels;
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t c = 0; c < channels; ++c) *next++ = double{to[c][p]};
    }
  }
}

}  // namespace

PairEvaluator::PairEvaluator(const TableSpec& spec, const ClothModel<double>& model,
                             Precision precision, Workers workers)
    : channels_(spec.channels.size()) {
  if (spec.isotropic()) {
    mean_.emplace(model, spec.channels, workers);
  } else if (precision == Precision::kSingle && floats_do(model)) {
    single_.emplace(model, spec.channels, workers);
  } else {
    double_.emplace(model, spec.channels, workers);
  }
}

void PairEvaluator::fill(std::span<const Directions> pairs, std::span<double> values) const {
  if (mean_) {
    mean_->fill(pairs, values);
  } else if (single_) {
    fill_with(*single_, channels_, pairs, values);
  } else {
    fill_with(*double_, channels_, pairs, values);
  }
}

}  // namespace clothbrdf
