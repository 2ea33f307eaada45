#include "tabulate/batch_kernel.h"

// Compiled once for each kind of vector registers. Not for these: the first two would hardly be
// faster, and the others have no size that arrays need.
#define HWY_DISABLED_TARGETS \
  (HWY_AVX3_DL | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tabulate/batch_kernel.cpp"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace clothbrdf {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kBlock = 64;  // pairs whose intermediate results stay in the nearest cache

template <class T>
struct Block {
  HWY_ALIGN T weft2[kBlock];  // the half vector's squared components
  HWY_ALIGN T warp2[kBlock];
  HWY_ALIGN T normal2[kBlock];
  HWY_ALIGN T place[kBlock];                   // in the piece, -1 to 1; of surfaces cos_theta_d
  HWY_ALIGN T factor[kBlock];                  // directional factor times h_n, 0 below the horizon
  HWY_ALIGN T above[kBlock];                   // 1, or 0 below the horizon
  HWY_ALIGN hwy::MakeUnsigned<T> row[kBlock];  // where the coefficients of its piece start
  HWY_ALIGN T sum[3][kBlock];                  // over the lanes, of the sums at work
  HWY_ALIGN T none[kBlock];                    // sums of channels without direction: 0
};

/// What the lanes of kBlock pairs share: lanes over pairs. Returns whether a pair is hard.
template <class T>
bool prepare(const BatchPlan<T>& plan, const DirectionArrays<T>& in, Block<T>& block) {
  const hn::ScalableTag<T> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::size_t n = hn::Lanes(d);
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, T(1));
  const auto half = hn::Set(d, T(0.5));
  const auto least = hn::Set(d, std::numeric_limits<T>::min());
  const auto turn_sin = hn::Set(d, plan.turn_sin);
  const auto turn_cos = hn::Set(d, plan.turn_cos);
  constexpr int kMantissa = sizeof(T) == sizeof(float) ? 23 : 52;
  const int shift = kMantissa - plan.piece_bits;
  const auto first_piece =
      hn::ShiftRightSame(hn::BitCast(du, hn::Set(d, static_cast<T>(kWeightShift))), shift);
  const auto row_size = hn::Set(du, static_cast<hwy::MakeUnsigned<T>>(plan.row_size));
  const auto mantissa = hn::Set(du, (hwy::MakeUnsigned<T>{1} << shift) - 1);
  const auto least_sum = hn::Set(d, kLeastSum<T>);
  const auto least_height = hn::Set(d, kLeastHeight<T>);
  auto hard = hn::Gt(zero, zero);
  for (std::size_t p = 0; p < kBlock; p += n) {
    const auto load = [&](const T* from) { return hn::LoadU(d, from + p); };
    const auto wi_z = load(in.wi[2]);
    const auto wo_z = load(in.wo[2]);
    const auto h_x = hn::Add(load(in.wi[0]), load(in.wo[0]));
    const auto h_y = hn::Add(load(in.wi[1]), load(in.wo[1]));
    const auto h_z = hn::Add(wi_z, wo_z);
    const auto length2 = hn::MulAdd(h_x, h_x, hn::MulAdd(h_y, h_y, hn::Mul(h_z, h_z)));
    const auto low = hn::Min(wi_z, wo_z);
    const auto high = hn::Max(wi_z, wo_z);
    const auto above = hn::And(hn::Gt(low, zero), hn::Gt(length2, zero));
    const auto largest = hn::Max(hn::Max(hn::Abs(h_x), hn::Abs(h_y)), h_z);
    const auto is_hard = hn::Or(hn::Lt(largest, least_sum), hn::Lt(low, least_height));
    hard = hn::Or(hard, hn::And(hn::Gt(low, zero), is_hard));
    const auto length = hn::Sqrt(hn::IfThenElse(above, length2, one));
    const auto inverse = hn::Div(one, length);
    const auto x = hn::Min(hn::Mul(half, length), one);
    const auto weft = hn::Mul(hn::MulAdd(h_x, turn_cos, hn::Mul(h_y, turn_sin)), inverse);
    const auto warp = hn::Mul(hn::NegMulAdd(h_x, turn_sin, hn::Mul(h_y, turn_cos)), inverse);
    const auto normal = hn::Mul(h_z, inverse);
    auto factor = normal;
    if (plan.microfacet && !plan.shadowing) {
      factor = hn::Mul(hn::Div(factor, hn::IfThenElse(above, low, one)),
                       hn::Div(hn::Set(d, T(0.25)), hn::IfThenElse(above, high, one)));
    } else if (plan.microfacet) {
      // min(1 / (2 low), h_n / x) / (2 high), model.md section 7; h_n / x = 2 h_z / length^2.
      const auto shadowed = hn::Mul(hn::Add(normal, normal), inverse);
      factor = hn::Mul(hn::Mul(factor, hn::Min(half, hn::Mul(shadowed, low))),
                       hn::Div(half, hn::Max(hn::Mul(low, high), least)));
    } else {
      factor = hn::Div(factor, hn::IfThenElse(above, wi_z, one));
    }
    hn::Store(hn::Mul(weft, weft), d, block.weft2 + p);
    hn::Store(hn::Mul(warp, warp), d, block.warp2 + p);
    // Below the horizon nothing may overflow: a factor of 0 takes it away.
    hn::Store(hn::IfThenElse(above, hn::Mul(normal, normal), one), d, block.normal2 + p);
    hn::Store(hn::IfThenElseZero(above, factor), d, block.factor + p);
    hn::Store(hn::IfThenElseZero(above, one), d, block.above + p);
    if (plan.kind != BatchSum::kTable) {
      hn::Store(hn::IfThenElse(above, x, one), d, block.place + p);
      continue;
    }
    const auto y = hn::Add(x, hn::Set(d, static_cast<T>(kWeightShift)));
    const auto bits = hn::BitCast(du, y);
    // Bits of the place in the piece, as a number from 1 to 2: exponent 0 over them.
    const auto in_piece = hn::ShiftLeftSame(hn::And(bits, mantissa), plan.piece_bits);
    const auto from_one = hn::BitCast(d, hn::Or(in_piece, hn::BitCast(du, one)));
    hn::Store(hn::MulAdd(hn::Set(d, T(2)), from_one, hn::Set(d, T(-3))), d, block.place + p);
    const auto piece = hn::Sub(hn::ShiftRightSame(bits, shift), first_piece);
    if constexpr (sizeof(T) == sizeof(float)) {
      hn::Store(hn::Mul(piece, row_size), du, block.row + p);
    } else {  // few processors multiply such integers in vectors
      hn::Store(piece, du, block.row + p);
    }
  }
  if constexpr (sizeof(T) != sizeof(float)) {
    for (hwy::MakeUnsigned<T>& row : block.row) row *= plan.row_size;
  }
  return !hn::AllFalse(d, hard);
}

