#pragma once

#include <string>
#include <vector>

#include "formats/format.h"
#include "tests/support/commands.h"

namespace clothbrdf::test {

/// A command that writes a small file in milliseconds, always the same bytes.
struct Writer {
  std::string name;     ///< of the file
  Arguments arguments;  ///< all but the file
  bool slow = false;    ///< it computes for a tenth of a second or more
};

/// Of every format that there is, and of the other files that commands write.
inline std::vector<Writer> writers(const std::string& threads = "1") {
  std::vector<Writer> all;
  const auto add = [&](const std::string& name, const Arguments& options, bool slow = false) {
    Arguments arguments = {"tabulate", kSilk, "--threads", threads, "--effects", "diffuse"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.emplace_back("-o");
    all.push_back({name, arguments, slow});
  };
  for (const Format& format : formats()) {
    const std::string ending(format.ending);
    const std::string name = "silk" + ending;
    if (ending == ".exr" || ending == ".alta" || ending == ".dat") {
      add(name, {"--grid", "halfdiff4d:8x8x8x8"});
    } else if (ending == ".bsdf") {
      add(name, {"--size", "74000", "--isotropic"});
    } else if (ending == ".mbsdf") {
      add(name, {"--size", "10000"});
    } else {
      add(name, {}, ending.ends_with(".xml"));
    }
  }
  add("compressed.exr", {"--grid", "halfdiff4d:8x8x8x8", "--compress"});
  all.push_back({"sheet.png", {"preview", kSilk, "--threads", threads, "--size", "16", "-o"}});
  all.push_back({"new.json", {"new", "silk", "-o"}});
  return all;
}

}  // namespace clothbrdf::test
