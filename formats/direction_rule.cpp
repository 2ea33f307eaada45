#include "formats/direction_rule.h"

#include <numeric>
#include <stdexcept>

namespace clothbrdf {
namespace {

// (1 + x) / 2 and w / 2 of Abramowitz and Stegun, table 25.4.
constexpr double kNodes2[] = {0.21132486540518711775, 0.78867513459481288225};
constexpr double kWeights2[] = {0.5, 0.5};
constexpr double kNodes3[] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
constexpr double kWeights3[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
constexpr double kNodes4[] = {0.06943184420297371239, 0.33000947820757186760,
                              0.66999052179242813240, 0.93056815579702628761};
constexpr double kWeights4[] = {0.17392742256872692869, 0.32607257743127307131,
                                0.32607257743127307131, 0.17392742256872692869};

}  // namespace

void DirectionRule::normalise() {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= total;
}

GaussLegendre gauss_legendre(std::size_t count) {
  switch (count) {
    case 2: return {kNodes2, kWeights2};
    case 3: return {kNodes3, kWeights3};
    case 4: return {kNodes4, kWeights4};
    default: throw std::invalid_argument("gauss_legendre: only 2, 3 or 4 nodes");
  }
}

}  // namespace clothbrdf
