#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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

/// Which walks through the layers count. Walks have one reflection, at the far side of a layer or
/// at the near side of a deeper one, or three and more: interreflections.
struct PathSet {
  static constexpr int kAnyEvents = std::numeric_limits<int>::max();

  bool near_sides = true;        ///< those of one reflection, at a near side
  int most_events = kAnyEvents;  ///< of interreflections; 0: none of them

  PathSet() = default;
  /// Eq. 4's single paths are those of one reflection at a far side.
  PathSet(Paths paths) {  // NOLINT(google-explicit-constructor): a name for one of the sets
    if (paths == Paths::kSingle) *this = PathSet(false, 0);
  }
  PathSet(bool with_near_sides, int most) : near_sides(with_near_sides), most_events(most) {}

  bool all() const { return near_sides && most_events == kAnyEvents; }
  bool operator==(const PathSet&) const = default;
};

/// Events of the shortest interreflection: in, far side, near side, far side, out.
inline constexpr int kFewestInterreflectionEvents = 5;

// Light that leaves the top has met an odd number of events (an odd number of reflections, an even
// number of transmissions), so lobes and weights are indexed by j with E = 2 j + 1; j = 0 is the
// surface reflection.

/// Narrowing of the directionality left after the events of index j: q_E = (1 - sigma)^(E - 1), as
/// log q_E. 1 - q_E = -expm1(log q_E). Error: 2 eps.
template <class T>
T log_directionality(const T& scatter, int j) {
  using std::log1p;
  return T(2 * j) * log1p(-scatter);
}

