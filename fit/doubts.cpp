#include "fit/doubts.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "fit/solve.h"
#include "fit/uncertainty.h"

namespace clothbrdf {
namespace {

std::string counts_of(const Material& material) {
  return std::to_string(material.warp.layers) + "/" + std::to_string(material.weft.layers);
}

}  // namespace

std::string short_text(double value) {
  std::array<char, 32> text{};
  constexpr int kDigits = 3;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, kDigits);
  return {text.data(), end.ptr};
}

std::vector<Doubt> doubts(const Misfit& misfit, const ParameterSet& set, const Material& chosen,
                          const std::vector<Material>& others, double noise) {
  std::vector<Doubt> result(set.parameters().size());
  for (const std::size_t i : set.free()) {
    const FitParameter& p = set.parameters()[i];
    const double value = parameter_value(chosen, p);
    double low = value;
    double high = value;
    for (const Material& other : others) {
      double there = parameter_value(other, p);
      if (p.column == kRotation) there = value + std::remainder(there - value, 180);
      low = std::min(low, there);
      high = std::max(high, there);
    }
    result[i].verdict = verdict_of(p, value, std::max(high - value, value - low));
    result[i].reason = "other cloths that fit as well have values from " + short_text(low) +
                       " to " + short_text(high);
  }
  for (const Material& other : others) {
    ParameterSet inner = set;
    for (const std::size_t i : held_by_bounds(misfit, set, other)) inner = inner.with_fixed(i);
    const Uncertainty found = uncertainty(misfit.triangle(other, inner), inner, other, noise);
    for (std::size_t k = 0; k < inner.free().size(); ++k) {
      const std::size_t i = inner.free()[k];
      const FitParameter& p = set.parameters()[i];
      const Verdict verdict = verdict_of(p, parameter_value(other, p), found.standard_errors[k]);
      if (verdict <= result[i].verdict) continue;
      result[i] = {verdict, "a cloth of " + counts_of(other) +
                                " layers fits as well, and it is not known there"};
    }
  }
  return result;
}

}  // namespace clothbrdf
