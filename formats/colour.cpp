#include "formats/colour.h"

#include <cassert>
#include <charconv>
#include <cmath>

#include "support/srgb.h"

namespace clothbrdf {

std::optional<Colour> parse_colour(std::string_view text) {
  if (text.starts_with('#')) text.remove_prefix(1);
  std::string digits(text);
  if (text.size() == 3) digits = {text[0], text[0], text[1], text[1], text[2], text[2]};
  if (digits.size() != 6) return std::nullopt;
  Colour colour;
  const char* at = digits.data();
  for (std::uint8_t& channel : colour.srgb) {
    const auto [next, error] = std::from_chars(at, at + 2, channel, 16);
    if (error != std::errc() || next != at + 2) return std::nullopt;
    at = next;
  }
  return colour;
}

std::string colour_text(const Colour& colour) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const unsigned channel : colour.srgb) {
    text += kDigits[channel / 16];
    text += kDigits[channel % 16];
  }
  return text;
}

std::array<double, 3> linear_colour(const Colour& colour) {
  constexpr double kDarkest = 0.5;
  std::array<double, 3> linear{};
  for (std::size_t c = 0; c < linear.size(); ++c) {
    linear[c] = srgb_to_linear(std::fmax(colour.srgb[c], kDarkest) / 255);
  }
  return linear;
}

std::vector<double> absorption_of(const Colour& colour, double diffuse_path) {
  assert(diffuse_path > 0);
  std::vector<double> absorption;
  for (const double linear : linear_colour(colour)) {
    // linear is at most 1; fabs makes 0 of the -0 that -ln 1 is.
    absorption.push_back(std::fabs(std::log(linear)) / diffuse_path);
  }
  return absorption;
}

}  // namespace clothbrdf
