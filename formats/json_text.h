#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace clothbrdf {

// Internal to formats/: what all our JSON inputs share.

/// Our JSON inputs are written by people or hold a report; the largest, a fit report, stays below
/// 1 MiB. The limit keeps a wrong file name (a table of gigabytes) from filling the memory: once
/// parsed, a file takes up to 30 times its size.
inline constexpr std::size_t kMaxJsonBytes = 16U << 20U;

/// Our schemas nest 8 deep at most. The limit bounds every recursion over a parsed file.
inline constexpr std::size_t kMaxJsonDepth = 32;

/// Bytes of a file's name that messages show.
inline constexpr std::size_t kLongestFileName = 1000;

/// The text of a file of at most kMaxJsonBytes. Throws InputError in one line that starts with the
/// path.
std::string read_json_file(const std::filesystem::path& path);

/// Parses one JSON value (RFC 8259, UTF-8). Throws InputError in one line that starts with
/// `file_name`: not JSON (with line and column), duplicate keys, numbers that overflow a double,
/// nesting deeper than kMaxJsonDepth, too long.
nlohmann::json parse_json(std::string_view text, const std::string& file_name);

/// `text` on one line of at most `longest` bytes, whole UTF-8 characters: control characters become
/// '?', the rest
/// "...".
std::string one_line(std::string_view text, std::size_t longest = 60);

/// The text of a file that holds `value`: what fits goes on a line of its own, the rest is broken
/// up. Bytes that are no UTF-8 are replaced, so that what is written can be read.
std::string laid_out(const nlohmann::ordered_json& value);

/// Sets a member where there is something to say: JSON has no word for numbers that are not finite.
void put(nlohmann::ordered_json& object, const char* key, double value);
void put(nlohmann::ordered_json& object, const char* key, const std::optional<double>& value);
void put_words(nlohmann::ordered_json& object, const char* key, const std::string& words);

/// A step of a JSON pointer, "/name" (RFC 6901), fit for a message.
std::string pointer_step(std::string_view key);

}  // namespace clothbrdf
