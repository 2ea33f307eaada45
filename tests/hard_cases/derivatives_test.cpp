#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "tabulate/precision_check.h"
#include "tests/catch.h"
#include "tests/hard_cases/hard_materials.h"
#include "tests/hard_cases/trapped.h"
#include "tests/support/flat_cloth.h"

namespace clothbrdf::test {
namespace {

/// The first channel of a material at a pair.
Parameters flat(const Material& material, const DirectionPair& pair) {
  Parameters p{};
  for (const std::size_t at : {std::size_t{0}, kWeft}) {
    const Yarn& yarn = at == 0 ? material.warp : material.weft;
    const std::array<double, kWeft> own = {yarn.lobe_axes[0], yarn.lobe_axes[1], yarn.absorption[0],
                                           yarn.refractive_index, yarn.scatter};
    std::copy(own.begin(), own.end(), p.begin() + static_cast<std::ptrdiff_t>(at));
  }
  const std::array<double, kCount - kShared> shared = {material.weights.specular,
                                                       material.weights.internal,
                                                       material.weights.diffuse,
                                                       material.diffuse_path,
                                                       material.warp_fraction,
                                                       std::remainder(material.rotation_deg, 360),
                                                       pair.theta_i,
                                                       pair.phi_i,
                                                       pair.theta_o,
                                                       pair.phi_o};
  std::copy(shared.begin(), shared.end(), p.begin() + kShared);
  return p;
}

Variant variant_of(const Material& material) {
  return {material.reflectance, material.paths, {material.warp.layers, material.weft.layers}};
}

}  // namespace

TEST_CASE("derivatives are numbers in every hard material at every hard pair") {
  long compared = 0;
  for (HardMaterial hard : hard_materials()) {
    for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
      hard.material.reflectance = reflectance;
      for (const DirectionPair& pair : hard_pairs(hard.material)) {
        const Parameters p = flat(hard.material, pair);
        const Variant variant = variant_of(hard.material);
        INFO(hard.name << " at " << pair.theta_i << ' ' << pair.phi_i << ' ' << pair.theta_o << ' '
                       << pair.phi_o);
        const Trapped trapped;
        const std::array<Jet, 3> f = components_at(jets(p), variant);
        for (std::size_t c = 0; c < f.size(); ++c) {
          for (std::size_t k = 0; k < kCount; ++k) {
            INFO("component " << c << ", parameter " << k);
            const double derivative = f[c].v[static_cast<int>(k)];
            if (!std::isfinite(derivative)) CHECK(std::isfinite(derivative));
            ++compared;
          }
        }
      }
    }
  }
  std::cout << compared << " derivatives, all numbers\n";
  CHECK(compared > 200000);
}

TEST_CASE("derivatives of hard materials agree with differences in 50 digits") {
  constexpr double kDerivative = 1e-13;
  constexpr std::size_t kStride = 3;  // of parameters, others in each material
  std::size_t first = 0;
  double largest = 0;
  for (HardMaterial hard : hard_materials()) {
    Material& material = hard.material;
    // Axes that meet: the limit of scatter is the wider one, and has no derivative but on either
    // side. The model takes that of the across axis.
    const auto& axes = material.warp.lobe_axes;
    if (std::abs(axes[0] - axes[1]) < 1e-9) continue;
    // Few lobes: 50 digits take their time.
    for (Yarn* yarn : {&material.warp, &material.weft}) {
      if (yarn->scatter > 0.01 && yarn->scatter < 0.1) yarn->scatter *= 8;
      if (yarn->scatter < 0.01) material.paths = Paths::kSingle;
      yarn->layers = std::min(yarn->layers, 6);
    }
    const double turn = std::remainder(material.rotation_deg, 360);
    // Next to the crest of the narrow lobes.
    const double narrow = axes[0];
    const DirectionPair pair = {40, turn + 90 - 35 + 20 * narrow, 55, turn + 90 + 30};
    const PairGeometry<double> g = pair_geometry<double>(pair, turn);
    const double lean = std::min(std::abs(g.h_weft), std::abs(g.h_warp));
    const double promise = kDerivative + 4e-16 / std::max(lean, narrow);
    const double worst =
        worst_derivative(flat(material, pair), variant_of(material), first++ % kStride, kStride);
    std::cout << hard.name << ": " << worst << ", " << worst / promise << " of the promise\n";
    INFO(hard.name);
    CHECK(worst <= promise);
    largest = std::max(largest, worst / promise);
  }
  std::cout << "derivatives of hard materials: worst share of what is promised " << largest << '\n';
}

}  // namespace clothbrdf::test
