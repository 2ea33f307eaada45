#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <regex>
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

// Timings differ from run to run, the last digits of exp and sin from processor to processor.
std::string masked(const std::string& text) {
  const std::string timeless = std::regex_replace(text, std::regex(" in [0-9.e-]+ s"), " in ... s");
  static const std::regex kLongNumber("[0-9]\\.[0-9]{13,}");
  std::string result;
  auto from = timeless.cbegin();
  for (std::sregex_iterator at(from, timeless.cend(), kLongNumber), end; at != end; ++at) {
    result.append(from, timeless.cbegin() + at->position());
    std::ostringstream rounded;
    rounded << std::setprecision(12) << std::stod(at->str());
    result += rounded.str();
    from = timeless.cbegin() + at->position() + at->length();
  }
  return result.append(from, timeless.cend());
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
  CHECK(commands == 5);
}

TEST_CASE("the README's material is the preset silk") {
  const std::vector<std::string> materials = blocks("json");
  REQUIRE(materials.size() == 1);
  CHECK(materials[0] == read_file(preset("silk")));
}

}  // namespace clothbrdf::test
