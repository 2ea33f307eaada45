#include "formats/colour.h"

#include <cmath>

#include "model/reflectance.h"
#include "support/srgb.h"
#include "tests/catch.h"

namespace clothbrdf::test {

TEST_CASE("a colour is three or six hexadecimal digits, with or without '#'") {
  const Colour rose = {{0xb0, 0x30, 0x60}};
  for (const char* text : {"#b03060", "b03060", "#B03060", "B03060"}) {
    CAPTURE(text);
    CHECK(parse_colour(text) == rose);
  }
  CHECK(parse_colour("#b36") == Colour{{0xbb, 0x33, 0x66}});
  CHECK(parse_colour("b36") == Colour{{0xbb, 0x33, 0x66}});
  CHECK(parse_colour("000000") == Colour{});
  CHECK(colour_text(rose) == "#b03060");
  CHECK(colour_text({{0, 0x0a, 0xff}}) == "#000aff");
}

TEST_CASE("any other text is no colour") {
  for (const char* text : {"", "#", "#b0306", "#b030600", "##b03060", "b03060#", "#g03060",
                           "#b0306g", " b03060", "b03060 ", "-b0-30", "+1+2+3", "0x1122", "red"}) {
    CAPTURE(text);
    CHECK(!parse_colour(text));
  }
}

TEST_CASE("a yarn's diffuse colour is the one its absorption was made of") {
  // -ln, times and divided by the path, exp: a rounding each, magnified by -ln(linear) below 9.
  constexpr double kRounding = 4e-15;
  int colours = 0;
  for (const double diffuse_path : {0.5, 1.0, 1.5, 2.0, 100.0}) {
    for (int byte = 0; byte <= 255; ++byte) {
      const auto channel = static_cast<std::uint8_t>(byte);
      const Colour colour = {{channel, 255, 0}};
      const std::vector<double> absorption = absorption_of(colour, diffuse_path);
      REQUIRE(absorption.size() == 3);
      for (std::size_t c = 0; c < absorption.size(); ++c) {
        CHECK(std::isfinite(absorption[c]));
        CHECK(absorption[c] >= 0);
        CHECK_THAT(diffuse_colour(absorption[c], diffuse_path),
                   Catch::Matchers::WithinRel(linear_colour(colour)[c], kRounding));
      }
      if (byte > 0) CHECK(linear_colour(colour)[0] == srgb_to_linear(byte / 255.0));
      CHECK(absorption[1] == 0);
      CHECK(!std::signbit(absorption[1]));
      ++colours;
    }
  }
  CHECK(colours == 5 * 256);
}

TEST_CASE("a channel of 0 counts as half a byte") {
  CHECK(linear_colour({})[0] == srgb_to_linear(0.5 / 255));
  CHECK(linear_colour({})[0] < linear_colour({{1, 1, 1}})[0]);
}

}  // namespace clothbrdf::test