/// How many lobes j = 0..n-1 a yarn needs. The last one stands for every later event, too: none
/// follows, or the axes have stopped changing to 1e-17.
template <class T>
int lobe_count(const BasicYarn<T>& yarn, const PathSet& paths) {
  if (yarn.layers == 0) return 1;
  if (!kCarriesDerivative<T> && yarn.scatter == T(0)) return 2;
  const int longest =
      std::max(2 * yarn.layers - 1, (std::min(paths.most_events, kLastEvent) - 1) / 2);
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
/// The form c - (c - a) q would lose 3e-11 at a = 1e-6. Error: 4 eps.
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
/// grazing) the path is endless: nothing is left, or all of it where nothing is absorbed. Error: 2
/// eps times the condition number.
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

/// Adds the paths of one reflection at the near side of a deeper layer, E = 4 k - 3 for k = 2..N.
template <class T>
void add_near_sides(int layers, const Interface<T>& interface, const T& absorption,
                    std::span<T> weights) {
  using std::exp;
  const T t4 =
      interface.transmitted * interface.transmitted * interface.transmitted * interface.transmitted;
  T crossing = interface.reflected;  // r t^(4 k - 4)
  for (int k = 2; k <= layers; ++k) {
    crossing *= t4;
    const T depth = T(2 * (k - 1)) * absorption;
    const T left = interface.cos_theta_t == T(0) ? passage(absorption, interface.cos_theta_t).once
                                                 : T(exp(-depth / interface.cos_theta_t));
    weights[std::min(static_cast<std::size_t>(2 * k - 2), weights.size() - 1)] += crossing * left;
  }
}

/// The walks of three and more reflections, event by event. Light is told apart by how often it was
/// reflected: never (a beam going down), once (going up), or more. Every sum has positive terms
/// only, also the closed one of all that is still to come.
///
/// Medium i (1 to 2 N) lies above interface i and below interface i - 1, interfaces numbered from
/// 0; it is yarn where i is odd.
template <class T>
class InterreflectionWalk {
 public:
  InterreflectionWalk(int layers, const Interface<T>& interface, const T& absorption)
      : media_(2 * static_cast<std::size_t>(layers)),
        r_(interface.reflected),
        t_(interface.transmitted),
        yarn_(passage(absorption, interface.cos_theta_t)),
        beam_(t_ * yarn_.once) {
    for (State& state : states_) {
      for (std::size_t i = 0; i <= media_ + 1; ++i) {
        state.once_up[i] = state.down[i] = state.up[i] = T(0);
      }
    }
  }

  /// One event on. Returns what left through the top.
  T step() {
    const State& now = states_[current_];
    State& next = states_[1 - current_];
    // Below the last interface nothing is reflected: next stays 0 from media_ on.
    for (std::size_t i = 1; i < media_; ++i) {
      const T met = i == beam_at_ ? beam_ : T(0);
      next.once_up[i] = through(i) * (r_ * met + t_ * now.once_up[i + 1]);
      next.down[i] = through(i) * (t_ * now.down[i - 1] + r_ * (now.up[i] + now.once_up[i]));
      next.up[i] = through(i) * (r_ * now.down[i] + t_ * now.up[i + 1]);
    }
    ++beam_at_;
    beam_ *= t_ * through(beam_at_);
    current_ = 1 - current_;
    return t_ * now.up[1];
  }

  /// All that will still come out.
  T remaining() const {
    const State& now = states_[current_];
    std::array<T, kSize> reflects;  // of the stack from interface i on: all walks
    std::array<T, kSize> at_once;   // those of one reflection
    std::array<T, kSize> later;     // the others
    std::array<T, kSize> returns;   // of what interface i sends down, what comes back to it
    std::array<T, kSize> keeps;     // 1 - that
    reflects[media_] = at_once[media_] = later[media_] = T(0);
    T below_keeps = T(1);
    for (std::size_t i = media_; i-- > 0;) {
      const bool yarn_below = i % 2 == 0;
      const T twice = yarn_below ? T(yarn_.once * yarn_.once) : T(1);
      if (yarn_below) below_keeps = yarn_.lost_twice + twice * below_keeps;
      returns[i] = r_ * twice * reflects[i + 1];
      keeps[i] = t_ + r_ * below_keeps;
      const T crossing = t_ * t_ * twice;
      reflects[i] = r_ + crossing * reflects[i + 1] / keeps[i];
      at_once[i] = r_ + crossing * at_once[i + 1];
      later[i] = crossing * (later[i + 1] + at_once[i + 1] * returns[i]) / keeps[i];
      below_keeps = t_ * below_keeps / keeps[i];
    }
    T sum = T(0);
    T escapes = T(1);          // of light on its way up in the medium above: all walks
    T escapes_at_once = T(1);  // without another reflection
    T escapes_later = T(0);    // with some
    for (std::size_t i = 1; i < media_; ++i) {
      const T crossing = t_ * (i > 1 ? through(i - 1) : T(1));
      escapes_later = crossing * (escapes_later + escapes_at_once * returns[i - 1]) / keeps[i - 1];
      escapes = crossing * escapes / keeps[i - 1];
      escapes_at_once = crossing * escapes_at_once;
      sum += now.up[i] * escapes + now.once_up[i] * escapes_later +
             now.down[i] * reflects[i] * through(i) * escapes;
      if (i == beam_at_) {
        sum += beam_ * through(i) * (later[i] * escapes + at_once[i] * escapes_later);
      }
    }
    return sum;
  }

 private:
  static constexpr std::size_t kSize = std::size_t{2} * kMaxLayers + 2;

  // Light after some events, in each medium about to meet the next interface.
  struct State {
    std::array<T, kSize> once_up;  // reflected once
    std::array<T, kSize> down;     // more often
    std::array<T, kSize> up;
  };

  T through(std::size_t medium) const { return medium % 2 == 1 ? yarn_.once : T(1); }

  std::size_t media_;
  T r_;
  T t_;
  Passage<T> yarn_;
  T beam_;  // never reflected
  std::size_t beam_at_ = 1;
  std::array<State, 2> states_;
  std::size_t current_ = 0;
};

/// Adds the walks of three and more reflections and at most `most_events` events.
template <class T>
void add_interreflections(int layers, const Interface<T>& interface, const T& absorption,
                          int most_events, std::span<T> weights) {
  if (layers == 0) return;
  InterreflectionWalk<T> walk(layers, interface, absorption);
  const std::size_t last = weights.size() - 1;
  for (int events = 2; events <= most_events; ++events) {
    const auto j = static_cast<std::size_t>(events - 1) / 2;
    if (most_events == PathSet::kAnyEvents && j == last) {
      weights[last] += walk.remaining();
      return;
    }
    weights[std::min(j, last)] += walk.step();
  }
}

/// W_E of one yarn and channel at the incidence cosine x: weights[j] is the light that leaves after
/// E = 2 j + 1 events, weights[0] the surface reflection r, the last one also all later events
/// (eqs. 2 to 4, with the layers' r and t those of the first). Size: lobe_count. The sum is at
/// most 1. Error: 450 eps (1e-13) times the condition number, in clear layers up to 64; 12 eps in
/// the first three events.
template <class T>
void path_weights(const BasicYarn<T>& yarn, const PathSet& paths, const Interface<T>& interface,
                  const T& absorption, std::span<T> weights) {
  if (paths.all()) {
    all_path_weights(yarn.layers, interface, absorption, weights);
    return;
  }
  single_path_weights(yarn.layers, interface, absorption, weights);
  if (weights.size() == 1) return;
  if (paths.near_sides) add_near_sides(yarn.layers, interface, absorption, weights);
  if (paths.most_events > 0) {
    add_interreflections(yarn.layers, interface, absorption, paths.most_events, weights);
  }
}

}  // namespace clothbrdf
