// The program that libFuzzer drives: of the targets, the one that CLOTHBRDF_FUZZ_TARGET names. With
// --list it prints their names; with --seeds FOLDER it writes their seeds, a folder each.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string_view>

#include "tests/fuzz/fuzz_targets.h"

namespace {

using clothbrdf::test::FuzzTarget;

const FuzzTarget& chosen_target() {
  static const FuzzTarget kTarget = [] {
    const char* const name = std::getenv("CLOTHBRDF_FUZZ_TARGET");
    for (const FuzzTarget& target : clothbrdf::test::fuzz_targets()) {
      if (name != nullptr && target.name == name) return target;
    }
    throw std::runtime_error("CLOTHBRDF_FUZZ_TARGET names no target");
  }();
  return kTarget;
}

void write_seeds(const std::filesystem::path& folder) {
  for (const FuzzTarget& target : clothbrdf::test::fuzz_targets()) {
    std::filesystem::create_directories(folder / target.name);
    int number = 0;
    for (const std::string& seed : target.seeds()) {
      const std::string name = "seed" + std::to_string(number++);
      std::ofstream(folder / target.name / name, std::ios::binary) << seed;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const std::string_view option = *argc > 1 ? (*argv)[1] : "";
  if (option == "--list") {
    for (const FuzzTarget& target : clothbrdf::test::fuzz_targets())
      std::cout << target.name << '\n';
    std::cout.flush();
    std::_Exit(0);
  }
  if (option == "--seeds" && *argc > 2) {
    write_seeds((*argv)[2]);
    std::_Exit(0);
  }
  chosen_target();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  chosen_target().run({data, size});
  return 0;
}
