#include "preview/drawing.h"

#include <algorithm>
#include <cmath>

#include "support/srgb.h"

namespace clothbrdf {

Rgb screen_colour(int red, int green, int blue) {
  return {srgb_to_linear(red / 255.0), srgb_to_linear(green / 255.0), srgb_to_linear(blue / 255.0)};
}

Rgb mix(const Rgb& from, const Rgb& to, double share) {
  Rgb mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = from[c] * (1 - share) + to[c] * share;
  return mixed;
}

void fill_box(Image& image, const Box& box, const Rgb& colour) {
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) image.at(x, y) = colour;
  }
}

Mask::Mask(const Box& box)
    : box_(box),
      covered_(static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height)) {}

void Mask::add_line(const Point& from, const Point& to, double width) {
  const double reach = width / 2 + 0.5;
  const double along_x = to.x - from.x;
  const double along_y = to.y - from.y;
  const double length2 = along_x * along_x + along_y * along_y;
  // Cut off before the conversion: a point may lie further out than an int can say.
  const auto first = [](double at, int start, int size) {
    return static_cast<int>(std::clamp(std::floor(at) - start, 0.0, 1.0 * size));
  };
  const int left = first(std::min(from.x, to.x) - reach, box_.x, box_.width);
  const int right = first(std::max(from.x, to.x) + reach + 1, box_.x, box_.width);
  const int top = first(std::min(from.y, to.y) - reach, box_.y, box_.height);
  const int bottom = first(std::max(from.y, to.y) + reach + 1, box_.y, box_.height);
  for (int row = top; row < bottom; ++row) {
    for (int column = left; column < right; ++column) {
      const double x = box_.x + column + 0.5 - from.x;
      const double y = box_.y + row + 0.5 - from.y;
      const double share =
          length2 > 0 ? std::clamp((x * along_x + y * along_y) / length2, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(x - share * along_x, y - share * along_y);
      double& covered =
          covered_[static_cast<std::size_t>(row) * static_cast<std::size_t>(box_.width) +
                   static_cast<std::size_t>(column)];
      covered = std::max(covered, std::clamp(reach - distance, 0.0, 1.0));
    }
  }
}

void Mask::add_disc(const Point& centre, double radius) { add_line(centre, centre, 2 * radius); }

void Mask::paint(Image& image, const Rgb& colour) const {
  std::size_t at = 0;
  for (int y = box_.y; y < box_.y + box_.height; ++y) {
    for (int x = box_.x; x < box_.x + box_.width; ++x) {
      const double covered = covered_[at++];
      if (covered > 0) image.at(x, y) = mix(image.at(x, y), colour, covered);
    }
  }
}

}  // namespace clothbrdf
