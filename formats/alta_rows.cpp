#include "formats/alta_rows.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>

#include "formats/json_text.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr std::string_view kSpace = " \t\r";

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

// The first word of a text, which is taken from it.
std::string_view next_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(kSpace));
  text.remove_prefix(word.size());
  return word;
}

// A line of a text, without its end, which is taken from it.
std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next != end) return std::nullopt;
  return number;
}

std::optional<double> real_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next != end) return std::nullopt;
  return number;
}

// Takes the header from the bytes: lines '#KEY value'; '# ' begins a comment. As ALTA does, up to
// the first other line or '#ALTA END HEADER'.
void take_header(std::string_view& bytes, AltaRows& rows, const std::string& name) {
  constexpr std::string_view kEnd = "#ALTA END HEADER\n";
  while (bytes.starts_with('#')) {
    std::string_view line = next_line(bytes);
    line.remove_prefix(1);
    if (line.starts_with(' ')) continue;
    const std::string key(next_word(line));
    if (key == "ALTA" && trimmed(line) == "END HEADER") return;
    if (key.empty() || key == "ALTA") continue;
    if (!rows.keys.emplace(key, trimmed(line)).second) {
      fail(name, "#" + one_line(key) + " is there twice");
    }
    if (key == "BEGIN_STREAM") {
      if (bytes.starts_with(kEnd)) bytes.remove_prefix(kEnd.size());
      return;
    }
  }
}

// Row lengths that a file claims must not ask for more than any real one.
constexpr std::size_t kMostOutputs = 4096;
constexpr std::size_t kMostInputs = 6;

void take_dimensions(AltaRows& rows, const std::string& name) {
  std::string_view text = rows.required("DIM", name);
  const auto inputs = whole_number(next_word(text));
  const auto outputs = whole_number(next_word(text));
  if (!inputs || !outputs || !trimmed(text).empty() || *inputs < 1 || *inputs > kMostInputs ||
      *outputs < 1 || *outputs > kMostOutputs) {
    fail(name, "#DIM is '" + one_line(rows.keys["DIM"]) +
                   "'; two whole numbers are allowed: coordinates, 1 to 6, and values, 1 to 4096");
  }
  rows.inputs = *inputs;
  rows.outputs = *outputs;
}

// 0, 1 or 2: how many numbers of confidence each value has.
std::size_t interval_kind(const AltaRows& rows, const std::string& name) {
  const auto found = rows.keys.find("VS");
  if (found == rows.keys.end()) return 0;
  const auto kind = whole_number(found->second);
  if (!kind || *kind > 2) {
    fail(name, "#VS is '" + one_line(found->second) + "'; 0, 1 and 2 are allowed");
  }
  return *kind;
}

std::optional<std::size_t> sample_count(const AltaRows& rows, const std::string& name) {
  const auto found = rows.keys.find("SAMPLE_COUNT");
  if (found == rows.keys.end()) return std::nullopt;
  const auto count = whole_number(found->second);
  if (!count || *count == 0) {
    fail(name,
         "#SAMPLE_COUNT is '" + one_line(found->second) + "'; a whole number from 1 up is allowed");
  }
  return count;
}

void read_text(std::string_view bytes, AltaRows& rows, const std::string& name) {
  const bool counted = rows.keys.contains("SAMPLE_COUNT");
  if (counted && !bytes.ends_with('\n'))
    fail(name, "the file is cut off: its last line has no end");
  const std::size_t columns = rows.inputs + rows.outputs;
  while (!bytes.empty()) {
    std::string_view line = next_line(bytes);
    if (line.starts_with('#') || trimmed(line).empty()) continue;
    const auto sample = [&, number = rows.count() + 1] {
      return "sample " + std::to_string(number);
    };
    std::size_t count = 0;
    while (!trimmed(line).empty()) {
      const std::string_view word = next_word(line);
      const auto number = real_number(word);
      if (!number) fail(name, sample() + ": '" + one_line(word) + "' is no number");
      if (count++ < columns) rows.numbers.push_back(*number);
    }
    if (count < columns || (count > columns && !rows.has_intervals)) {
      fail(name, sample() + " has " + std::to_string(count) + " numbers; " +
                     std::to_string(columns) + " are needed");
    }
  }
  if (counted && rows.count() != sample_count(rows, name)) {
    fail(name, std::to_string(rows.count()) + " samples; #SAMPLE_COUNT says " +
                   rows.keys["SAMPLE_COUNT"]);
  }
}

void read_binary(std::string_view bytes, std::size_t intervals, AltaRows& rows,
                 const std::string& name) {
  constexpr std::pair<std::string_view, std::string_view> kNeeded[] = {
      {"VERSION", "0"}, {"PRECISION", "ieee754-double"}, {"ENDIAN", "little"}};
  for (const auto& [key, value] : kNeeded) {
    if (rows.required(key, name) == value) continue;
    fail(name, "#" + std::string(key) + " is '" + one_line(rows.keys.find(key)->second) + "'; " +
                   std::string(value) + " is allowed");
  }
  static_cast<void>(rows.required("SAMPLE_COUNT", name));
  const std::size_t count = sample_count(rows, name).value_or(0);
  const std::size_t columns = rows.inputs + rows.outputs;
  const std::size_t row_bytes = (columns + intervals * rows.outputs) * sizeof(double);
  if (bytes.size() / row_bytes < count) {
    fail(name, "the file is too short for " + std::to_string(count) + " samples");
  }
  const std::string_view rest = bytes.substr(count * row_bytes);
  // ALTA ends its own files so.
  if (!rest.empty() && rest != "\n#END_STREAM\n" && rest != "\n#END_STREAM") {
    fail(name, "bytes follow the last sample");
  }
  const bool begun = rows.keys.contains("BEGIN_STREAM");
  if (begun && rest.empty()) fail(name, "the file is cut off: #END_STREAM is missing");
  rows.numbers.resize(count * columns);
  for (std::size_t row = 0; row < count; ++row) {
    std::memcpy(rows.numbers.data() + row * columns, bytes.data() + row * row_bytes,
                columns * sizeof(double));
  }
}

}  // namespace

const std::string& AltaRows::required(std::string_view key, const std::string& name) const {
  const auto found = keys.find(key);
  if (found == keys.end()) fail(name, "#" + std::string(key) + " is missing");
  return found->second;
}

AltaRows parse_alta(std::string_view bytes, const std::string& name) {
  AltaRows rows;
  take_header(bytes, rows, name);
  take_dimensions(rows, name);
  const std::size_t intervals = interval_kind(rows, name);
  rows.has_intervals = intervals > 0;
  const auto encoding = rows.keys.find("FORMAT");
  if (encoding == rows.keys.end() || encoding->second == "text") {
    read_text(bytes, rows, name);
  } else if (encoding->second == "binary") {
    read_binary(bytes, intervals, rows, name);
  } else {
    fail(name, "#FORMAT is '" + one_line(encoding->second) + "'; text and binary are allowed");
  }
  if (rows.numbers.empty()) fail(name, "the file has no samples");
  return rows;
}

}  // namespace clothbrdf
