#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/support/document_blocks.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

std::vector<std::string> blocks(const std::string& language) {
  return blocks_of(std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "README.md", language);
}

// How a solver ended, to the next line of the summary: its last steps are rounding.
std::string without_solver(const std::string& text) {
  const std::string label = "\n  solver ";
  const std::size_t from = text.find(label);
  if (from == std::string::npos) return text;
  std::size_t to = text.find('\n', from + 1);
  while (text.compare(to, 4, "\n   ") == 0) to = text.find('\n', to + 1);
  return text.substr(0, from + label.size()) + "..." + text.substr(to);
}

bool is_number(const std::string& word) {
  const std::size_t first = word.starts_with('-') ? 1 : 0;
  return first < word.size() && word[first] >= '0' && word[first] <= '9';
}

// Timings differ from run to run, the last digits of exp and sin from processor to processor: the
// number of seconds is left out, one that is only rounding becomes 0 (without the spaces that fill
// its column), long ones are rounded.
std::string masked(const std::string& session) {
  constexpr std::size_t kLong = 15;
  constexpr double kRounding = 1e-8;
  const std::string text = without_solver(session);
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(text.find_first_not_of("0123456789.e-", at), text.size());
    const std::string word = text.substr(at, end - at);
    const bool seconds = result.ends_with(" in ") || result.ends_with("\n  time        ");
    if (seconds && text.compare(end, 2, " s") == 0) {
      result += "...";
    } else if (is_number(word) && word.find("e-") != std::string::npos &&
               std::abs(std::stod(word)) < kRounding) {
      result += "0";
      while (text.compare(end, 2, "  ") == 0) ++end;
    } else if (word.size() >= kLong && word.find('.') != std::string::npos) {
      std::ostringstream rounded;
      rounded << std::setprecision(12) << std::stod(word);
      result += rounded.str();
    } else {
      result += word;
    }
    if (end < text.size()) result += text[end];
    at = end + 1;
  }
  return result;
}

}  // namespace

TEST_CASE("the README's session runs as printed") {
  const TemporaryFolder folder;
  std::filesystem::create_directory_symlink(
      std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "materials", folder / "materials");
  std::filesystem::create_directory_symlink(
      std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "examples", folder / "examples");
  const std::string start = "cd '" + folder.path().string() + "' && PATH='" +
                            std::filesystem::path(CLOTHBRDF_PROGRAM).parent_path().string() +
                            "':\"$PATH\" && ";
  int commands = 0;
  for (const std::string& block : blocks("console")) {
    std::istringstream lines(block);
    std::string line;
    REQUIRE(std::getline(lines, line));
    REQUIRE(line.starts_with("$ "));
    std::string expected;
    for (std::string output; std::getline(lines, output);) expected += output + '\n';
    const std::filesystem::path printed = folder / "printed";
    static_cast<void>(std::system(
        (start + "{ " + line.substr(2) + "; } >'" + printed.string() + "' 2>&1").c_str()));
    INFO(line);
    CHECK(masked(read_file(printed)) == masked(expected));
    ++commands;
  }
  CHECK(commands == 15);
}

TEST_CASE("the README's material is the preset silk") {
  const std::vector<std::string> materials = blocks("json");
  REQUIRE(materials.size() == 1);
  CHECK(materials[0] == read_file(preset("silk")));
}

}  // namespace clothbrdf::test
