#include <iostream>
#include <thread>

#include "tests/catch.h"
#include "tests/faults/faults.h"

namespace clothbrdf::test {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

/// How many runs ended how.
struct SignalTally {
  int stopped = 0;  // by the signal
  int kept_old = 0;
  int made_new = 0;
};

// A signal that comes after the end stops nothing.
void check_signalled(const Outcome& outcome, int signal, const Place& place, SignalTally& tally) {
  const std::string state = place.state();
  INFO(outcome.err);
  CHECK((state == "old" || state == "new"));
  CHECK((outcome.signal == signal || (outcome.exit_code == 0 && state == "new")));
  CHECK(place.strays().empty());
  if (!outcome.err.empty()) CHECK(state == "old");  // as it says
  tally.stopped += outcome.signal == signal ? 1 : 0;
  (state == "new" ? tally.made_new : tally.kept_old) += 1;
}

std::string tally_text(const SignalTally& tally) {
  std::ostringstream text;
  text << "stopped " << tally.stopped << ", old " << tally.kept_old << ", new " << tally.made_new;
  return text.str();
}

}  // namespace

TEST_CASE("a signal at any moment leaves the old file or the whole new one and nothing else") {
  constexpr int kMoments = 30;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  SignalTally tally;
  for (const Situation& situation : situations()) {
    if (situation.writer.slow) continue;
    const Place place(situation);
    const std::chrono::duration<double> duration = duration_of(place);
    for (int k = 0; k < kMoments; ++k) {
      place.reset();
      const int signal = kSignals[k % 3];
      const std::chrono::duration<double> moment = duration * random.uniform(0, 1.1);
      RunningProgram program(place.arguments(), place.options());
      std::this_thread::sleep_for(moment);
      program.send(signal);
      CAPTURE(situation.writer.name, situation.with_old, situation.names_needed, k, signal, seed);
      check_signalled(program.wait(), signal, place, tally);
    }
  }
  std::cout << "seed " << seed << ": " << tally_text(tally) << std::endl;
  CHECK(tally.stopped >= kMoments);
}

TEST_CASE("a signal before any call that writes ends each writer by that signal, with no stray") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  SignalTally tally;
  for (const Situation& situation : situations()) {
    if (situation.writer.slow) continue;
    const Place place(situation);
    for (const long at : chosen_calls(place.calls().size(), random)) {
      const int signal = kSignals[at % 3];
      place.reset();
      RunningProgram program(place.arguments(), place.options({"stop", at}));
      REQUIRE(wait_until_stopped(program));
      program.send(signal);
      program.send(SIGCONT);
      const Outcome outcome = program.wait();
      CAPTURE(situation.writer.name, situation.with_old, situation.names_needed, at, signal, seed);
      CHECK(outcome.signal == signal);
      check_signalled(outcome, signal, place, tally);
    }
  }
  std::cout << "seed " << seed << ": " << tally_text(tally) << std::endl;
}

}  // namespace clothbrdf::test
