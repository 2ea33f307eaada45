#include "tabulate/path_panels.h"

#include <cmath>

#include "tabulate/kernel.h"

namespace clothbrdf {
namespace {

std::vector<double> cosines_at(std::size_t panels, const PanelCosine& cosine,
                               std::span<const double> points) {
  std::vector<double> cosines;
  for (std::size_t panel = 0; panel < panels; ++panel) {
    for (const double at : points) cosines.push_back(cosine(static_cast<double>(panel) + at));
  }
  return cosines;
}

}  // namespace

PathMatrix panel_paths(const ClothModel<double>& model, std::size_t panels,
                       const PanelCosine& cosine, Workers workers) {
  return {model, cosines_at(panels, cosine, polynomial_nodes()), workers};
}

bool panels_suffice(const ClothModel<double>& model, const PathMatrix& paths,
                    const PanelCosine& cosine, double tolerance, Workers workers) {
  const std::size_t panels = paths.size() / kPolynomialNodes;
  const PathMatrix exact(model, cosines_at(panels, cosine, kTestPoints), workers);
  std::vector<double> density(paths.lobe_count());
  ChannelSums nodes(model, paths.size());
  ChannelSums tests(model, exact.size());
  for (const double theta_h_deg : {1.0, 20.0, 45.0, 70.0, 88.0}) {
    paths.mean_densities(sincosd(theta_h_deg), density);
    paths.sums(density, 0, nodes.specular(), nodes.internal());
    exact.sums(density, 0, tests.specular(), tests.internal());
    for (std::size_t colour = 0; colour < model.channel_count(); ++colour) {
      const Channel channel{"", Part::kTotal, colour};
      for (std::size_t t = 0; t < exact.size(); ++t) {
        const PolynomialWeights weights = polynomial_weights(kTestPoints[t % kTestPoints.size()]);
        double interpolated = 0;
        for (std::size_t n = 0; n < kPolynomialNodes; ++n) {
          interpolated += weights[n] *
                          nodes.directional(channel, t / kTestPoints.size() * kPolynomialNodes + n);
        }
        const double value = tests.directional(channel, t);
        if (std::abs(interpolated - value) > tolerance * value) return false;
      }
    }
  }
  return true;
}

}  // namespace clothbrdf
