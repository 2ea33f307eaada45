#include "formats/json_text.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "support/errors.h"

namespace clothbrdf {

namespace {

using nlohmann::json;

struct TextPlace {
  std::size_t line = 1;
  std::size_t column = 1;  // in characters
};

// `offset` may be one past the end.
TextPlace place_of(std::string_view text, std::size_t offset) {
  TextPlace place;
  for (const char c : text.substr(0, offset)) {
    if (c == '\n') {
      ++place.line;
      place.column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++place.column;
    }
  }
  return place;
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' ||
         c == '+';
}

// The word around `offset`, for instance "NaN" at any of its letters; a single character elsewhere.
std::string_view word_at(std::string_view text, std::size_t offset) {
  if (offset >= text.size()) return {};
  std::size_t begin = offset;
  std::size_t end = offset;
  while (begin > 0 && is_word(text[begin - 1]) && is_word(text[offset])) --begin;
  while (end < text.size() && is_word(text[end])) ++end;
  return text.substr(begin, std::max<std::size_t>(end - begin, 1));
}

// Of "[json.exception...] parse error at line 1, column 2: syntax error while parsing value -
// invalid literal; last read: '...'" only "invalid literal": the rest repeats the input, however
// long it is.
std::string short_reason(std::string_view what) {
  const std::size_t dash = what.find(" - ");
  if (dash != std::string_view::npos) what.remove_prefix(dash + 3);
  const std::size_t read = what.find("; last read: ");
  if (read == std::string_view::npos) return one_line(what, 100);
  const std::size_t expected = what.rfind("; expected ");
  std::string reason = one_line(what.substr(0, read), 100);
  if (expected != std::string_view::npos && expected > read) {
    reason += one_line(what.substr(expected), 60);
  }
  return reason;
}

// Builds the value from the parser's events, without recursion, and refuses what the parser lets
// pass.
class StrictBuilder {
 public:
  using number_integer_t = json::number_integer_t;
  using number_unsigned_t = json::number_unsigned_t;
  using number_float_t = json::number_float_t;
  using string_t = json::string_t;
  using binary_t = json::binary_t;

  StrictBuilder(std::string_view text, const std::string& file_name)
      : text_(text), file_name_(file_name) {}

  json take() { return std::move(root_); }

