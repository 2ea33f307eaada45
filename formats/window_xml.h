#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/atomic_file.h"
#include "table/table_spec.h"

namespace clothbrdf {

// Internal to formats/. The XML of LBNL WINDOW and Radiance, what its kinds have in common.

/// Whether two names are the same but for case and surrounding blanks, as Radiance compares them.
bool same_word(std::string_view a, std::string_view b);

/// A numbers' text of an XML file, read from its begin.
class NumberText {
 public:
  explicit NumberText(std::string_view text) : rest_(text) {}

  /// The next number, after blanks; none at the end or before anything else. A comma after it goes
  /// with it. What is too large for a double is infinite.
  std::optional<double> number();
  /// Takes the next character, after blanks, if it is this one.
  bool take(char wanted);
  /// The next character after blanks; 0 at the end.
  char peek();
  /// What comes next, for messages: at most 20 characters.
  std::string next_words();

 private:
  std::string_view rest_;
};

/// A number's text: with at most so many significant digits, or as few as bring the double back.
class NumberString {
 public:
  explicit NumberString(double value);
  NumberString(double value, int digits);
  std::string_view view() const { return {text_, static_cast<std::size_t>(end_ - text_)}; }

 private:
  char text_[32];
  const char* end_;
};

/// The data of one spectrum: its name in the file is Visible, CIE-X and so on.
struct ScatteringBlock {
  std::string_view numbers;
  std::string_view column_basis;  ///< empty where the file does not say
  std::string_view row_basis;
  std::string_view angle_basis;
};

/// A file's data of reflection at the front in Radiance's sense (+z): the blocks "Reflection Back",
/// since WINDOW counts a window's sides the other way round. Of several blocks of one spectrum the
/// last counts, as in Radiance.
class WindowFile {
 public:
  /// Throws InputError, in one line that starts with the file's name. Memory: about that of the
  /// file, and 60 bytes for each of its XML elements.
  explicit WindowFile(const std::filesystem::path& path);

  const std::string& name() const { return name_; }  ///< for messages
  /// "Columns", "Rows", "TensorTree3" or "TensorTree4".
  std::string_view structure() const { return structure_; }
  const ScatteringBlock& visible() const { return *find("Visible"); }
  /// Null where the file lacks it.
  const ScatteringBlock* find(std::string_view spectrum) const;

  [[noreturn]] void refuse(const std::string& what) const;

 private:
  std::string name_;
  std::vector<char> text_;  // the document points into it
  pugi::xml_document document_;
  std::string_view structure_;
  std::map<std::string, ScatteringBlock, std::less<>> blocks_;
};

/// Writes the XML around the data: gathers text and gives it to the file in large pieces.
class WindowWriter {
 public:
  /// Begins the file: what the table is made of, and `definition`, the text of DataDefinition.
  WindowWriter(AtomicFile& file, const TableSpec& spec, std::string_view definition);

  /// Begins the block of a spectrum; `bases` are the elements that name its angle bases.
  void begin_block(std::string_view spectrum, std::string_view bases);
  void end_block();
  void text(std::string_view text);
  /// The last call.
  void finish();

 private:
  void flush();

  AtomicFile& file_;
  std::uint64_t written_ = 0;
  std::string buffer_;
};

}  // namespace clothbrdf