/// The size of a lane's solid in the direction of the half vector: densities are 1 over it. kMean:
/// 1 over their mean over the half vector's azimuth, of its squared components across the normal
/// together.
template <bool kMean, class V>
V lane_solid(V weft, V warp, V weft2, V warp2, V normal2) {
  if constexpr (kMean) {
    const auto across2 = hn::Add(weft2, warp2);
    return hn::Sqrt(
        hn::Mul(hn::MulAdd(weft, across2, normal2), hn::MulAdd(warp, across2, normal2)));
  } else {
    return hn::MulAdd(weft, weft2, hn::MulAdd(warp, warp2, normal2));
  }
}

template <bool kMean, class D, class V>
V lane_density(D d, V weft, V warp, V weft2, V warp2, V normal2) {
  return hn::Div(hn::Set(d, static_cast<hn::TFromD<D>>(1)),
                 lane_solid<kMean>(weft, warp, weft2, warp2, normal2));
}

/// As many pairs as 128 bits hold values: what is left of their sums is added up together.
template <class T>
inline constexpr std::size_t kGroup = 16 / sizeof(T);

#if HWY_TARGET == HWY_SCALAR
template <class D, class V, class T = hn::TFromD<D>>
void store_sums(D /*one lane*/, const V (&v)[kGroup<T>], T* to) {
  for (std::size_t g = 0; g < kGroup<T>; ++g) to[g] = hn::GetLane(v[g]);
}
#else
/// Sums of the halves of two vectors' 128-bit blocks, side by side.
template <class D, class V>
V fold(D d, V a, V b) {
  return hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
}

/// The sum of each vector's lanes.
template <class D, class V, class T = hn::TFromD<D>>
void store_sums(D d, const V (&v)[kGroup<T>], T* to) {
  V folded = fold(d, v[0], v[1]);
  if constexpr (sizeof(T) == sizeof(float)) {
    const hn::RepartitionToWide<D> wide;
    const auto first = hn::BitCast(wide, folded);
    const auto second = hn::BitCast(wide, fold(d, v[2], v[3]));
    folded = hn::Add(hn::BitCast(d, hn::InterleaveLower(wide, first, second)),
                     hn::BitCast(d, hn::InterleaveUpper(wide, first, second)));
  }
  const hn::FixedTag<T, kGroup<T>> group;
  if constexpr (hn::MaxLanes(d) > kGroup<T>) {
    hn::Store(hn::Add(hn::LowerHalf(group, folded), hn::UpperHalf(group, folded)), group, to);
  } else {
    hn::Store(folded, group, to);
  }
}
#endif

