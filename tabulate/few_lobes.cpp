#include "tabulate/few_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace clothbrdf {
namespace {

/// Squared components of a half vector, along the yarn, across it and along the normal.
struct HalfVector {
  double along;
  double across;
  double normal;
};

// Where densities of different lobes differ most: from well inside the narrowest lobe to the
// horizon, in even steps of log tan theta_h, over a quarter of the azimuths.
std::vector<HalfVector> test_half_vectors(double narrowest) {
  constexpr int kTilts = 40;
  constexpr int kAzimuths = 7;
  const double lowest = std::log(narrowest / 10);
  const double highest = std::log(1e4);
  std::vector<HalfVector> all;
  for (int t = 0; t < kTilts; ++t) {
    const double tangent = std::exp(lowest + (highest - lowest) * t / (kTilts - 1));
    const double n = 1 / (1 + tangent * tangent);
    for (int p = 0; p < kAzimuths; ++p) {
      const double cosine = std::cos(pi<double>() / 2 * p / (kAzimuths - 1));
      const double along = cosine * cosine;
      all.push_back({tangent * tangent * n * along, tangent * tangent * n * (1 - along), n});
    }
  }
  return all;
}

// lobe_height over h_n and the norm.
double density(const Lobe<double>& lobe, const HalfVector& h) {
  const double a = lobe.axes.along;
  const double b = lobe.axes.across;
  return 1 / ((h.along / (a * a) + h.across / (b * b) + h.normal) * lobe.norm);
}

// Barycentric weights of Lagrange's formula at Chebyshev-Lobatto points on [0, 1], descending.
std::vector<double> lagrange(std::span<const double> points, double at) {
  std::vector<double> weights(points.size(), 0.0);
  const auto exact = std::find(points.begin(), points.end(), at);
  if (exact != points.end()) {
    weights[static_cast<std::size_t>(exact - points.begin())] = 1;
    return weights;
  }
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const bool end = k == 0 || k + 1 == points.size();
    weights[k] = (k % 2 == 0 ? 1 : -1) * (end ? 0.5 : 1.0) / (at - points[k]);
    sum += weights[k];
  }
  for (double& w : weights) w /= sum;
  return weights;
}

class Collapser {
 public:
  Collapser(const PreparedYarn<double>& yarn, Reflectance reflectance)
      : microfacet_(reflectance == Reflectance::kMicrofacet) {
    const LobeAxes<double>& first = yarn.lobes[1].axes;
    const LobeAxes<double>& last = yarn.lobes.back().axes;
    const bool along_narrow = first.along <= first.across;
    narrow_ = along_narrow ? &LobeAxes<double>::along : &LobeAxes<double>::across;
    wide_ = along_narrow ? &LobeAxes<double>::across : &LobeAxes<double>::along;
    first_ = first;
    last_ = last;
    range_ = std::log(last.*narrow_ / first.*narrow_);
    half_vectors_ = test_half_vectors(first.*narrow_);
    // Errors change smoothly along the way: lobes that lie close together tell nothing new.
    constexpr double kStep = 1.0 / 60;
    double next = 0;
    for (std::size_t j = 1; j < yarn.lobes.size(); ++j) {
      at_.push_back(
          std::clamp(std::log(yarn.lobes[j].axes.*narrow_ / first.*narrow_) / range_, 0.0, 1.0));
      if (at_.back() < next && j + 1 < yarn.lobes.size()) continue;
      next = at_.back() + kStep;
      tested_.push_back(j);
      for (const HalfVector& h : half_vectors_) exact_.push_back(density(yarn.lobes[j], h));
    }
  }

