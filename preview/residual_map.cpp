#include "preview/residual_map.h"

#include <algorithm>
#include <cmath>

#include "preview/panels.h"
#include "preview/plot.h"
#include "preview/slices.h"

namespace clothbrdf {
namespace {

constexpr Box kBar = {kResidualFrame.x + kResidualFrame.width + 14, kResidualFrame.y, 14,
                      kResidualFrame.height};

// -1 to 1, beyond as at the ends.
Rgb diverging(double share) {
  static const Rgb kBlue = screen_colour(33, 82, 168);
  static const Rgb kRed = screen_colour(178, 24, 43);
  return mix(kPlotPaper, share < 0 ? kBlue : kRed, std::min(std::abs(share), 1.0));
}

std::string percent_text(double share) {
  return (share > 0 ? "+" : "") + tick_text(100 * share) + "%";
}

std::string scale_text(double scale) {
  return "red " + percent_text(scale) + ", blue " + percent_text(-scale);
}

void draw_bar(Image& image, double scale) {
  for (int row = 0; row < kBar.height; ++row) {
    const double share = 1 - 2 * (row + 0.5) / kBar.height;
    fill_box(image, {kBar.x, kBar.y + row, kBar.width, 1}, diverging(share));
  }
  constexpr int kHalfLetter = 7 * kPlotText / 2;
  for (const double share : {1.0, 0.5, 0.0, -0.5, -1.0}) {
    const double down = (1 - share) / 2 * kBar.height;
    const int y = std::clamp(kBar.y + static_cast<int>(down) - kHalfLetter, kBar.y,
                             kBar.y + kBar.height - 2 * kHalfLetter);
    draw_text(image, kBar.x + kBar.width + 6, y, kPlotText, percent_text(share * scale), kPlotInk);
  }
}

}  // namespace

ResidualMap::ResidualMap(const Grid& grid)
    : grid_(grid), first_(0), second_(grid.kind == GridKind::kHalfDifference3d ? 1 : 2) {
  sums_.resize(static_cast<std::size_t>(grid_.axes[first_].size) *
               static_cast<std::size_t>(grid_.axes[second_].size));
}

void ResidualMap::add(std::size_t cell, double table, double fit) {
  if (!(fit > 0 && fit <= kMostDrawn && table >= 0 && table <= kMostDrawn)) return;
  // One value next to nothing must not make the sum infinite.
  constexpr double kMost = 1e6;
  const std::array<int, 4> place = grid_.indices(cell);
  const auto row = static_cast<std::size_t>(grid_.axes[second_].size);
  Sum& sum = sums_[static_cast<std::size_t>(place[first_]) * row +
                   static_cast<std::size_t>(place[second_])];
  sum.sum += std::min((table - fit) / fit, kMost);
  ++sum.count;
}

std::vector<std::optional<double>> ResidualMap::means() const {
  std::vector<std::optional<double>> means;
  for (const Sum& sum : sums_) {
    means.push_back(sum.count == 0 ? std::nullopt
                                   : std::optional(sum.sum / static_cast<double>(sum.count)));
  }
  return means;
}

double ResidualMap::scale() const {
  constexpr double kShare = 0.98;
  constexpr double kLowest = 0.001;
  std::vector<double> sizes;
  for (const std::optional<double>& mean : means()) {
    if (mean) sizes.push_back(std::abs(*mean));
  }
  if (sizes.empty()) return kLowest;
  std::sort(sizes.begin(), sizes.end());
  const double most =
      sizes[static_cast<std::size_t>(kShare * static_cast<double>(sizes.size() - 1))];
  for (const double scale : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    if (most <= scale) return scale;
  }
  return 1;
}

Image ResidualMap::draw() const {
  Image image(kPlotWidth, kPlotHeight, kPlotPaper);
  const Axis& across = grid_.axes[first_];
  const Axis& up = grid_.axes[second_];
  const std::vector<std::optional<double>> all = means();
  const double most = scale();
  for (int y = 0; y < kResidualFrame.height; ++y) {
    const int k_up = (kResidualFrame.height - 1 - y) * up.size / kResidualFrame.height;
    for (int x = 0; x < kResidualFrame.width; ++x) {
      const int k_across = x * across.size / kResidualFrame.width;
      const std::optional<double>& mean =
          all[static_cast<std::size_t>(k_across) * static_cast<std::size_t>(up.size) +
              static_cast<std::size_t>(k_up)];
      image.at(kResidualFrame.x + x, kResidualFrame.y + y) =
          mean ? diverging(*mean / most) : kPlotFaint;
    }
  }
  draw_bar(image, most);
  const PlotTitle title = {"mean of (table - fit) / fit", up.name + " upward, " + scale_text(most)};
  draw_axes(image, kResidualFrame, title, angle_axis(across), angle_axis(up));
  return image;
}

}  // namespace clothbrdf