/// The sums over lanes for `count` pairs and kSums sums from `first` on, by polynomials of a
/// degree: lanes over lobes, in kVectors registers (0: in as many as it takes).
template <std::size_t kSums, std::size_t kVectors, int kDegree, bool kMean, class T>
void sum_lanes(const BatchPlan<T>& plan, std::size_t first, std::size_t count, Block<T>& block) {
  // Of 256 bits at most: adding up the lanes of wider ones costs more than they save.
  const hn::CappedTag<T, 32 / sizeof(T)> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t n = hn::Lanes(d);
  constexpr std::size_t kPowers = kDegree + 1;
  const std::size_t lanes = kVectors > 0 ? kVectors * n : plan.lanes;
  const T* const first_row = plan.coefficients + first * kPowers * lanes;
  V weft[kVectors + 1];
  V warp[kVectors + 1];
  for (std::size_t v = 0; v < kVectors; ++v) {
    weft[v] = hn::Load(d, plan.weft + v * n);
    warp[v] = hn::Load(d, plan.warp + v * n);
  }
  for (std::size_t p = 0; p < count; p += kGroup<T>) {
    V sums[kSums][kGroup<T>];
    for (std::size_t g = 0; g < kGroup<T>; ++g) {
      const auto weft2 = hn::Set(d, block.weft2[p + g]);
      const auto warp2 = hn::Set(d, block.warp2[p + g]);
      const auto normal2 = hn::Set(d, block.normal2[p + g]);
      const auto place = hn::Set(d, block.place[p + g]);
      const T* const row = kDegree == 0 ? first_row : first_row + block.row[p + g];
      const auto add = [&](std::size_t lane, V density, bool is_first) {
        for (std::size_t c = 0; c < kSums; ++c) {
          const T* const power = row + c * kPowers * lanes + lane;
          auto weight = hn::Load(d, power + (kPowers - 1) * lanes);
          for (std::size_t k = kPowers - 1; k-- > 0;) {
            weight = hn::MulAdd(weight, place, hn::Load(d, power + k * lanes));
          }
          sums[c][g] =
              is_first ? hn::Mul(weight, density) : hn::MulAdd(weight, density, sums[c][g]);
        }
      };
      if constexpr (kVectors > 0) {
        for (std::size_t v = 0; v < kVectors; ++v) {
          add(v * n, lane_density<kMean>(d, weft[v], warp[v], weft2, warp2, normal2), v == 0);
        }
      } else {
        for (std::size_t c = 0; c < kSums; ++c) sums[c][g] = hn::Zero(d);
        for (std::size_t lane = 0; lane < lanes; lane += n) {
          const auto density =
              lane_density<kMean>(d, hn::Load(d, plan.weft + lane), hn::Load(d, plan.warp + lane),
                                  weft2, warp2, normal2);
          add(lane, density, false);
        }
      }
    }
    for (std::size_t c = 0; c < kSums; ++c) store_sums(d, sums[c], block.sum[c] + p);
  }
}

/// fresnel()'s r for incidence cosines x, as numerator and denominator, which take one division
/// with what they are multiplied by; m = (n - 1) (n + 1) of the refractive index n. With q = x +
/// sqrt(x^2 + m) it is m^2 (q^2 (x q - 1)^2 + (x m + q)^2) / (2 q^4 (x m + q)^2).
template <class V>
struct Quotient {
  V numerator;
  V denominator;
};
template <class D, class V>
Quotient<V> reflected(D d, V x, V m) {
  using T = hn::TFromD<D>;
  const auto q = hn::Add(hn::Sqrt(hn::MulAdd(x, x, m)), x);
  const auto a = hn::Mul(q, hn::MulSub(x, q, hn::Set(d, T(1))));
  const auto b = hn::MulAdd(x, m, q);
  const auto c = hn::Mul(hn::Mul(q, q), b);
  const auto sum = hn::MulAdd(a, a, hn::Mul(b, b));
  // With nothing to reflect, both may vanish.
  const auto least = hn::Set(d, std::numeric_limits<T>::min());
  return {hn::Mul(hn::Mul(m, m), hn::Mul(sum, hn::Set(d, T(0.5)))), hn::Max(hn::Mul(c, c), least)};
}

