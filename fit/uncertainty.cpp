#include "fit/uncertainty.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace clothbrdf {
namespace {

// Directions that change the table by less than this, relative to the most visible one, are
// rounding.
constexpr double kRounding = 1e-10;

// A parameter whose share in an unseen direction is above this has no standard error.
constexpr double kShareUnseen = 1e-3;

// Parts that are named.
constexpr double kNamedPart = 0.15;

constexpr double kSmallValue = 0.05;

BlindDirection describe(const Eigen::VectorXd& direction, double singular_value,
                        const ParameterSet& set) {
  BlindDirection blind;
  blind.singular_value = singular_value;
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (std::abs(direction[k]) > kNamedPart) order.push_back(k);
  }
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(direction[a]) > std::abs(direction[b]);
  });
  // The largest part goes up.
  const double sign = order.empty() || direction[order.front()] > 0 ? 1 : -1;
  for (const Eigen::Index k : order) {
    const std::string& name = set.parameters()[set.free()[static_cast<std::size_t>(k)]].name;
    const double change = sign * direction[k];
    blind.parts.push_back({name, change});
    blind.words += (blind.words.empty() ? "" : ", ") + name + (change > 0 ? " up" : " down");
  }
  return blind;
}

}  // namespace

double unit_of_change(const FitParameter& parameter, double value) {
  if (parameter.column == kRotation) return 45;
  return std::max(std::abs(value), kSmallValue);
}

Uncertainty uncertainty(const Eigen::MatrixXd& triangle, const ParameterSet& set,
                        const Material& material, double noise) {
  Uncertainty result;
  const std::size_t count = set.free().size();
  result.standard_errors.resize(count);
  if (count == 0) return result;
  const auto size = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd jacobian = triangle.leftCols(size);
  std::vector<double> units;
  for (std::size_t k = 0; k < count; ++k) {
    const FitParameter& p = set.parameters()[set.free()[k]];
    const double value = parameter_value(material, p);
    units.push_back(unit_of_change(p, value));
    jacobian.col(static_cast<Eigen::Index>(k)) *= units.back() / p.value_slope(value) / noise;
  }
  // Columns of one length first, so that a parameter of little effect is not taken for rounding.
  Eigen::VectorXd lengths = jacobian.colwise().norm();
  const double longest = lengths.maxCoeff();
  Eigen::MatrixXd even = jacobian;
  for (Eigen::Index k = 0; k < size; ++k) {
    if (lengths[k] > kRounding * kRounding * longest) even.col(k) /= lengths[k];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> even_svd(even, Eigen::ComputeThinV);
  const double top = even_svd.singularValues()[0];
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(size);
  std::vector<bool> unseen(count, false);
  for (Eigen::Index j = 0; j < size; ++j) {
    const double value = even_svd.singularValues()[j];
    for (Eigen::Index k = 0; k < size; ++k) {
      const double part = even_svd.matrixV()(k, j);
      if (value <= kRounding * top) {
        if (std::abs(part) > kShareUnseen) unseen[static_cast<std::size_t>(k)] = true;
      } else if (lengths[k] > 0) {
        variance[k] += std::pow(part / value / lengths[k], 2);
      }
    }
  }
  const double bottom = even_svd.singularValues()[size - 1];
  result.condition = bottom > kRounding * top ? top / bottom : 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double error = std::sqrt(variance[static_cast<Eigen::Index>(k)]) * units[k];
    // A number that is larger than any thinkable value says no more than none.
    constexpr double kMost = 1000;
    const bool visible = lengths[static_cast<Eigen::Index>(k)] > kRounding * kRounding * longest;
    if (!unseen[k] && visible && error <= kMost * units[k]) result.standard_errors[k] = error;
  }

  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinV);
  for (Eigen::Index j = 0; j < size; ++j) {
    const double value = svd.singularValues()[j];
    result.singular_values.push_back(std::isfinite(value) ? value : 0);
  }
  for (Eigen::Index j = size - 1; j >= 0; --j) {
    if (svd.singularValues()[j] * kIdentifiableError > 1) break;
    result.blind.push_back(
        describe(svd.matrixV().col(j), result.singular_values[static_cast<std::size_t>(j)], set));
  }
  return result;
}

Verdict verdict_of(const FitParameter& parameter, double value,
                   const std::optional<double>& standard_error) {
  if (!standard_error) return Verdict::kNotIdentifiable;
  const double share = *standard_error / unit_of_change(parameter, value);
  if (share <= kIdentifiableError) return Verdict::kIdentifiable;
  return share <= kWeakError ? Verdict::kWeak : Verdict::kNotIdentifiable;
}

std::string reason_of(const FitParameter& parameter, const std::vector<BlindDirection>& blind) {
  for (const BlindDirection& direction : blind) {
    const auto part =
        std::find_if(direction.parts.begin(), direction.parts.end(),
                     [&](const BlindDirection::Part& p) { return p.name == parameter.name; });
    if (part == direction.parts.end()) continue;
    const bool alone = direction.parts.size() == 1 || part->change * part->change > 0.95;
    if (alone) return "the table hardly changes with it";
    return "hardly changes the table together with: " + direction.words;
  }
  return "its effect can hardly be told from that of several others";
}

}  // namespace clothbrdf
