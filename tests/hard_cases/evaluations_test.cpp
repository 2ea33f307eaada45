#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "tabulate/batch.h"
#include "tabulate/precision_check.h"
#include "tests/catch.h"
#include "tests/hard_cases/accuracy_table.h"
#include "tests/hard_cases/hard_materials.h"
#include "tests/hard_cases/hard_promise.h"
#include "tests/hard_cases/trapped.h"
#include "tests/reference/reference_model.h"
#include "tests/reference/worst_case.h"

namespace clothbrdf::test {
namespace {

const std::vector<HardMaterial>& catalogue() {
  static const std::vector<HardMaterial> kCatalogue = hard_materials();
  return kCatalogue;
}

void print_figure(const PrecisionFigure& f) {
  std::cout << "    " << std::left << std::setw(16) << f.evaluation << " worst " << std::setw(12)
            << f.worst << " of the promise " << std::setw(12) << f.worst_share;
  if (f.worst_share > 0.5) {
    std::cout << f.error << " of " << f.promised << " in " << full_name(f.channel) << " at "
              << std::setprecision(17) << f.pair.theta_i << ' ' << f.pair.phi_i << ' '
              << f.pair.theta_o << ' ' << f.pair.phi_o << ": " << f.value << " for " << f.exact
              << std::setprecision(6);
  }
  std::cout << '\n';
}

/// The worst of all conventions and path sets, a row for each material.
std::string row_of(const std::string& name, const std::vector<PrecisionFigure>& worst) {
  std::ostringstream row;
  row << "| " << name << std::setprecision(2);
  for (const PrecisionFigure& f : worst) {
    row << " | " << f.worst << " (" << std::ceil(100 * f.worst_share) << " %)";
  }
  row << " |\n";
  return row.str();
}

}  // namespace

TEST_CASE("every hard material keeps every promise at the hard pairs, in double and in float") {
  std::vector<std::string> rows;
  for (const HardMaterial& hard : catalogue()) {
    std::vector<PrecisionFigure> worst;
    for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
      for (const Paths paths : {Paths::kAll, Paths::kSingle}) {
        Material material = hard.material;
        material.reflectance = reflectance;
        material.paths = paths;
        std::cout << hard.name << (reflectance == Reflectance::kPaper ? ", paper" : "")
                  << (paths == Paths::kSingle ? ", single" : "") << '\n';
        const Trapped trapped;
        const std::vector<PrecisionFigure> figures =
            check_precision(material, hard_pairs(material), 1);
        if (worst.empty()) worst = figures;
        for (std::size_t k = 0; k < figures.size(); ++k) {
          const PrecisionFigure& f = figures[k];
          print_figure(f);
          INFO(hard.name << ", " << f.evaluation);
          CHECK(f.worst_share <= 1);
          CHECK(f.compared > 0);
          worst[k].worst = std::max(worst[k].worst, f.worst);
          worst[k].worst_share = std::max(worst[k].worst_share, f.worst_share);
        }
      }
    }
    rows.push_back(row_of(hard.name, worst));
  }
  check_or_write_rows("| material | double |", rows);
}

TEST_CASE("the double model is within its promise of 50 digits in every hard material") {
  constexpr std::size_t kStride = 11;
  WorstCases worst;
  std::size_t first = 0;
  for (const HardMaterial& hard : catalogue()) {
    Material material = hard.material;
    // Beyond its 100 digits the reference cannot reduce angles.
    material.rotation_deg = std::remainder(material.rotation_deg, 360);
    const double axis = std::min({material.warp.lobe_axes[0], material.warp.lobe_axes[1],
                                  material.weft.lobe_axes[0], material.weft.lobe_axes[1]});
    const std::vector<DirectionPair> pairs = hard_pairs(material);
    for (std::size_t k = first++ % kStride; k < pairs.size(); k += kStride) {
      const PairGeometry<double> g = pair_geometry<double>(pairs[k], material.rotation_deg);
      const double lean = std::min(std::abs(g.h_weft), std::abs(g.h_warp));
      const auto promise = [&](std::size_t component, const Material& m, std::size_t channel,
                               const ReferenceValues& values) {
        const double narrow = component == 2 ? 0 : 4e-16 / std::max(lean, axis);
        return hard_promise(component, m, channel, values) + narrow;
      };
      INFO(hard.name);
      const WorstCases before = worst;
      compare_with_reference(material, pairs[k], reference_values(material, pairs[k]), promise,
                             worst);
      if (worst.largest() > std::max(1.0, before.largest())) CHECK(worst.largest() <= 1);
    }
  }
  worst.print_to_cout("hard materials at hard pairs, against 50 digits");
  CHECK(worst.largest() <= 1);
}

}  // namespace clothbrdf::test
