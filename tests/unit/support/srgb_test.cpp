#include "support/srgb.h"

#include "tests/catch.h"

namespace clothbrdf::test {

TEST_CASE("sRGB is decoded and encoded as IEC 61966-2-1 has it") {
  // Values of the formula to 16 digits; pow costs a few roundings.
  constexpr double kRounding = 1e-15;
  CHECK(srgb_to_linear(0) == 0);
  CHECK(srgb_to_linear(1) == 1);
  CHECK(linear_to_srgb(0) == 0);
  CHECK_THAT(linear_to_srgb(1), Catch::Matchers::WithinAbs(1, kRounding));
  CHECK_THAT(srgb_to_linear(0.5), Catch::Matchers::WithinAbs(0.21404114048223255, kRounding));
  CHECK_THAT(linear_to_srgb(0.5), Catch::Matchers::WithinAbs(0.7353569830524495, kRounding));
  CHECK_THAT(srgb_to_linear(10.0 / 255), Catch::Matchers::WithinAbs(10 / 255.0 / 12.92, kRounding));
}

TEST_CASE("every byte of sRGB survives decoding and encoding, and brighter stays brighter") {
  constexpr double kRounding = 1e-15;  // no byte lies where the two parts of the curve meet
  double previous = -1;
  for (int byte = 0; byte <= 255; ++byte) {
    const double linear = srgb_to_linear(byte / 255.0);
    CHECK_THAT(linear_to_srgb(linear), Catch::Matchers::WithinAbs(byte / 255.0, kRounding));
    CHECK(linear > previous);
    previous = linear;
  }
}

TEST_CASE("where the parts of the sRGB curve meet, the way back is off by 1e-7 at most") {
  constexpr double kGap = 1e-7;
  for (const double encoded : {0.0404499, 0.04045, 0.0404501}) {
    CHECK_THAT(linear_to_srgb(srgb_to_linear(encoded)), Catch::Matchers::WithinAbs(encoded, kGap));
  }
}

}  // namespace clothbrdf::test
