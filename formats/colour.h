#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clothbrdf {

/// A colour as people give it: sRGB, a byte for each of red, green and blue.
struct Colour {
  std::array<std::uint8_t, 3> srgb{};

  bool operator==(const Colour&) const = default;
};

/// What parse_colour takes, for messages.
inline constexpr const char* kColourAllowed =
    "three or six hexadecimal digits, '#' before them or not, as in #b03060";

/// "#b03060", "b03060" or "#b36" (each digit twice, #bb3366), small or capital letters; none for
/// any other text.
std::optional<Colour> parse_colour(std::string_view text);

/// "#b03060".
std::string colour_text(const Colour& colour);

/// The colour as linear Rec. 709, each channel above 0 and at most 1: a byte of 0, which no finite
/// absorption reaches, counts as half a byte.
std::array<double, 3> linear_colour(const Colour& colour);

/// Absorption of a yarn whose diffuse colour is the one asked for: kappa = -ln(linear) /
/// diffuse_path, the inverse of rho = exp(-kappa diffuse_path). diffuse_path, in layer thicknesses,
/// is above 0; asserted.
std::vector<double> absorption_of(const Colour& colour, double diffuse_path);

}  // namespace clothbrdf
