#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "model/fresnel.h"
#include "model/lobe.h"
#include "model/material.h"

namespace clothbrdf {

/// Most layers of a yarn.
inline constexpr int kMaxLayers = 64;

/// Reading: directionality stops changing after so many events. Without a cap, a walk through clear
/// layers has no end (model.md, section 5).
inline constexpr int kLastEvent = 1025;

// Light that leaves the top has met an odd number of events (an odd number of reflections, an even
// number of transmissions), so lobes and weights are indexed by j with E = 2 j + 1; j = 0 is the
// surface reflection.

/// Narrowing of the directionality left after the events of index j: q_E = (1 - sigma)^(E - 1), as
/// log q_E. 1 - q_E = -expm1(log q_E).
template <class T>
T log_directionality(const T& scatter, int j) {
  using std::log1p;
  return T(2 * j) * log1p(-scatter);
}

/// How many lobes j = 0..n-1 a yarn needs. The last one stands for every later event, too: none
/// follows, or the axes have stopped changing to 1e-17.
template <class T>
int lobe_count(const BasicYarn<T>& yarn, Paths paths) {
  if (yarn.layers == 0) return 1;
  if (!kCarriesDerivative<T> && yarn.scatter == T(0)) return 2;
  const int longest = paths == Paths::kAll ? kLastEvent / 2 : 2 * yarn.layers - 1;
  const T log_tiny = T(-39.2);  // log 1e-17
  int last = 1;
  while (last < longest && yarn.scatter < T(1) && log_directionality(yarn.scatter, last) > log_tiny)
    ++last;
  return last + 1;
}

/// The radius that both axes tend to. Reading (fig. 16): the wider axis, so that anisotropy goes
/// and the width stays.
template <class T>
T scatter_limit(const BasicYarn<T>& yarn) {
  if (yarn.scatter_limit) return *yarn.scatter_limit;
  return yarn.lobe_axes[0] > yarn.lobe_axes[1] ? yarn.lobe_axes[0] : yarn.lobe_axes[1];
}

/// The axes of lobe j: from the ellipse to a circle as events add up (paper, section 3.2, fig. 16).
/// The form c - (c - a) q would lose 3e-11 at a = 1e-6.
template <class T>
LobeAxes<T> lobe_axes(const BasicYarn<T>& yarn, int j) {
  using std::expm1;
  const T a = yarn.lobe_axes[0];
  const T b = yarn.lobe_axes[1];
  if (j == 0) return {a, b};
  const T c = scatter_limit(yarn);
  const T lost = yarn.scatter < T(1) ? T(-expm1(log_directionality(yarn.scatter, j))) : T(1);
  return {a + (c - a) * lost, b + (c - b) * lost};
}

/// What one passage through a yarn layer leaves: A (paper, eq. 3), and 1 - A^2 without
/// cancellation.
template <class T>
struct Passage {
  T once;
  T lost_twice;
};

/// absorption = absorbance of one layer at normal incidence, [0, 1e6]. At cos_theta_t = 0 (index 1,
/// grazing) the path is endless: nothing is left, or all of it where nothing is absorbed.
template <class T>
Passage<T> passage(const T& absorption, const T& cos_theta_t) {
  using std::exp;
  using std::expm1;
  if (cos_theta_t == T(0))
    return absorption == T(0) ? Passage<T>{T(1), T(0)} : Passage<T>{T(0), T(1)};
  const T depth = absorption / cos_theta_t;
  return {exp(-depth), -expm1(T(-2) * depth)};
}

/// Weights of eq. 4's paths, one for each layer k: in to its far side, one reflection, out. They
/// add to weights[j], E = 4 k - 1; the last weight takes all later ones.
///
/// Reading: "reflected at layer k" means at its far side.
template <class T>
void single_path_weights(int layers, const Interface<T>& interface, const T& absorption,
                         std::span<T> weights) {
  using std::exp;
  std::fill(weights.begin(), weights.end(), T(0));
  weights[0] = interface.reflected;
  if (weights.size() == 1) return;
  const T t2 = interface.transmitted * interface.transmitted;
  T crossing = interface.reflected * t2;  // r t^(4 k - 2)
  for (int k = 1; k <= layers; ++k) {
    const T depth = T(2 * k) * absorption;
    const T left = interface.cos_theta_t == T(0) ? passage(absorption, interface.cos_theta_t).once
                                                 : T(exp(-depth / interface.cos_theta_t));
    weights[std::min(static_cast<std::size_t>(2 * k - 1), weights.size() - 1)] += crossing * left;
    crossing *= t2 * t2;
  }
}

/// Light walking through a stack of yarn layers, event by event, and how much of it will still come
/// out of the top. The sums over all walks are closed and every term is positive (model.md, section
/// 5).
template <class T>
class LayerStack {
 public:
  LayerStack(int layers, const Interface<T>& interface, const T& absorption)
      : layers_(static_cast<std::size_t>(layers)),
        r_(interface.reflected),
        t_(interface.transmitted) {
    const Passage<T> yarn = passage(absorption, interface.cos_theta_t);
    passage_ = yarn.once;
    // From the bottom up: what the stack below an interface reflects, and what it keeps (1 - that).
    std::array<T, std::size_t{2} * kMaxLayers>
        reflects;  // interface i = 2 k: near side of yarn k, 2 k + 1: its far side
    std::array<T, std::size_t{2} * kMaxLayers> denominator;  // 1 - r * (what comes back from below)
    T below_reflects = T(0);
    T below_keeps = T(1);
    for (std::size_t i = 2 * layers_; i-- > 0;) {
      if (i % 2 == 0) {  // yarn below: one passage down, one up
        below_keeps = yarn.lost_twice + passage_ * passage_ * below_keeps;
        below_reflects = passage_ * passage_ * below_reflects;
      }
      denominator[i] = t_ + r_ * below_keeps;
      reflects[i] = r_ + t_ * t_ * below_reflects / denominator[i];
      below_reflects = reflects[i];
      below_keeps = t_ * below_keeps / denominator[i];
    }
    T above_escapes = T(1);  // of light about to meet the interface above from below
    for (std::size_t k = 0; k < layers_; ++k) {
      const T in_yarn = t_ * above_escapes / denominator[2 * k];
      yarn_down_escapes_[k] = reflects[2 * k + 1] * passage_ * in_yarn;
      above_escapes = t_ * passage_ * in_yarn / denominator[2 * k + 1];
      gap_up_escapes_[k + 1] = above_escapes;
    }
    for (std::size_t k = 0; k <= layers_; ++k) gap_down_[k] = gap_up_[k] = T(0);
    for (std::size_t k = 0; k < layers_; ++k) yarn_down_[k] = T(0);
    yarn_down_[0] = passage_ * t_;
  }

