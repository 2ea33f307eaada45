#include "preview/panels.h"

#include <string>
#include <vector>

#include "tests/catch.h"

namespace clothbrdf::test {
namespace {

constexpr Rgb kGround = {0.012, 0.012, 0.014};
constexpr Rgb kWhite = {1, 1, 1};

// Letters are 5 x 7 dots, 6 from one to the next.
constexpr int kStep = 6;
constexpr int kGap = 4;
constexpr int kStrip = 10;  // text and 3 below it

// A box of pixels of a picture.
struct PixelBox {
  int x;
  int y;
  int width;
  int height;
  bool holds(int at_x, int at_y) const {
    return at_x >= x && at_x < x + width && at_y >= y && at_y < y + height;
  }
};

// Pixels of a box that are not of a colour.
int other_than(const Rgb& colour, const Image& image, const PixelBox& box) {
  int count = 0;
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      if (image.at(x, y) != colour) ++count;
    }
  }
  return count;
}

Image text(const std::string& line, int scale = 1) {
  Image image(120, 20);
  draw_text(image, 0, 0, scale, line, kWhite);
  return image;
}

}  // namespace

TEST_CASE("panels stand row by row, each below its caption, nothing else is drawn") {
  for (const int scale : {1, 2}) {
    const int width = scale == 1 ? 30 : 400;
    const int height = 20 * scale;
    std::vector<std::vector<Panel>> rows(3);
    double value = 0.25;
    for (const std::size_t columns : {2U, 3U, 1U}) {
      std::vector<Panel>& row = rows[columns == 2 ? 0 : columns == 3 ? 1 : 2];
      for (std::size_t c = 0; c < columns; ++c) {
        row.push_back({"ab", Image(width, height, {value, 0, 1})});
        row.back().image.at(0, 0) = {value, value, value};
        value += 1;
      }
    }
    const Image picture = arrange(rows);
    const int step_x = width + kGap * scale;
    const int step_y = height + (kGap + kStrip) * scale;
    REQUIRE(picture.width == kGap * scale + 3 * step_x);
    REQUIRE(picture.height == kGap * scale + 3 * step_y);
    int rest = other_than(kGround, picture, {0, 0, picture.width, picture.height});
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < rows[r].size(); ++c) {
        const int x = kGap * scale + static_cast<int>(c) * step_x;
        const int y = kGap * scale + static_cast<int>(r) * step_y;
        const PixelBox caption = {x, y, 2 * kStep * scale, 7 * scale};
        const PixelBox panel = {x, y + kStrip * scale, width, height};
        const Rgb& colour = rows[r][c].image.at(1, 1);
        CHECK(other_than(colour, picture, panel) == 1);
        CHECK(picture.at(panel.x, panel.y) == rows[r][c].image.at(0, 0));
        const int ink = other_than(kGround, picture, caption);
        CHECK(ink == 38 * scale * scale);  // the dots of A and B
        rest -= ink + width * height;
      }
    }
    CHECK(rest == 0);
  }
}

TEST_CASE("a caption is cut where its panel ends") {
  const std::string longest(1000, 'H');
  for (const int width : {5, 6, 16, 47, 48, 64}) {
    const Image picture = arrange({{{longest, Image(width, 16)}, {"", Image(width, 16)}}});
    CAPTURE(width);
    const int letters = width / kStep;
    CHECK(other_than(kGround, picture, {kGap, kGap, width, 7}) == letters * 17);
    CHECK(other_than(kGround, picture, {kGap + width, 0, width + 2 * kGap, kGap + kStrip}) == 0);
  }
}

TEST_CASE("small letters look like capitals, and every other letter has a look of its own") {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-_/:+=%() ";
  for (std::size_t a = 0; a < letters.size(); ++a) {
    for (std::size_t b = a + 1; b < letters.size(); ++b) {
      CAPTURE(letters[a], letters[b]);
      CHECK(text({letters[a]}).pixels != text({letters[b]}).pixels);
    }
  }
  CHECK(text("silk, weave at 45 deg").pixels == text("SILK, WEAVE AT 45 DEG").pixels);
  CHECK(other_than({0, 0, 0}, text("L", 2), {0, 0, 120, 20}) == 4 * 11);
  CHECK(text("L").at(0, 0) == kWhite);
  CHECK(text("L").at(4, 0) == Rgb{});
  CHECK(text("L").at(4, 6) == kWhite);
}

TEST_CASE("characters without a picture of their own are filled boxes") {
  const std::string known =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,-_/:+=%() ";
  for (int code = 0; code < 256; ++code) {
    const auto letter = static_cast<char>(code);
    if (known.find(letter) != std::string::npos) continue;
    CAPTURE(code);
    CHECK(other_than({0, 0, 0}, text({letter}), {0, 0, 120, 20}) == 35);
  }
}

TEST_CASE("text that reaches over an edge of the picture is cut off there") {
  for (const int x : {-40, -8, -3, 0, 17, 19, 20, 50}) {
    for (const int y : {-30, -7, -4, 0, 8, 11, 12, 90}) {
      Image image(20, 12);
      draw_text(image, x, y, 1, "#", kWhite);
      const PixelBox box = {x, y, 5, 7};
      for (int row = 0; row < 12; ++row) {
        for (int column = 0; column < 20; ++column) {
          CHECK((image.at(column, row) == kWhite) == box.holds(column, row));
        }
      }
    }
  }
}

}  // namespace clothbrdf::test
