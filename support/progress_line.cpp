#include "support/progress_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace clothbrdf {
namespace {

// Two or three digits and a suffix: "7.5", "83 k", "1.2 M".
std::string scaled(double value) {
  constexpr std::array<const char*, 6> kSuffixes = {"", " k", " M", " G", " T", " P"};
  // Beyond, the digits shown round to one more.
  constexpr double kMostUnscaled = 999.5;
  constexpr double kMostWithTenths = 9.95;
  std::size_t suffix = 0;
  for (; value >= kMostUnscaled && suffix + 1 < kSuffixes.size(); ++suffix) value /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, value < kMostWithTenths ? "%.1f%s" : "%.0f%s", value,
                kSuffixes[suffix]);
  return text;
}

// Small counts are exact.
std::string count_text(std::size_t count) {
  constexpr std::size_t kSmall = 10'000;
  return count < kSmall ? std::to_string(count) : scaled(static_cast<double>(count));
}

std::string rate_text(double per_second, const std::string& unit) {
  if (per_second >= 1) return scaled(per_second) + " " + unit + "/s";
  if (per_second * 60 >= 1) return scaled(per_second * 60) + " " + unit + "/min";
  return scaled(per_second * 3600) + " " + unit + "/h";
}

// Rounded up: there is time left until all is done.
std::string time_left(double seconds) {
  struct Unit {
    double seconds;
    const char* name;
  };
  constexpr std::array<Unit, 4> kUnits = {{{1, "s"}, {60, "min"}, {3600, "h"}, {86400, "days"}}};
  constexpr double kMost = 99;
  std::size_t unit = 0;
  while (unit + 1 < kUnits.size() && seconds > kMost * kUnits[unit].seconds) ++unit;
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %s left", std::ceil(seconds / kUnits[unit].seconds),
                kUnits[unit].name);
  return text;
}

bool starts_character(char byte) {  // of UTF-8
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

// Columns that a character takes at most: those beyond ASCII can be wide.
std::size_t columns_of(char first_byte) {
  if (!starts_character(first_byte)) return 0;
  return static_cast<unsigned char>(first_byte) < 0x80U ? 1 : 2;
}

// As much of a text's beginning as fits, in whole characters.
std::string cut(const std::string& text, std::size_t columns) {
  std::size_t end = 0;
  for (std::size_t used = 0; end < text.size(); ++end) {
    used += columns_of(text[end]);
    if (used > columns) break;
  }
  return text.substr(0, end);
}

}  // namespace

std::string progress_line(const Progress::Snapshot& phase, double seconds, std::size_t columns) {
  std::string numbers;
  if (phase.total > 0) {
    const auto done = static_cast<double>(phase.done);
    const auto total = static_cast<double>(phase.total);
    // 100 % is for what is done.
    numbers = ": " + std::to_string(static_cast<int>(100 * done / total)) + " %, " +
              count_text(phase.done) + " of " + count_text(phase.total) + " " + phase.unit;
    if (phase.done > 0 && seconds > 0) {
      numbers += ", " + rate_text(done / seconds, phase.unit) + ", " +
                 time_left((total - done) * seconds / done);
    }
  }
  constexpr std::size_t kShortestName = 8;
  const std::size_t room = columns > numbers.size() ? columns - numbers.size() : 0;
  std::string name = phase.what;
  // It may hold anything.
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  return cut(cut(name, std::max(room, kShortestName)) + numbers, columns);
}

}  // namespace clothbrdf
