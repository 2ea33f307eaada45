#include "tabulate/halfdiff_average.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "model/degrees.h"
#include "tabulate/cell_integral.h"
#include "tabulate/path_panels.h"

namespace clothbrdf {
namespace {

// Share of the tolerance that interpolation may use up.
constexpr double kInterpolationShare = 0.1;
// The narrowest lobe, 1e-6, needs about 20 halvings of the widest cell.
constexpr double kNarrowestPanel = 1e-9;
constexpr std::size_t kMostPanelsPerCell = 64;
SinCos<double> sincos(double radians) { return {std::sin(radians), std::cos(radians)}; }

bool close(double interpolated, double exact, double tolerance) {
  return std::abs(interpolated - exact) <= tolerance * std::abs(exact);
}

}  // namespace

HalfDifferenceAverage::HalfDifferenceAverage(const TableSpec& spec, const ClothModel<double>& model,
                                             Workers workers)
    : spec_(spec),
      model_(model),
      workers_(workers),
      theta_h_axis_(spec.grid().axes.front()),
      theta_d_axis_(spec.grid().axes[spec.grid().axes.size() - 2]),
      phi_d_axis_(spec.grid().axes.back()) {
  while (true) {
    const PanelCosine cosine = [this](double at) {
      const double cell = std::floor(at / static_cast<double>(panels_per_cell_));
      const double share = at / static_cast<double>(panels_per_cell_) - cell;
      const int k = static_cast<int>(cell);
      const double low = theta_d_axis_.edge_deg(k);
      return sincosd(low + share * (theta_d_axis_.edge_deg(k + 1) - low)).cos;
    };
    const std::size_t panels = static_cast<std::size_t>(theta_d_axis_.size) * panels_per_cell_;
    paths_ = std::make_unique<PathMatrix>(panel_paths(model, panels, cosine, workers));
    if (panels_per_cell_ >= kMostPanelsPerCell ||
        panels_suffice(model, *paths_, cosine, tolerance(), workers))
      return;
    panels_per_cell_ *= 2;
  }
}

std::vector<double> HalfDifferenceAverage::densities(double theta_h, std::size_t row) const {
  std::vector<double> density(paths_->lobe_count());
  if (spec_.grid().kind == GridKind::kHalfDifference3d) {
    paths_->mean_densities(sincos(theta_h), density);
  } else {
    const Axis& axis = spec_.grid().axes[1];
    const int k = static_cast<int>(row % static_cast<std::size_t>(axis.size));
    const double rotation = reduce_turns(model_.material().rotation_deg);
    const double from = axis.edge_deg(k) - rotation;
    const double width = std::min(180.0, axis.edge_deg(k + 1) - axis.edge_deg(k));  // the period
    paths_->mean_densities(sincos(theta_h), from * kRadian, (from + width) * kRadian, density);
  }
  return density;
}

ChannelSums HalfDifferenceAverage::sums_at(double theta_h, std::size_t row) const {
  ChannelSums sums(model_, paths_->size());
  paths_->sums(densities(theta_h, row), 0, sums.specular(), sums.internal());
  return sums;
}

double HalfDifferenceAverage::tolerance() const {
  return kInterpolationShare * spec_.cells.tolerance;
}

HalfDifferenceAverage::Panel HalfDifferenceAverage::make_panel(std::size_t row, double low,
                                                               double high) const {
  Panel panel{low, high,
              std::vector<double>(paths_->size() * spec_.channels.size() * kPolynomialNodes)};
  const std::size_t channels = spec_.channels.size();
  for (std::size_t n = 0; n < kPolynomialNodes; ++n) {
    const ChannelSums sums = sums_at(low + polynomial_nodes()[n] * (high - low), row);
    for (std::size_t k = 0; k < paths_->size(); ++k) {
      const std::size_t block = k / kPolynomialNodes;
      for (std::size_t c = 0; c < channels; ++c) {
        panel.values[((block * channels + c) * kPolynomialNodes + k % kPolynomialNodes) *
                         kPolynomialNodes +
                     n] = sums.directional(spec_.channels[c], k);
      }
    }
  }
  return panel;
}

bool HalfDifferenceAverage::interpolates(const Panel& panel, std::size_t row) const {
  const std::size_t channels = spec_.channels.size();
  for (const double at : kTestPoints) {
    const ChannelSums exact = sums_at(panel.low + at * (panel.high - panel.low), row);
    const PolynomialWeights weights = polynomial_weights(at);
    for (std::size_t k = 0; k < paths_->size(); ++k) {
      const std::size_t block = k / kPolynomialNodes;
      for (std::size_t c = 0; c < channels; ++c) {
        const double* values =
            panel.values.data() +
            ((block * channels + c) * kPolynomialNodes + k % kPolynomialNodes) * kPolynomialNodes;
        double interpolated = 0;
        for (std::size_t n = 0; n < kPolynomialNodes; ++n) interpolated += weights[n] * values[n];
        if (!close(interpolated, exact.directional(spec_.channels[c], k), tolerance()))
          return false;
      }
    }
  }
  return true;
}

std::vector<HalfDifferenceAverage::Panel> HalfDifferenceAverage::make_panels(
    std::size_t row) const {
  const std::size_t rows_per_theta_h =
      spec_.row_count() / static_cast<std::size_t>(theta_h_axis_.size);
  const int cell = static_cast<int>(row / rows_per_theta_h);
  std::vector<std::pair<double, double>> open = {
      {theta_h_axis_.edge_deg(cell) * kRadian, theta_h_axis_.edge_deg(cell + 1) * kRadian}};
  std::vector<Panel> panels;
  while (!open.empty()) {
    workers_.check();
    const auto [low, high] = open.back();
    open.pop_back();
    Panel panel = make_panel(row, low, high);
    if (high - low < kNarrowestPanel || interpolates(panel, row)) {
      panels.push_back(std::move(panel));
    } else {
      open.emplace_back((low + high) / 2, high);
      open.emplace_back(low, (low + high) / 2);
    }
  }
  return panels;
}

void HalfDifferenceAverage::fill_row(std::size_t row, std::span<const ColumnRange> columns,
                                     std::span<double> values) const {
  const std::size_t channels = spec_.channels.size();
  const auto phi_count = static_cast<std::size_t>(phi_d_axis_.size);
  const std::size_t half = (phi_count + 1) / 2;  // the other cells are mirror images
  std::vector<double> edges;
  for (std::size_t k = 0; k <= half; ++k)
    edges.push_back(phi_d_axis_.edge_deg(static_cast<int>(k)) * kRadian);
  CellIntegrator integrator(edges, channels, spec_.cells.tolerance, workers_);
  const std::vector<Panel> panels = make_panels(row);
  const std::size_t block = channels * kPolynomialNodes * kPolynomialNodes;
  for (int d = 0; d < theta_d_axis_.size; ++d) {
    const std::size_t at = static_cast<std::size_t>(d) * phi_count;
    const bool wanted = std::any_of(columns.begin(), columns.end(), [&](const ColumnRange& range) {
      return range.begin < at + phi_count && range.end > at;
    });
    if (!wanted) continue;
    std::vector<CellSums> sums(half, {0, std::vector<double>(channels, 0.0)});
    const double low = theta_d_axis_.edge_deg(d) * kRadian;
    const double width =
        (theta_d_axis_.edge_deg(d + 1) * kRadian - low) / static_cast<double>(panels_per_cell_);
    for (std::size_t p = 0; p < panels_per_cell_; ++p) {
      const std::size_t index = static_cast<std::size_t>(d) * panels_per_cell_ + p;
      const double d_low = low + static_cast<double>(p) * width;
      for (const Panel& panel : panels) {
        integrator.add({{panel.low, panel.high, d_low, d_low + width},
                        std::span(panel.values).subspan(index * block, block)},
                       sums);
      }
    }
    const ChannelSums constants(model_, 0);
    for (std::size_t c = 0; c < channels; ++c) {
      double* const to = values.data() + (c * static_cast<std::size_t>(theta_d_axis_.size) +
                                          static_cast<std::size_t>(d)) *
                                             phi_count;
      for (std::size_t k = 0; k < half; ++k) {
        const CellSums& s = sums[k];
        to[k] =
            s.measure > 0 ? s.channels[c] / s.measure + constants.constant(spec_.channels[c]) : 0;
        to[phi_count - 1 - k] = to[k];
      }
    }
  }
}

}  // namespace clothbrdf
