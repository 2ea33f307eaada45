#include "preview/panels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string_view>

namespace clothbrdf {
namespace {

constexpr Rgb kGround = {0.012, 0.012, 0.014};
constexpr Rgb kInk = {0.55, 0.55, 0.55};

constexpr int kGlyphWidth = 5;
constexpr int kGlyphHeight = 7;

// Rows from the top, the leftmost dot is the highest of five bits. Small letters look like
// capitals.
struct Glyph {
  char letter;
  std::array<std::uint8_t, kGlyphHeight> rows;
};
constexpr Glyph kGlyphs[] = {{'A', {0x0E, 0x11, 0x11, 0x1F, 0x11, 0x11, 0x11}},
                             {'B', {0x1E, 0x11, 0x11, 0x1E, 0x11, 0x11, 0x1E}},
                             {'C', {0x0E, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0E}},
                             {'D', {0x1C, 0x12, 0x11, 0x11, 0x11, 0x12, 0x1C}},
                             {'E', {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x1F}},
                             {'F', {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x10}},
                             {'G', {0x0E, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0F}},
                             {'H', {0x11, 0x11, 0x11, 0x1F, 0x11, 0x11, 0x11}},
                             {'I', {0x0E, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0E}},
                             {'J', {0x07, 0x02, 0x02, 0x02, 0x02, 0x12, 0x0C}},
                             {'K', {0x11, 0x12, 0x14, 0x18, 0x14, 0x12, 0x11}},
                             {'L', {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1F}},
                             {'M', {0x11, 0x1B, 0x15, 0x15, 0x11, 0x11, 0x11}},
                             {'N', {0x11, 0x11, 0x19, 0x15, 0x13, 0x11, 0x11}},
                             {'O', {0x0E, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E}},
                             {'P', {0x1E, 0x11, 0x11, 0x1E, 0x10, 0x10, 0x10}},
                             {'Q', {0x0E, 0x11, 0x11, 0x11, 0x15, 0x12, 0x0D}},
                             {'R', {0x1E, 0x11, 0x11, 0x1E, 0x14, 0x12, 0x11}},
                             {'S', {0x0F, 0x10, 0x10, 0x0E, 0x01, 0x01, 0x1E}},
                             {'T', {0x1F, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}},
                             {'U', {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E}},
                             {'V', {0x11, 0x11, 0x11, 0x11, 0x11, 0x0A, 0x04}},
                             {'W', {0x11, 0x11, 0x11, 0x15, 0x15, 0x15, 0x0A}},
                             {'X', {0x11, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x11}},
                             {'Y', {0x11, 0x11, 0x0A, 0x04, 0x04, 0x04, 0x04}},
                             {'Z', {0x1F, 0x01, 0x02, 0x04, 0x08, 0x10, 0x1F}},
                             {'0', {0x0E, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0E}},
                             {'1', {0x04, 0x0C, 0x04, 0x04, 0x04, 0x04, 0x0E}},
                             {'2', {0x0E, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1F}},
                             {'3', {0x1F, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0E}},
                             {'4', {0x02, 0x06, 0x0A, 0x12, 0x1F, 0x02, 0x02}},
                             {'5', {0x1F, 0x10, 0x1E, 0x01, 0x01, 0x11, 0x0E}},
                             {'6', {0x06, 0x08, 0x10, 0x1E, 0x11, 0x11, 0x0E}},
                             {'7', {0x1F, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
                             {'8', {0x0E, 0x11, 0x11, 0x0E, 0x11, 0x11, 0x0E}},
                             {'9', {0x0E, 0x11, 0x11, 0x0F, 0x01, 0x02, 0x0C}},
                             {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0C, 0x0C}},
                             {',', {0x00, 0x00, 0x00, 0x00, 0x0C, 0x04, 0x08}},
                             {'-', {0x00, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x00}},
                             {'_', {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x1F}},
                             {'/', {0x00, 0x01, 0x02, 0x04, 0x08, 0x10, 0x00}},
                             {':', {0x00, 0x0C, 0x0C, 0x00, 0x0C, 0x0C, 0x00}},
                             {'+', {0x00, 0x04, 0x04, 0x1F, 0x04, 0x04, 0x00}},
                             {'=', {0x00, 0x00, 0x1F, 0x00, 0x1F, 0x00, 0x00}},
                             {'%', {0x18, 0x19, 0x02, 0x04, 0x08, 0x13, 0x03}},
                             {'(', {0x02, 0x04, 0x08, 0x08, 0x08, 0x04, 0x02}},
                             {')', {0x08, 0x04, 0x02, 0x02, 0x02, 0x04, 0x08}},
                             {' ', {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}}};

// A filled box for what has no glyph.
constexpr Glyph kUnknown = {'?', {0x1F, 0x1F, 0x1F, 0x1F, 0x1F, 0x1F, 0x1F}};

const Glyph& glyph_of(char letter) {
  const auto capital = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  const auto* found = std::find_if(std::begin(kGlyphs), std::end(kGlyphs),
                                   [&](const Glyph& g) { return g.letter == capital; });
  return found == std::end(kGlyphs) ? kUnknown : *found;
}

void copy(const Image& from, Image& to, int x, int y) {
  for (int row = 0; row < from.height; ++row) {
    for (int column = 0; column < from.width; ++column) {
      to.at(x + column, y + row) = from.at(column, row);
    }
  }
}

}  // namespace

int text_width(int scale, const std::string& text) {
  return static_cast<int>(text.size()) * (kGlyphWidth + 1) * scale;
}

void draw_text(Image& image, int x, int y, int scale, const std::string& text, const Rgb& colour) {
  for (const char letter : text) {
    const Glyph& glyph = glyph_of(letter);
    for (int dot_y = 0; dot_y < kGlyphHeight * scale; ++dot_y) {
      for (int dot_x = 0; dot_x < kGlyphWidth * scale; ++dot_x) {
        const unsigned row = glyph.rows[static_cast<std::size_t>(dot_y / scale)];
        const bool ink = (row >> (kGlyphWidth - 1 - dot_x / scale) & 1U) != 0;
        const int at_x = x + dot_x;
        const int at_y = y + dot_y;
        const bool inside = at_x >= 0 && at_y >= 0 && at_x < image.width && at_y < image.height;
        if (ink && inside) image.at(at_x, at_y) = colour;
      }
    }
    x += (kGlyphWidth + 1) * scale;
  }
}

Image arrange(const std::vector<std::vector<Panel>>& rows) {
  const Image& first = rows.front().front().image;
  const int scale = std::max(1, first.width / 200);
  const int gap = 4 * scale;
  const int strip = (kGlyphHeight + 3) * scale;
  std::size_t columns = 0;
  for (const std::vector<Panel>& row : rows) columns = std::max(columns, row.size());
  const int step_x = first.width + gap;
  const int step_y = first.height + strip + gap;
  Image picture(gap + static_cast<int>(columns) * step_x,
                gap + static_cast<int>(rows.size()) * step_y, kGround);
  int y = gap;
  for (const std::vector<Panel>& row : rows) {
    int x = gap;
    for (const Panel& panel : row) {
      const auto fits = static_cast<std::size_t>(first.width / ((kGlyphWidth + 1) * scale));
      draw_text(picture, x, y, scale, panel.caption.substr(0, fits), kInk);
      copy(panel.image, picture, x, y + strip);
      x += step_x;
    }
    y += step_y;
  }
  return picture;
}

}  // namespace clothbrdf
