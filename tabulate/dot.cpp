#include "tabulate/dot.h"

#include "tabulate/vectorise.h"

namespace clothbrdf {

CLOTHBRDF_VECTORISE double dot(const double* a, const double* b, std::size_t count) {
  constexpr std::size_t kLanes = 16;
  double lanes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += a[i + l] * b[i + l];
  }
  double sum = 0;
  for (; i < count; ++i) sum += a[i] * b[i];
  for (const double lane : lanes) sum += lane;
  return sum;
}

}  // namespace clothbrdf
