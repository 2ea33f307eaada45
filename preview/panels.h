#pragma once

#include <string>
#include <vector>

#include "support/image.h"

namespace clothbrdf {

/// A picture with a line of text above it.
struct Panel {
  std::string caption;  ///< ASCII; cut to the picture's width
  Image image;
};

/// Panels of one size, row by row, on a dark ground.
Image arrange(const std::vector<std::vector<Panel>>& rows);

/// Writes a line of text, top left corner at x, y; letters of 5 x 7 dots, `scale` pixels each. What
/// lies outside is cut off.
void draw_text(Image& image, int x, int y, int scale, const std::string& text, const Rgb& colour);

/// Pixels from the start of a line of text to where another would follow it.
int text_width(int scale, const std::string& text);

}  // namespace clothbrdf
