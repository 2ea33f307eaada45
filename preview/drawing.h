#pragma once

#include <vector>

#include "support/image.h"

namespace clothbrdf {

/// A box of pixels.
struct Box {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// A point of a picture, pixels from its top left corner; pixel k reaches from k to k + 1.
struct Point {
  double x = 0;
  double y = 0;
};

/// A colour given as on a screen, 0 to 255.
Rgb screen_colour(int red, int green, int blue);

/// From `from` at 0 to `to` at 1, in linear light.
Rgb mix(const Rgb& from, const Rgb& to, double share);

void fill_box(Image& image, const Box& box, const Rgb& colour);

/// Shapes with smooth edges, within a box; what lies outside is cut off. Shapes that overlap or
/// touch cover a pixel once, so that a line of many pieces has no beads where they meet.
class Mask {
 public:
  explicit Mask(const Box& box);

  void add_line(const Point& from, const Point& to, double width);
  void add_disc(const Point& centre, double radius);

  /// Lays the colour over the picture where the shapes are.
  void paint(Image& image, const Rgb& colour) const;

 private:
  Box box_;
  std::vector<double> covered_;  ///< share of each pixel, row by row
};

}  // namespace clothbrdf
