#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace clothbrdf {

/// True for automatic-differentiation scalars (a value `.a` and a derivative part `.v`, as
/// ceres::Jet has). Branches that would be right for the value but would drop a derivative ask this
/// first.
template <class T>
inline constexpr bool kCarriesDerivative = requires(T x) {
  x.a;
  x.v;
};

/// pi in the precision of T.
template <class T>
T pi() {
  if constexpr (std::is_floating_point_v<T>) {
    return std::numbers::pi_v<T>;
  } else if constexpr (kCarriesDerivative<T>) {
    return T(std::numbers::pi);
  } else {
    using std::acos;
    static const T value = acos(T(-1));
    return value;
  }
}

/// Unit roundoff of T, eps; of the value part where T carries a derivative.
template <class T>
T machine_epsilon() {
  if constexpr (kCarriesDerivative<T>) {
    return T(std::numeric_limits<decltype(T().a)>::epsilon());
  } else {
    return std::numeric_limits<T>::epsilon();
  }
}

}  // namespace clothbrdf
