#include "tabulate/inout_average.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/parameters.h"
#include "support/errors.h"
#include "tabulate/path_panels.h"

namespace clothbrdf {
namespace {

constexpr double kRadian = std::numbers::pi / 180;
constexpr double kInterpolationShare = 0.1;
constexpr std::size_t kMostPanels = 2048;

// Path weights change fastest at grazing incidence, so panels are equal in log(cos_theta_d + 0.005)
// (model.md 8.2).
constexpr double kShift = 0.005;
const double kLowest = std::log(kShift);
const double kRange = std::log(1 + kShift) - kLowest;

double cosine_at(double share) {
  return std::clamp(std::exp(kLowest + share * kRange) - kShift, 0.0, 1.0);
}
double share_of(double cosine) { return (std::log(cosine + kShift) - kLowest) / kRange; }

}  // namespace

struct InOutAverage::Workspace {
  Workspace(const ClothModel<double>& model, const PathMatrix& paths)
      : density(paths.lobe_count()), sums(model, kPolynomialNodes) {}
  std::vector<double> density;
  ChannelSums sums;
};

InOutAverage::InOutAverage(const TableSpec& spec, const ClothModel<double>& model, Workers workers)
    : spec_(spec), model_(model), workers_(workers) {
  for (const PreparedYarn<double>& y : model.yarns()) {
    for (const double axis : y.yarn.lobe_axes) narrowest_axis_ = std::min(narrowest_axis_, axis);
  }
  const double tolerance = kInterpolationShare * spec.cells.tolerance;
  while (true) {
    const PanelCosine cosine = [this](double at) {
      return cosine_at(at / static_cast<double>(panels_));
    };
    paths_ = std::make_unique<PathMatrix>(panel_paths(model, panels_, cosine, workers));
    if (panels_ >= kMostPanels || panels_suffice(model, *paths_, cosine, tolerance, workers))
      return;
    panels_ *= 2;
  }
}

// The directional part of all channels, times the sines of the measure.
void InOutAverage::directional(const std::array<double, 4>& at, Workspace& work,
                               std::span<double> values) const {
  const Vector3<double> wi = {std::sin(at[0]) * std::cos(at[1]), std::sin(at[0]) * std::sin(at[1]),
                              std::cos(at[0])};
  const Vector3<double> wo = {std::sin(at[2]) * std::cos(at[3]), std::sin(at[2]) * std::sin(at[3]),
                              std::cos(at[2])};
  const PairGeometry<double> g = pair_geometry(wi, wo, model_.material().rotation_deg);
  const double factor = directional_factor(model_.material().reflectance, g.h_n, g.cos_theta_d,
                                           g.cos_theta_i, g.cos_theta_o);
  const double place = share_of(g.cos_theta_d) * static_cast<double>(panels_);
  const double panel = std::clamp(std::floor(place), 0.0, static_cast<double>(panels_ - 1));
  paths_->densities(g.h_weft, g.h_warp, g.h_n, work.density);
  paths_->sums(work.density, static_cast<std::size_t>(panel) * kPolynomialNodes,
               work.sums.specular(), work.sums.internal());
  const PolynomialWeights weights = polynomial_weights(place - panel);
  for (std::size_t c = 0; c < values.size(); ++c) {
    values[c] = 0;
    for (std::size_t n = 0; n < kPolynomialNodes; ++n) {
      values[c] += weights[n] * work.sums.directional(spec_.channels[c], n);
    }
    values[c] *= factor * std::sin(at[0]) * std::sin(at[2]);
  }
}

// A part is coarse where it is wider than the lobes are there: their peak, at the normal, is as
// wide as the narrowest axis, and farther from it they change over angles like the half vector's
// own tilt. The azimuths' period must be resolved, too.
std::optional<std::size_t> InOutAverage::coarse_variable(const Box4& part) const {
  constexpr double kWidest = 0.8;
  std::array<double, 4> width{};
  std::array<double, 4> middle{};
  for (std::size_t a = 0; a < 4; ++a) {
    width[a] = part.high[a] - part.low[a];
    middle[a] = (part.high[a] + part.low[a]) / 2;
  }
  width[1] *= std::sin(part.high[0]);
  width[3] *= std::sin(part.high[2]);
  const Vector3<double> h = {
      std::sin(middle[0]) * std::cos(middle[1]) + std::sin(middle[2]) * std::cos(middle[3]),
      std::sin(middle[0]) * std::sin(middle[1]) + std::sin(middle[2]) * std::sin(middle[3]),
      std::cos(middle[0]) + std::cos(middle[2])};
  const double tilt = std::atan2(std::hypot(h[0], h[1]), h[2]);
  const auto widest = std::max_element(width.begin(), width.end());
  if (*widest <= std::min(kWidest, 2 * (tilt + narrowest_axis_))) return std::nullopt;
  return static_cast<std::size_t>(widest - width.begin());
}

void InOutAverage::fill_rows(std::size_t first_row, std::span<double> values) const {
  Workspace work(model_, *paths_);
  const std::size_t columns = spec_.column_count();
  const std::size_t channels = spec_.channels.size();
  for (std::size_t i = 0; i < values.size() / spec_.row_values() * columns; ++i) {
    const std::array<int, 4> index = spec_.grid().indices(first_row * columns + i);
    Box4 box{};
    double measure = 1;
    for (std::size_t a = 0; a < 4; ++a) {
      const Axis& axis = spec_.grid().axes[a];
      box.low[a] = axis.edge_deg(index[a]) * kRadian;
      box.high[a] = axis.edge_deg(index[a] + 1) * kRadian;
      const bool elevation = a % 2 == 0;
      measure *=
          elevation ? std::cos(box.low[a]) - std::cos(box.high[a]) : box.high[a] - box.low[a];
    }
    const std::optional<std::vector<double>> integral = integrate4(
        [&](const std::array<double, 4>& at, std::span<double> f) {
          workers_.check();  // here, as one cell can take minutes
          directional(at, work, f);
        },
        box, channels, spec_.cells.tolerance,
        [&](const Box4& part) { return coarse_variable(part); });
    if (!integral) {
      throw WorkError("--cells average: the lobes are too narrow for cells of " +
                      spec_.grid().description() + " at a relative tolerance of " +
                      number_text(spec_.cells.tolerance) +
                      "; take a finer grid, a looser tolerance or --cells point");
    }
    for (std::size_t c = 0; c < channels; ++c) {
      values[(i / columns * channels + c) * columns + i % columns] =
          (*integral)[c] / measure + work.sums.constant(spec_.channels[c]);
    }
  }
}

}  // namespace clothbrdf
