#include <sys/stat.h>

#include <iostream>
#include <set>

#include "tests/catch.h"
#include "tests/faults/faults.h"

// Names of unfinished files, on file systems whose files all have names.

namespace clothbrdf::test {
namespace {

const Situation kNewName = {plain_writer(), false, true};

// While it writes, of what the writer hid: its name and permissions.
struct Hidden {
  std::string name;
  mode_t mode;
};
Hidden hidden_file(const Place& place) {
  const std::vector<std::string> calls = place.calls();
  const long write = std::find(calls.begin(), calls.end(), "write") - calls.begin() + 1;
  const mode_t usual = ::umask(022);
  RunningProgram program(place.arguments(), place.options({"stop", write}));
  ::umask(usual);
  REQUIRE(wait_until_stopped(program));
  const std::vector<std::string> names = place.strays();
  REQUIRE(names.size() == 1);
  struct stat status {};
  REQUIRE(::lstat((place.folder() / names.front()).c_str(), &status) == 0);
  CHECK(S_ISREG(status.st_mode));
  program.send(SIGCONT);
  CHECK(program.wait().exit_code == 0);
  CHECK(place.strays().empty());
  return {names.front(), status.st_mode & 07777};
}

}  // namespace

TEST_CASE("an unfinished file has a hidden name that differs from run to run") {
  constexpr int kRuns = 20;
  const Place place(kNewName);
  std::set<std::string> names;
  for (int k = 0; k < kRuns; ++k) {
    const std::string name = hidden_file(place).name;
    CHECK(is_hidden_name(name));
    names.insert(name);
  }
  CHECK(names.size() == kRuns);
  // Neither do names begin alike.
  std::set<std::string> starts;
  for (const std::string& name : names) starts.insert(name.substr(0, name.size() - 9));
  CHECK(starts.size() == kRuns);
  std::cout << "the last of " << kRuns << " names: " << *names.rbegin() << std::endl;
}

TEST_CASE("an unfinished file can be read by whom the finished one can, and by nobody else") {
  CHECK(hidden_file(Place(kNewName)).mode == 0644);
  const Place place({plain_writer(), true, true});
  for (const mode_t mode : {0600U, 0640U, 0666U}) {
    // Before it has them all, as after open(), it has no more than these.
    place.reset();
    REQUIRE(::chmod(place.file().c_str(), mode) == 0);
    CAPTURE(mode);
    RunningProgram program(place.arguments(), place.options({"stop", 2}));
    REQUIRE(wait_until_stopped(program));
    const std::vector<std::string> names = place.strays();
    REQUIRE(names.size() == 1);
    struct stat status {};
    REQUIRE(::lstat((place.folder() / names.front()).c_str(), &status) == 0);
    CHECK((status.st_mode & 07777 & ~mode) == 0);
    program.send(SIGCONT);
    CHECK(program.wait().exit_code == 0);
    REQUIRE(::stat(place.file().c_str(), &status) == 0);
    CHECK((status.st_mode & 07777) == mode);
  }
}

TEST_CASE("a link in a shared folder that the system would not follow is not followed") {
  if (read_file("/proc/sys/fs/protected_symlinks") != "1\n" || ::getuid() != 0) {
    WARN("not tested: needs root, and a system that sets fs.protected_symlinks");
    SUCCEED();
    return;
  }
  constexpr uid_t kOwner = 1;
  constexpr uid_t kStranger = 2;
  const Place place({plain_writer(), false});
  const TemporaryFolder elsewhere;
  for (const bool with_victim : {true, false}) {
    place.reset();
    const std::filesystem::path victim = elsewhere / "victim";
    if (with_victim) write_file(victim, kOld);
    REQUIRE(::chown(place.folder().c_str(), kOwner, kOwner) == 0);
    REQUIRE(::chmod(place.folder().c_str(), 01777) == 0);
    std::filesystem::create_symlink(victim, place.file());
    REQUIRE(::lchown(place.file().c_str(), kStranger, kStranger) == 0);
    const Outcome outcome = run_program(place.arguments());
    CAPTURE(with_victim);
    CHECK(not_a_refusal(outcome, 1) == "");
    CHECK_THAT(outcome.err,
               ContainsSubstring(place.file().string() + ": cannot write: Permission denied"));
    CHECK(std::filesystem::exists(victim) == with_victim);
    if (with_victim) CHECK(read_file(victim) == kOld);
    std::filesystem::remove(victim);
  }
}

}  // namespace clothbrdf::test