/// The sum over surface reflections: lanes over pairs, no table.
template <bool kMean, class T>
void sum_surfaces(const BatchPlan<T>& plan, Block<T>& block) {
  const hn::ScalableTag<T> d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t p = 0; p < kBlock; p += n) {
    const auto load = [&](const T* from) { return hn::Load(d, from + p); };
    const auto x = load(block.place);
    auto sum = hn::Zero(d);
    auto r = reflected(d, x, hn::Set(d, plan.steepness[0]));
    for (std::size_t lane = 0; lane < plan.lanes; ++lane) {
      const auto solid =
          lane_solid<kMean>(hn::Set(d, plan.weft[lane]), hn::Set(d, plan.warp[lane]),
                            load(block.weft2), load(block.warp2), load(block.normal2));
      if (lane > 0 && plan.steepness[lane] != plan.steepness[lane - 1]) {
        r = reflected(d, x, hn::Set(d, plan.steepness[lane]));
      }
      const auto weight = hn::Mul(r.numerator, hn::Set(d, plan.coefficients[lane]));
      sum = hn::Add(sum, hn::Div(weight, hn::Mul(r.denominator, solid)));
    }
    hn::Store(sum, d, block.sum[0] + p);
  }
}

template <std::size_t kSums, int kDegree, bool kMean, class T>
void sum_vectors(const BatchPlan<T>& plan, std::size_t first, std::size_t count, Block<T>& block) {
  // Doubles need more registers than there are.
  if constexpr (sizeof(T) == sizeof(float)) {
    const hn::CappedTag<T, 32 / sizeof(T)> d;
    switch (plan.lanes / hn::Lanes(d)) {
      case 1: return sum_lanes<kSums, 1, kDegree, kMean>(plan, first, count, block);
      case 2: return sum_lanes<kSums, 2, kDegree, kMean>(plan, first, count, block);
      case 3: return sum_lanes<kSums, 3, kDegree, kMean>(plan, first, count, block);
      default: break;
    }
  }
  sum_lanes<kSums, 0, kDegree, kMean>(plan, first, count, block);
}

/// Three sums from `first` on where there are as many, else one. Returns how many.
template <int kDegree, bool kMean, class T>
std::size_t sum_some_lanes(const BatchPlan<T>& plan, std::size_t first, std::size_t count,
                           Block<T>& block) {
  if (first + 3 <= plan.sums) {
    sum_vectors<3, kDegree, kMean>(plan, first, count, block);
    return 3;
  }
  sum_vectors<1, kDegree, kMean>(plan, first, count, block);
  return 1;
}

template <class T>
std::size_t sum_some(const BatchPlan<T>& plan, std::size_t first, std::size_t count,
                     Block<T>& block) {
  constexpr int kDegree = kWeightDegree<T>;
  switch (plan.kind) {
    case BatchSum::kNone: break;
    case BatchSum::kSurface:
      if (plan.mean) {
        sum_surfaces<true>(plan, block);
      } else {
        sum_surfaces<false>(plan, block);
      }
      return 1;
    case BatchSum::kFixed:
      return plan.mean ? sum_some_lanes<0, true>(plan, first, count, block)
                       : sum_some_lanes<0, false>(plan, first, count, block);
    case BatchSum::kTable:
      return plan.mean ? sum_some_lanes<kDegree, true>(plan, first, count, block)
                       : sum_some_lanes<kDegree, false>(plan, first, count, block);
  }
  return 0;
}

/// What is left to do for one channel: lanes over pairs.
template <class T>
void finish(const Block<T>& block, const T* sum, T constant, std::size_t count, T* values) {
  const hn::ScalableTag<T> d;
  const std::size_t n = hn::Lanes(d);
  const auto to_all = [&](T* to) {
    for (std::size_t p = 0; p < kBlock; p += n) {
      hn::StoreU(hn::MulAdd(hn::Load(d, block.factor + p), hn::Load(d, sum + p),
                            hn::Mul(hn::Load(d, block.above + p), hn::Set(d, constant))),
                 d, to + p);
    }
  };
  if (count == kBlock) return to_all(values);
  T rest[kBlock];
  to_all(rest);
  std::copy_n(rest, count, values);
}

