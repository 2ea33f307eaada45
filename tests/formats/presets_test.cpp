#include "formats/presets.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/material_json.h"
#include "tests/catch.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

TEST_CASE("the presets inside the program are the files of materials/") {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(preset("silk").parent_path())) {
    REQUIRE(entry.path().extension() == ".json");
    files.push_back(entry.path().stem().string());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> names;
  for (const Preset& embedded : presets()) {
    names.emplace_back(embedded.name);
    CHECK(embedded.text == read_file(preset(names.back())));
    REQUIRE(find_preset(embedded.name) != nullptr);
    CHECK(find_preset(embedded.name)->text == embedded.text);
  }
  CHECK(names == files);
  CHECK(find_preset("silc") == nullptr);
  CHECK(find_preset("") == nullptr);
}

TEST_CASE("each preset has its file's name, a description of one line, and can be dyed") {
  for (const Preset& embedded : presets()) {
    const std::string name(embedded.name);
    const Material material = parse_material(embedded.text, name);
    CAPTURE(name);
    CHECK(material.name == name);
    CHECK(material.description.size() > 40);
    CHECK(material.description.find_first_of("\r\n") == std::string::npos);
    CHECK(material.description.ends_with("."));
    CHECK(material.wavelengths_nm.empty());
    CHECK(material.diffuse_path > 0);
    CHECK((material.reflectance == Reflectance::kPaper) == name.ends_with("_paper"));
  }
}

TEST_CASE("the presets' weaves show the share of warp that their descriptions name") {
  const auto share = [](const char* name) { return read_material(preset(name)).warp_fraction; };
  CHECK(share("satin") == 7.0 / 8);
  CHECK(share("denim") == 3.0 / 4);
  for (const char* plain : {"silk", "cotton", "tamamushi", "nylon", "linen"}) {
    CHECK(share(plain) == 1.0 / 2);
  }
}

}  // namespace clothbrdf::test
