#include <sys/resource.h>

#include <filesystem>
#include <iostream>

#include "tests/catch.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

}  // namespace

TEST_CASE("whatever once went wrong is taken or refused, and so are the fuzzers' seeds") {
  int inputs = 0;
  for (const FuzzTarget& target : fuzz_targets()) {
    std::vector<std::string> all = target.seeds();
    CHECK(!all.empty());
    const std::filesystem::path crashes =
        std::filesystem::path(CLOTHBRDF_SOURCE_DIR "/tests/fuzz/crashes") / target.name;
    if (std::filesystem::exists(crashes)) {
      for (const auto& entry : std::filesystem::directory_iterator(crashes))
        all.push_back(read_file(entry.path()));
    }
    for (const std::string& input : all) {
      CAPTURE(target.name, input.size());
      CHECK_NOTHROW(target.run(bytes_of(input)));
      CHECK_NOTHROW(target.run(bytes_of(input.substr(0, input.size() / 2))));
      ++inputs;
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  std::cout << inputs << " inputs, at most " << usage.ru_maxrss / 1024 << " MB" << std::endl;
#ifndef __SANITIZE_ADDRESS__
  CHECK(usage.ru_maxrss <= 512 * 1024);
#endif
}

}  // namespace clothbrdf::test
