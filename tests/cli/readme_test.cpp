#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

// The README's blocks of one language.
std::vector<std::string> blocks(const std::string& language) {
  std::istringstream readme(read_file(std::filesystem::path(CLOTHBRDF_SOURCE_DIR) / "README.md"));
  std::vector<std::string> found;
  bool inside = false;
  for (std::string line; std::getline(readme, line);) {
    if (!inside && line == "```" + language) {
      inside = true;
      found.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      found.back() += line + '\n';
    }
  }
  return found;
}

// Timings differ from run to run, the last digits of exp and sin from processor to processor: the
// number before " s" is left out, long ones are rounded.
std::string masked(const std::string& text) {
  constexpr std::size_t kLong = 15;
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789.e-", at), text.size());
    const std::string word = text.substr(at, end - at);
    if (result.ends_with(" in ") && text.compare(end, 2, " s") == 0) {
      result += "...";
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
  CHECK(commands == 11);
}

TEST_CASE("the README's material is the preset silk") {
  const std::vector<std::string> materials = blocks("json");
  REQUIRE(materials.size() == 1);
  CHECK(materials[0] == read_file(preset("silk")));
}

}  // namespace clothbrdf::test
