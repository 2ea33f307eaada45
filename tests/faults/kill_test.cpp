#include <iostream>
#include <thread>

#include "tests/catch.h"
#include "tests/faults/faults.h"

namespace clothbrdf::test {
namespace {

/// How many runs ended how.
struct KillTally {
  int killed = 0;
  int kept_old = 0;
  int made_new = 0;
  int hidden = 0;  // files left by those that were killed
};

void check_killed(const Outcome& outcome, const Place& place, KillTally& tally) {
  const std::string state = place.state();
  const std::vector<std::string> strays = place.strays();
  CHECK((state == "old" || state == "new"));
  CHECK((outcome.signal == SIGKILL || (outcome.exit_code == 0 && state == "new")));
  CHECK(strays.size() <= 1);
  CHECK(std::all_of(strays.begin(), strays.end(), is_hidden_name));
  tally.killed += outcome.signal == SIGKILL ? 1 : 0;
  (state == "new" ? tally.made_new : tally.kept_old) += 1;
  tally.hidden += static_cast<int>(strays.size());
}

std::string tally_text(const KillTally& tally) {
  std::ostringstream text;
  text << "killed " << tally.killed << ", old " << tally.kept_old << ", new " << tally.made_new
       << ", hidden files left " << tally.hidden;
  return text.str();
}

}  // namespace

TEST_CASE("killed at any moment each writer leaves the old file or the whole new one") {
  constexpr int kMoments = 200;  // within a run: what ends before its moment is run again
  constexpr int kMostRuns = 10 * kMoments;
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  std::cout << "seed " << seed << '\n';
  for (const Writer& writer : writers()) {
    const Place with_old({writer, true});
    const Place without_old({writer, false});
    const std::chrono::duration<double> duration = duration_of(with_old);
    KillTally tally;
    int runs = 0;
    for (; tally.killed < kMoments && runs < kMostRuns; ++runs) {
      const Place& place = runs % 2 == 0 ? with_old : without_old;
      place.reset();
      const std::chrono::duration<double> moment = duration * random.uniform(0, 1);
      RunningProgram program(place.arguments());
      std::this_thread::sleep_for(moment);
      program.kill();
      const Outcome outcome = program.wait();
      CAPTURE(writer.name, runs, seed, moment.count());
      check_killed(outcome, place, tally);
    }
    std::cout << writer.name << ": " << runs << " runs within " << duration.count() << " s, "
              << tally_text(tally) << std::endl;
    CHECK(tally.killed == kMoments);
  }
}

TEST_CASE("killed before any call that writes each writer leaves the old file or the new one") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  KillTally tally;
  for (const Situation& situation : situations()) {
    if (situation.writer.slow) continue;
    const Place place(situation);
    const std::vector<std::string> calls = place.calls();
    for (const long at : chosen_calls(calls.size(), random)) {
      const Outcome outcome = place.run({"kill", at});
      CAPTURE(situation.writer.name, situation.with_old, situation.names_needed, at, seed);
      CHECK(outcome.signal == SIGKILL);
      check_killed(outcome, place, tally);
      // A file without a name has one of its own only until it takes the old one's place.
      const bool linked = std::count(calls.begin(), calls.begin() + at - 1, "linkat") == 2;
      if (!situation.names_needed && !linked) CHECK(place.strays().empty());
      // What was left is in nobody's way.
      const std::vector<std::string> left = place.strays();
      CHECK(run_program(place.arguments()).exit_code == 0);
      CHECK(place.state() == "new");
      CHECK(place.strays() == left);
    }
  }
  std::cout << "seed " << seed << ": " << tally_text(tally) << std::endl;
}

}  // namespace clothbrdf::test
