#include "fit/lobe_basis.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "model/degrees.h"
#include "model/layers.h"
#include "model/lobe.h"

namespace clothbrdf {
namespace {

using AxesJet = ceres::Jet<double, 2>;  // by the axes along, across
using FullJet = ceres::Jet<double, 3>;  // and by the rotation, radians

constexpr int kFewestNodes = 3;
constexpr int kMostNodes = 64;

// Nodes for a function whose nearest poles lie at +-i pi/2 in the logarithm of the narrow axis:
// those of tan(theta_h) / a, and of Z.
int node_count(double log_range, double tolerance) {
  if (!(log_range > 0)) return kFewestNodes;
  const double pole = pi<double>() / log_range;
  const double rate = std::log(pole + std::sqrt(1 + pole * pole));
  const double count = std::ceil(-std::log(tolerance) / rate) + 2;
  return std::clamp(static_cast<int>(std::min(count, double{kMostNodes})), kFewestNodes,
                    kMostNodes);
}

}  // namespace

LobeBasis::LobeBasis(const Yarn& yarn, Paths paths, Reflectance reflectance, double tolerance) {
  BasicYarn<AxesJet> jets;
  jets.lobe_axes = {AxesJet(yarn.lobe_axes[0], 0), AxesJet(yarn.lobe_axes[1], 1)};
  if (yarn.scatter_limit) jets.scatter_limit = AxesJet(*yarn.scatter_limit);
  const double limit = scatter_limit(yarn);
  range_ = std::log(limit / std::min(yarn.lobe_axes[0], yarn.lobe_axes[1]));
  growth_ = std::expm1(range_);

  std::vector<double> lost;
  if (yarn.layers > 0) {
    // Lobes lie from E = 3 on; to the limit, or to the last one of single paths.
    const auto lost_at = [&](int j) {
      return yarn.scatter < 1 ? -std::expm1(log_directionality(yarn.scatter, j)) : 1.0;
    };
    const auto place_of = [&](double s) {
      return range_ > 0 ? std::log1p(s * growth_) / range_ : s;
    };
    const double first = place_of(lost_at(1));
    const double last =
        paths == Paths::kAll ? 1.0 : std::max(place_of(lost_at(2 * yarn.layers - 1)), first);
    // Never a single point: the derivative by the scatter needs the slope there.
    const double low = std::min(first, 0.999);
    const double high = std::max(last, low + 1e-3);
    const int count = node_count((high - low) * range_, tolerance);
    for (int j = 0; j < count; ++j) {
      const double x = (1 - std::cos(pi<double>() * j / (count - 1))) / 2;
      place_.push_back(low + (high - low) * x);
      const double end = j == 0 || j == count - 1 ? 0.5 : 1;
      barycentric_.push_back(j % 2 == 0 ? end : -end);
      lost.push_back(range_ > 0 ? std::expm1(place_[static_cast<std::size_t>(j)] * range_) / growth_
                                : place_[static_cast<std::size_t>(j)]);
    }
  }
  const std::size_t nodes = place_.size();
  node_slopes_.assign(nodes * nodes, 0.0);
  for (std::size_t i = 0; i < nodes; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < nodes; ++j) {
      if (i == j) continue;
      const double slope = barycentric_[j] / barycentric_[i] / (place_[i] - place_[j]);
      node_slopes_[i * nodes + j] = slope;
      sum += slope;
    }
    node_slopes_[i * nodes + i] = -sum;
  }

  const AxesJet c = scatter_limit(jets);
  for (std::size_t lane = 0; lane <= nodes; ++lane) {
    const double s = lane == 0 ? 0 : lost[lane - 1];
    const AxesJet a = jets.lobe_axes[0];
    const AxesJet b = jets.lobe_axes[1];
    const LobeAxes<AxesJet> axes = {a + (c - a) * s, b + (c - b) * s};
    const AxesJet inverse =
        reflectance == Reflectance::kMicrofacet ? AxesJet(1.0) / lobe_integral(axes) : AxesJet(1.0);
    const auto dual = [](const AxesJet& x) { return Dual{x.a, x.v[0], x.v[1]}; };
    along_.push_back(dual(axes.along));
    across_.push_back(dual(axes.across));
    inverse_norm_.push_back(dual(inverse));
  }
}

