#include "bench/peak.h"

// These have no size that arrays need.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/peak.cpp"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace clothbrdf {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kChains = 12;  // enough to hide the latency of one

float Loop(std::size_t steps) {
  const hn::ScalableTag<float> d;
  const auto a = hn::Set(d, 0.999F);
  const auto b = hn::Set(d, 0.001F);
  hn::Vec<decltype(d)> x[kChains];
  for (std::size_t k = 0; k < kChains; ++k) x[k] = hn::Set(d, static_cast<float>(k));
  for (std::size_t s = 0; s < steps; ++s) {
    for (auto& chain : x) chain = hn::MulAdd(chain, a, b);
  }
  auto sum = x[0];
  for (std::size_t k = 1; k < kChains; ++k) sum = hn::Add(sum, x[k]);
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

std::size_t Lanes() { return hn::Lanes(hn::ScalableTag<float>()) * kChains; }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace clothbrdf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clothbrdf {

HWY_EXPORT(Loop);
HWY_EXPORT(Lanes);

float multiply_add_loop(std::size_t steps) { return HWY_DYNAMIC_DISPATCH(Loop)(steps); }

std::size_t multiply_adds_a_step() { return HWY_DYNAMIC_DISPATCH(Lanes)(); }

}  // namespace clothbrdf
#endif
