#include <cerrno>
#include <cstring>
#include <iostream>

#include "tests/catch.h"
#include "tests/faults/faults.h"

// Every call that writes a file is disturbed in turn.

namespace clothbrdf::test {

TEST_CASE("files are written by calls that can be disturbed, and opened through no link") {
  for (const Situation& situation : situations()) {
    const std::vector<std::string> calls = Place(situation).calls();
    const auto count = [&](const char* call) {
      return std::count(calls.begin(), calls.end(), call);
    };
    const auto [writer, with_old, names_needed] = situation;
    CAPTURE(writer.name, with_old, names_needed, calls);
    CHECK(count("open nameless") == (names_needed ? 0 : 1));
    CHECK(count("open fresh") == (names_needed ? 1 : 0));
    CHECK(count("open") == 0);
    CHECK(count("write") >= 1);
    CHECK(count("close") == 2);
    CHECK(count("linkat") == (names_needed ? 0 : with_old ? 2 : 1));
    CHECK(count("rename") == (names_needed || with_old ? 1 : 0));
  }
}

TEST_CASE("a call that fails makes each writer fail, and the old file stays") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  int faults = 0;
  for (const Situation& situation : situations()) {
    const Place place(situation);
    const std::vector<std::string> calls = place.calls();
    for (const int error : {ENOSPC, EIO}) {
      for (const long at : chosen_calls(calls.size(), random)) {
        const Outcome outcome = place.run({"error", at, error});
        const std::string& call = calls[static_cast<std::size_t>(at) - 1];
        CAPTURE(situation.writer.name, situation.with_old, situation.names_needed, at, call, seed);
        // A file that has its name already is closed at last: nothing is lost where that fails.
        const bool whole = call == "close" && at == static_cast<long>(calls.size());
        CHECK((whole ? not_a_clean_success(outcome, place)
                     : not_a_clean_failure(outcome, place, std::strerror(error))) == "");
        ++faults;
      }
    }
  }
  std::cout << "seed " << seed << ": " << faults << " faults" << std::endl;
}

TEST_CASE("on a disk that is full after any block each writer fails, and the old file stays") {
  constexpr int kBlock = 4096;
  constexpr int kMost = 16;  // of a file, spread evenly
  int faults = 0;
  for (const Writer& writer : writers()) {
    const Place place({writer});
    const int blocks = (static_cast<int>(place.expected().size()) + kBlock - 1) / kBlock;
    const int chosen = std::min(blocks, writer.slow ? 4 : kMost);
    for (int k = 0; k < chosen; ++k) {
      const long room = static_cast<long>(k) * (blocks - 1) / std::max(chosen - 1, 1) * kBlock;
      const Outcome outcome = place.run({"disk", room});
      CAPTURE(writer.name, room, place.expected().size());
      CHECK(not_a_clean_failure(outcome, place, "No space left on device") == "");
      ++faults;
    }
  }
  std::cout << faults << " full disks" << std::endl;
}

TEST_CASE("interrupted calls and short writes change no byte") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  int faults = 0;
  for (const Situation& situation : situations()) {
    const Place place(situation);
    const auto check = [&](const Fault& fault) {
      CAPTURE(situation.writer.name, situation.with_old, situation.names_needed, fault.kind,
              fault.at, seed);
      CHECK(not_a_clean_success(place.run(fault), place) == "");
      ++faults;
    };
    check({"crumbs"});
    if (situation.writer.slow) continue;
    const std::vector<std::string> calls = place.calls();
    for (const long at : chosen_calls(calls.size(), random)) {
      check({"once", at, EINTR});
      if (calls[static_cast<std::size_t>(at) - 1] == "write") check({"short", at});
    }
  }
  std::cout << "seed " << seed << ": " << faults << " faults" << std::endl;
}

TEST_CASE("space that cannot be set aside for another reason than a full disk does no harm") {
  for (const Writer& writer : writers()) {
    if (writer.slow) continue;
    const Place place({writer});
    const std::vector<std::string> calls = place.calls();
    const auto found = std::find(calls.begin(), calls.end(), "fallocate");
    if (found == calls.end()) continue;
    CAPTURE(writer.name);
    for (const int error : {EOPNOTSUPP, EIO}) {
      const Fault fault{"once", found - calls.begin() + 1, error};
      CHECK(not_a_clean_success(place.run(fault), place) == "");
    }
  }
}

}  // namespace clothbrdf::test
