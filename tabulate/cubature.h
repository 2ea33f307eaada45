#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace clothbrdf {

/// A box of four variables.
struct Box4 {
  std::array<double, 4> low;
  std::array<double, 4> high;
};

/// Writes the values of several functions at many points, values[point][function].
using Point4 = std::array<double, 4>;
using Integrand4 = std::function<void(std::span<const Point4> points, std::span<double> values)>;

/// The variable along which a part must be halved before its rule can be trusted; none where it
/// can.
using CoarseVariable = std::function<std::optional<std::size_t>(const Box4& part)>;

/// Integrals of `count` positive functions over a box, each to a relative tolerance: adaptive
/// cubature that halves the worst part along its roughest variable, with the rule of degree 7 and
/// its companion of degree 5 by Genz and Malik (1980). None where that takes more than kMostParts
/// parts.
std::optional<std::vector<double>> integrate4(const Integrand4& integrand, const Box4& box,
                                              std::size_t count, double tolerance,
                                              const CoarseVariable& coarse);

inline constexpr std::size_t kMostParts = 200000;

}  // namespace clothbrdf