  FewLobes collapse(std::size_t count) const {
    FewLobes few;
    std::vector<double> points;
    for (std::size_t k = 0; k < count; ++k) {
      const double turn =
          static_cast<double>(k) / static_cast<double>(std::max<std::size_t>(count - 1, 1));
      points.push_back((1 - std::cos(pi<double>() * turn)) / 2);
      few.lobes.push_back(lobe_at(points.back()));
    }
    std::vector<double> densities;  // [k][h]
    for (const Lobe<double>& lobe : few.lobes) {
      for (const HalfVector& h : half_vectors_) densities.push_back(density(lobe, h));
    }
    for (const double at : at_) {
      const std::vector<double> shares = lagrange(points, at);
      few.shares.insert(few.shares.end(), shares.begin(), shares.end());
    }
    const std::size_t tests = half_vectors_.size();
    for (std::size_t t = 0; t < tested_.size(); ++t) {
      const double* const shares = few.shares.data() + (tested_[t] - 1) * count;
      for (std::size_t h = 0; h < tests; ++h) {
        double sum = 0;
        for (std::size_t k = 0; k < count; ++k) sum += shares[k] * densities[k * tests + h];
        few.error = std::max(few.error, std::abs(sum / exact_[t * tests + h] - 1));
      }
    }
    return few;
  }

 private:
  // The lobe whose narrower axis is at a share of the way, in its logarithm; the wider one is as
  // far on its own way as the narrower on its.
  Lobe<double> lobe_at(double share) const {
    LobeAxes<double> axes = first_;
    const double lost = std::expm1(share * range_) / std::expm1(range_);
    axes.*narrow_ = share == 1 ? last_.*narrow_ : first_.*narrow_ * std::exp(share * range_);
    axes.*wide_ = first_.*wide_ + (last_.*wide_ - first_.*wide_) * lost;
    return {axes, microfacet_ ? lobe_integral(axes) : 1};
  }

  bool microfacet_;
  double LobeAxes<double>::*narrow_;
  double LobeAxes<double>::*wide_;
  LobeAxes<double> first_;
  LobeAxes<double> last_;
  double range_;
  std::vector<HalfVector> half_vectors_;
  std::vector<double> at_;           // [j - 1], share of the way from the first lobe to the last
  std::vector<std::size_t> tested_;  // some of the j
  std::vector<double> exact_;        // [tested][h]
};

// Of a yarn whose internal lobes are all the same.
FewLobes one(const PreparedYarn<double>& yarn) {
  return {{yarn.lobes[1]}, std::vector<double>(yarn.lobes.size() - 1, 1.0), 0};
}

FewLobes kept(const PreparedYarn<double>& yarn) {
  FewLobes few;
  few.lobes.assign(yarn.lobes.begin() + 1, yarn.lobes.end());
  few.shares.assign(few.lobes.size() * few.lobes.size(), 0.0);
  for (std::size_t k = 0; k < few.lobes.size(); ++k) few.shares[k * few.lobes.size() + k] = 1;
  return few;
}

}  // namespace

void FewLobes::collapse(std::span<const double> weights, std::span<double> few) const {
  std::fill(few.begin(), few.end(), 0.0);
  for (std::size_t j = 0; j < weights.size(); ++j) {
    for (std::size_t k = 0; k < few.size(); ++k) few[k] += weights[j] * shares[j * few.size() + k];
  }
}

FewLobes few_lobes(const PreparedYarn<double>& yarn, Reflectance reflectance, double tolerance) {
  constexpr std::size_t kFewest = 3;
  if (yarn.lobes.size() <= 1 + kFewest) return kept(yarn);
  const LobeAxes<double>& first = yarn.lobes[1].axes;
  const LobeAxes<double>& last = yarn.lobes.back().axes;
  if (first.along == last.along && first.across == last.across) return one(yarn);
  const Collapser collapser(yarn, reflectance);
  const std::size_t most = std::min(kMostFewLobes, yarn.lobes.size() - 1);
  FewLobes few;
  for (std::size_t count = kFewest; count <= most; ++count) {
    few = collapser.collapse(count);
    if (few.error <= tolerance) return few;
  }
  return most == yarn.lobes.size() - 1 ? kept(yarn) : few;
}

}  // namespace clothbrdf