/// Constants where both directions are above the horizon, 0 elsewhere, of kOutputs channels: lanes
/// over pairs.
template <std::size_t kOutputs, class T>
void fill_constants(const BatchOutput<T>* outputs, const DirectionArrays<T>& in, T* const* values) {
  const hn::ScalableTag<T> d;
  const std::size_t n = hn::Lanes(d);
  const T* const wi_z = in.wi[2];
  const T* const wo_z = in.wo[2];
  T* to[kOutputs];
  hn::Vec<decltype(d)> constant[kOutputs];
  for (std::size_t k = 0; k < kOutputs; ++k) {
    to[k] = values[outputs[k].channel];
    constant[k] = hn::Set(d, outputs[k].constant);
  }
  const std::size_t whole = in.count - in.count % n;
  for (std::size_t p = 0; p < whole; p += n) {
    const auto low = hn::Min(hn::LoadU(d, wi_z + p), hn::LoadU(d, wo_z + p));
    const auto visible = hn::Gt(low, hn::Zero(d));
    for (std::size_t k = 0; k < kOutputs; ++k) {
      hn::StoreU(hn::IfThenElseZero(visible, constant[k]), d, to[k] + p);
    }
  }
  for (std::size_t p = whole; p < in.count; ++p) {
    const bool visible = wi_z[p] > T(0) && wo_z[p] > T(0);
    for (std::size_t k = 0; k < kOutputs; ++k) to[k][p] = visible ? outputs[k].constant : T(0);
  }
}

template <class T>
void fill_constants(const BatchPlan<T>& plan, const DirectionArrays<T>& in, T* const* values) {
  std::size_t k = 0;
  for (; k + 3 <= plan.outputs.size(); k += 3) fill_constants<3>(&plan.outputs[k], in, values);
  for (; k < plan.outputs.size(); ++k) fill_constants<1>(&plan.outputs[k], in, values);
}

/// The pairs from `first` on, kBlock of them; after the last one directions on the horizon.
template <class T>
class Window {
 public:
  DirectionArrays<T> at(const DirectionArrays<T>& in, std::size_t first) {
    DirectionArrays<T> block{{}, {}, std::min(kBlock, in.count - first)};
    for (std::size_t k = 0; k < 3; ++k) {
      block.wi[k] = array(in.wi[k] + first, block.count, rest_[k]);
      block.wo[k] = array(in.wo[k] + first, block.count, rest_[3 + k]);
    }
    return block;
  }

 private:
  const T* array(const T* from, std::size_t count, T* rest) {
    if (count == kBlock) return from;
    std::fill_n(std::copy_n(from, count, rest), kBlock - count, T(0));
    return rest;
  }

  T rest_[6][kBlock];
};

template <class T>
bool run(const BatchPlan<T>& plan, const DirectionArrays<T>& in, T* const* values) {
  if (plan.kind == BatchSum::kNone) {
    fill_constants(plan, in, values);
    return false;
  }
  bool hard = false;
  Block<T> block{};
  Window<T> window;
  for (std::size_t first = 0; first < in.count; first += kBlock) {
    const DirectionArrays<T> now = window.at(in, first);
    hard |= prepare(plan, now, block);
    auto output = plan.outputs.begin();
    const auto write = [&](const T* sum) {
      finish(block, sum, output->constant, now.count, values[output->channel] + first);
      ++output;
    };
    while (output != plan.outputs.end() && !output->directional) write(block.none);
    for (std::size_t sum = 0; sum < plan.sums;) {
      const std::size_t count = sum_some(plan, sum, now.count, block);
      while (output != plan.outputs.end() && output->sum < sum + count) {
        write(block.sum[output->sum - sum]);
      }
      sum += count;
    }
  }
  return hard;
}

bool run_float(const BatchPlan<float>& plan, const DirectionArrays<float>& in,
               float* const* values) {
  return run(plan, in, values);
}
bool run_double(const BatchPlan<double>& plan, const DirectionArrays<double>& in,
                double* const* values) {
  return run(plan, in, values);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace clothbrdf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clothbrdf {
namespace {

std::vector<BatchTarget> supported_targets() {
  std::vector<BatchTarget> targets;
#if HWY_TARGETS & HWY_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2")) {
    targets.push_back({"AVX2", N_AVX2::run_float, N_AVX2::run_double});
  }
#endif
#if HWY_TARGETS & HWY_AVX3
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    targets.push_back({"AVX-512", N_AVX3::run_float, N_AVX3::run_double});
  }
#endif
#if HWY_TARGETS & HWY_SSE4
  if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("aes") &&
      __builtin_cpu_supports("pclmul")) {
    targets.push_back({"SSE4", N_SSE4::run_float, N_SSE4::run_double});
  }
#endif
  targets.push_back({"baseline", HWY_STATIC_DISPATCH(run_float), HWY_STATIC_DISPATCH(run_double)});
  return targets;
}

}  // namespace

std::span<const BatchTarget> batch_targets() {
  static const std::vector<BatchTarget> kTargets = supported_targets();
  return kTargets;
}

}  // namespace clothbrdf
#endif