  bool null() { return put(nullptr); }
  bool boolean(bool value) { return put(value); }
  bool number_integer(number_integer_t value) { return put(value); }
  // Above 2^63 as a double: valijson reads integers as int64 and would see a negative one.
  bool number_unsigned(number_unsigned_t value) {
    if (value <= std::uint64_t{INT64_MAX}) return put(value);
    return put(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t& /*token*/) { return put(value); }
  bool string(string_t& value) { return put(std::move(value)); }
  bool binary(binary_t& /*value*/) { return false; }  // not in JSON text

  bool start_object(std::size_t /*elements*/) { return open(json::object()); }
  bool start_array(std::size_t /*elements*/) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(string_t& name) {
    Level& level = levels_.back();
    level.key = std::move(name);
    if (level.value->contains(*level.key)) {
      fail(pointer() + ": this key is there twice; once is allowed");
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const json::exception& error) {
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow) {
      fail((levels_.empty() ? "" : pointer() + ": ") + one_line(token) +
           " is not allowed: a number that a double can hold (at most 1.797e308)");
    }
    const std::size_t offset = std::min(position == 0 ? 0 : position - 1, text_.size());
    const std::string_view word = word_at(text_, offset);
    const TextPlace place = place_of(
        text_, word.empty() ? offset : static_cast<std::size_t>(word.data() - text_.data()));
    std::string message =
        "line " + std::to_string(place.line) + ", column " + std::to_string(place.column);
    const std::string near = pointer();
    if (!near.empty()) message += ", near " + near;
    std::string reason = short_reason(error.what());
    if (reason == "invalid literal") {
      reason = "a value is a finite number, a string, true, false, null, [...] or {...}";
    }
    message += ": not JSON: " + reason;
    if (!word.empty() && word[0] > ' ' && word != "\"")
      message += "; found " + json(one_line(word, 40)).dump(-1, ' ', true, kReplace);
    fail(message);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(one_line(file_name_, kLongestFileName) + ": " + message);
  }

 private:
  static constexpr auto kReplace = json::error_handler_t::replace;

  struct Level {
    json* value;
    std::optional<std::string> key;  // of an object, once there is one
  };

  json* append(json value) {
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = levels_.back();
    if (level.value->is_object()) return &((*level.value)[*level.key] = std::move(value));
    level.value->push_back(std::move(value));
    return &level.value->back();
  }

  bool put(json value) {
    append(std::move(value));
    return true;
  }

  bool open(json container) {
    if (levels_.size() == kMaxJsonDepth) {
      fail(pointer() + ": nested too deep: at most " + std::to_string(kMaxJsonDepth) +
           " levels are allowed");
    }
    levels_.push_back({append(std::move(container)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  // Of the value that is being read.
  std::string pointer() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.value->is_object()) {
        if (level.key) text += pointer_step(*level.key);
      } else {
        // Of an inner level the array's last element is the one that is open.
        const bool innermost = &level == &levels_.back();
        text += "/" + std::to_string(level.value->size() - (innermost ? 0 : 1));
      }
    }
    return text;
  }

  std::string_view text_;
  const std::string& file_name_;
  json root_;
  std::vector<Level> levels_;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string one_line(std::string_view text, std::size_t longest) {
  const bool cut = text.size() > longest;
  if (cut) {
    std::size_t end = longest - 3;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    text = text.substr(0, end);
  }
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // C1 controls (U+0080..U+009F) steer terminals, too.
    const bool c1 = byte >= 0x80U && byte < 0xA0U && !line.empty() && line.back() == '\xC2';
    if (c1) line.pop_back();
    line += byte < 0x20U || byte == 0x7FU || c1 ? '?' : c;
  }
  return cut ? line + "..." : line;
}

namespace {

using Ordered = nlohmann::ordered_json;

std::string on_one_line(const Ordered& value) {
  if (!value.is_structured()) return value.dump(-1, ' ', false, Ordered::error_handler_t::replace);
  const bool object = value.is_object();
  std::string text;
  for (const auto& [key, child] : value.items()) {
    if (!text.empty()) text += ", ";
    if (object) text += on_one_line(Ordered(key)) + ": ";
    text += on_one_line(child);
  }
  return object ? "{" + text + "}" : "[" + text + "]";
}

// `column`: where the value begins on its line.
std::string laid_out(const Ordered& value, std::size_t indent, std::size_t column) {
  constexpr std::size_t kColumns = 100;
  std::string line = on_one_line(value);
  // One more for the comma. A whole file is broken up, however short.
  const bool fits = line.size() + column + 1 <= kColumns && indent > 0;
  if (!value.is_structured() || value.empty() || fits) return line;
  const bool object = value.is_object();
  const std::string start = "\n" + std::string(indent + 2, ' ');
  std::string text;
  for (const auto& [key, child] : value.items()) {
    const std::string name = object ? on_one_line(Ordered(key)) + ": " : "";
    if (!text.empty()) text += ',';
    text += start;
    text += name;
    text += laid_out(child, indent + 2, indent + 2 + name.size());
  }
  text += "\n" + std::string(indent, ' ');
  return object ? "{" + text + "}" : "[" + text + "]";
}

}  // namespace

std::string laid_out(const nlohmann::ordered_json& value) { return laid_out(value, 0, 0) + "\n"; }

std::string pointer_step(std::string_view key) {
  std::string escaped = "/";
  for (const char c : key.substr(0, 200)) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  return one_line(escaped);
}

std::string read_json_file(const std::filesystem::path& path) {
  const std::string name = one_line(path.string(), kLongestFileName);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(name + ": is a directory; a JSON file is needed");
  }
  const auto cannot_read = [&] {
    return InputError(name + ": cannot be read: " + std::strerror(errno));
  };
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    if (errno == ENOENT) throw InputError(name + ": there is no such file");
    throw cannot_read();
  }
  // Not by the file's size: a pipe has none, and a file can grow.
  std::string text;
  std::vector<char> block(1U << 16U);
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    text.append(block.data(), count);
    if (text.size() > kMaxJsonBytes) break;  // parse_json refuses it
  }
  if (std::ferror(file.get()) != 0) throw cannot_read();
  return text;
}

nlohmann::json parse_json(std::string_view text, const std::string& file_name) {
  StrictBuilder builder(text, file_name);
  if (text.size() > kMaxJsonBytes) {
    builder.fail("too large: at most " + std::to_string(kMaxJsonBytes >> 20U) + " MiB are allowed");
  }
  // The parser takes a zero byte for the end of the text and would not see what follows.
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    const TextPlace place = place_of(text, zero);
    builder.fail("line " + std::to_string(place.line) + ", column " + std::to_string(place.column) +
                 ": not JSON: a zero byte");
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    builder.fail("is empty; a JSON object is needed");
  }
  json::sax_parse(text, &builder);
  return builder.take();
}

void put(nlohmann::ordered_json& object, const char* key, double value) {
  if (std::isfinite(value)) object[key] = value;
}

void put(nlohmann::ordered_json& object, const char* key, const std::optional<double>& value) {
  if (value) put(object, key, *value);
}

void put_words(nlohmann::ordered_json& object, const char* key, const std::string& words) {
  if (!words.empty()) object[key] = words;
}

}  // namespace clothbrdf
