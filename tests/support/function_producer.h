#pragma once

#include <array>
#include <functional>
#include <span>
#include <utility>

#include "table/producer.h"

namespace clothbrdf::test {

/// Any f_r as R, G and B, for formats with nodes of their own.
class FunctionProducer final : public Producer {
 public:
  using Function = std::function<std::array<double, 3>(const Directions&)>;

  explicit FunctionProducer(Function function) : function_(std::move(function)) {}

  const TableSpec& spec() const override { return spec_; }
  void fill_rows(std::size_t /*none*/, std::span<double> /*none*/) const override {}
  void fill_pairs(std::span<const Directions> pairs, std::span<double> values) const override {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const std::array<double, 3> rgb = function_(pairs[p]);
      for (std::size_t c = 0; c < 3; ++c) values[3 * p + c] = rgb[c];
    }
  }

 private:
  Function function_;
  TableSpec spec_{AnyPairs{}, rgb_channels(), {}, {}};
};

}  // namespace clothbrdf::test