  /// All that will still come out.
  T remaining() const {
    T sum = T(0);
    for (std::size_t k = 0; k < layers_; ++k)
      sum += yarn_down_[k] * yarn_down_escapes_[k] + gap_up_[k + 1] * gap_up_escapes_[k + 1];
    return sum;
  }

  /// Two events on: all light meets a far side, then a near side. Returns what left through the
  /// top.
  T step() {
    const T reflected_in = passage_ * r_;
    const T passed_in = passage_ * t_;
    for (std::size_t k = 0; k < layers_; ++k) {
      yarn_up_[k] = reflected_in * yarn_down_[k] + passed_in * gap_up_[k + 1];
      gap_down_[k + 1] = t_ * yarn_down_[k] + r_ * gap_up_[k + 1];
    }
    for (std::size_t k = 0; k < layers_; ++k) {
      gap_up_[k] = r_ * gap_down_[k] + t_ * yarn_up_[k];
      yarn_down_[k] = passed_in * gap_down_[k] + reflected_in * yarn_up_[k];
    }
    return gap_up_[0];
  }

 private:
  std::size_t layers_;
  T r_;
  T t_;
  T passage_;
  // Light after an even number of events: in yarn k on its way down, in the gap above yarn k on its
  // way up; and the share of it that will come out.
  std::array<T, kMaxLayers> yarn_down_;
  std::array<T, kMaxLayers + 1> gap_up_;
  std::array<T, kMaxLayers> yarn_down_escapes_;
  std::array<T, kMaxLayers + 1> gap_up_escapes_;
  // After an odd number: in yarn k on its way up, in the gap above yarn k on its way down.
  std::array<T, kMaxLayers> yarn_up_;
  std::array<T, kMaxLayers + 1> gap_down_;
};

/// Weights of all walks; the last weight takes all later ones, summed, not walked.
template <class T>
void all_path_weights(int layers, const Interface<T>& interface, const T& absorption,
                      std::span<T> weights) {
  weights[0] = interface.reflected;
  if (weights.size() == 1) return;
  LayerStack<T> stack(layers, interface, absorption);
  for (T& weight : weights.subspan(1, weights.size() - 2)) weight = stack.step();
  weights.back() = stack.remaining();
}

/// W_E of one yarn and channel at the incidence cosine x: weights[j] is the light that leaves after
/// E = 2 j + 1 events, weights[0] the surface reflection r, the last one also all later events
/// (eqs. 2 to 4, with the layers' r and t those of the first). Size: lobe_count. The sum is at
/// most 1.
template <class T>
void path_weights(const BasicYarn<T>& yarn, Paths paths, const Interface<T>& interface,
                  const T& absorption, std::span<T> weights) {
  if (paths == Paths::kAll) {
    all_path_weights(yarn.layers, interface, absorption, weights);
  } else {
    single_path_weights(yarn.layers, interface, absorption, weights);
  }
}

}  // namespace clothbrdf
