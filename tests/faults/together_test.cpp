#include <iostream>

#include "tests/catch.h"
#include "tests/faults/faults.h"

// Two processes that write the same name.

namespace clothbrdf::test {
namespace {

// Another table under the same name, of about as many bytes.
Arguments other_arguments(const Place& place) {
  Arguments arguments = place.arguments();
  *std::find(arguments.begin(), arguments.end(), "diffuse") = "specular";
  return arguments;
}

std::string other_bytes(const Place& place) {
  output_of(other_arguments(place));
  std::string bytes = read_file(place.file());
  place.reset();
  REQUIRE(bytes != place.expected());
  return bytes;
}

}  // namespace

TEST_CASE("of two processes that write the same name at once one leaves its whole file") {
  constexpr int kRounds = 40;
  for (const Situation& situation : situations()) {
    if (situation.writer.name != plain_writer().name) continue;
    const Place place(situation);
    const std::string other = other_bytes(place);
    int others = 0;
    for (int k = 0; k < kRounds; ++k) {
      place.reset();
      RunningProgram first(place.arguments(), place.options());
      RunningProgram second(other_arguments(place), place.options());
      CAPTURE(situation.with_old, situation.names_needed, k);
      CHECK(first.wait().exit_code == 0);
      CHECK(second.wait().exit_code == 0);
      const std::string bytes = read_file(place.file());
      CHECK((bytes == place.expected() || bytes == other));
      CHECK(place.strays().empty());
      others += bytes == other ? 1 : 0;
    }
    std::cout << (situation.with_old ? "over an old file: " : "a new name: ") << kRounds
              << " rounds, the second's file stayed in " << others << std::endl;
  }
}

TEST_CASE("whatever another process writes between two calls, the later one leaves its file") {
  for (const Situation& situation : situations()) {
    if (situation.writer.name != plain_writer().name) continue;
    const Place place(situation);
    const std::string other = other_bytes(place);
    const std::vector<std::string> calls = place.calls();
    for (long at = 1; at <= static_cast<long>(calls.size()); ++at) {
      place.reset();
      RunningProgram first(place.arguments(), place.options({"stop", at}));
      REQUIRE(wait_until_stopped(first));
      CAPTURE(situation.with_old, situation.names_needed, at, calls);
      // A file that has its name before the other one comes is replaced.
      const bool done = place.state() == "new";
      const Outcome second = run_program(other_arguments(place), place.options());
      CHECK(second.exit_code == 0);
      CHECK(read_file(place.file()) == other);
      first.send(SIGCONT);
      CHECK(first.wait().exit_code == 0);
      CHECK(read_file(place.file()) == (done ? other : place.expected()));
      CHECK(place.strays().empty());
    }
  }
}

}  // namespace clothbrdf::test