void LobeBasis::shares(double lost, std::span<double> values) const {
  const double place = range_ > 0 ? std::log1p(lost * growth_) / range_ : lost;
  double sum = 0;
  for (std::size_t j = 0; j < place_.size(); ++j) {
    const double distance = place - place_[j];
    if (distance == 0) {
      std::fill(values.begin(), values.end(), 0.0);
      values[j] = 1;
      return;
    }
    values[j] = barycentric_[j] / distance;
    sum += values[j];
  }
  for (double& value : values) value /= sum;
}

double LobeBasis::lost_slope(double lost) const {
  return range_ > 0 ? growth_ / (range_ * (1 + lost * growth_)) : 1;
}

template <class Scalar>
void LobeBasis::fill(const HalfVector& half, std::size_t yarn, double rotation_deg,
                     std::span<double> values, std::size_t stride) const {
  constexpr bool kSlopes = kCarriesDerivative<Scalar>;
  const auto lift = [](const Dual& d) {
    if constexpr (kSlopes) {
      Scalar x(d.value);
      x.v[0] = d.by_along;
      x.v[1] = d.by_across;
      return x;
    } else {
      return d.value;
    }
  };
  Scalar turn(rotation_deg * (pi<double>() / 180));
  if constexpr (kSlopes) turn.v[2] = pi<double>() / 180;
  const Scalar sin_theta(half.sin_theta);
  const Scalar cos_theta(half.cos_theta);
  Scalar u(0);
  Scalar v(0);
  if (half.kind == HalfVector::Kind::kPoint) {
    // Exact reduction for the value; the derivative of the turned vector by the angle.
    const SinCos<double> exact = sincosd(rotation_deg);
    Scalar sine(exact.sin);
    Scalar cosine(exact.cos);
    if constexpr (kSlopes) {
      sine.v[2] = exact.cos * turn.v[2];
      cosine.v[2] = -exact.sin * turn.v[2];
    }
    const Scalar weft = (half.cos_phi * cosine + half.sin_phi * sine) * sin_theta;
    const Scalar warp = (half.sin_phi * cosine - half.cos_phi * sine) * sin_theta;
    u = yarn == 0 ? warp : weft;
    v = yarn == 0 ? Scalar(-weft) : warp;
  }
  for (std::size_t lane = 0; lane < lanes(); ++lane) {
    const LobeAxes<Scalar> axes = {lift(along_[lane]), lift(across_[lane])};
    Scalar height(0);
    switch (half.kind) {
      case HalfVector::Kind::kPoint: height = lobe_height(u, v, cos_theta, axes); break;
      case HalfVector::Kind::kCircle:
        height = lobe_azimuthal_mean(sin_theta, cos_theta, axes);
        break;
      case HalfVector::Kind::kArc: {
        const Scalar along = turn + Scalar(yarn == 0 ? pi<double>() / 2 : 0.0);
        height = lobe_azimuthal_mean(sin_theta, cos_theta, axes, Scalar(half.from - along),
                                     Scalar(half.to - along));
        break;
      }
    }
    const Scalar density = height * lift(inverse_norm_[lane]);
    if constexpr (kSlopes) {
      values[kValue * stride + lane] = density.a;
      values[kByAlong * stride + lane] = density.v[0];
      values[kByAcross * stride + lane] = density.v[1];
      values[kByRotation * stride + lane] = density.v[2];
    } else {
      values[lane] = density;
    }
  }
}

void LobeBasis::densities(const HalfVector& half, std::size_t yarn, double rotation_deg,
                          bool slopes, std::span<double> values, std::size_t stride) const {
  if (slopes) {
    fill<FullJet>(half, yarn, rotation_deg, values, stride);
  } else {
    fill<double>(half, yarn, rotation_deg, values, stride);
  }
}

}  // namespace clothbrdf
