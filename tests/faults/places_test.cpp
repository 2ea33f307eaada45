#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "tests/catch.h"
#include "tests/faults/faults.h"
#include "tests/support/mounted_folder.h"

// What there can be where a file is to be written.

namespace clothbrdf::test {
namespace {

Outcome run_writer(const Writer& writer, const std::filesystem::path& file) {
  Arguments arguments = writer.arguments;
  arguments.push_back(file.string());
  return run_program(arguments);
}

// That every writer refuses to write, for this reason, and leaves all as it is.
template <class Folder>
void check_refused(const Folder& folder, const std::string& reason) {
  const std::size_t entries = folder.entry_count();
  for (const Writer& writer : writers()) {
    const std::filesystem::path file = folder / writer.name;
    const Outcome outcome = run_writer(writer, file);
    CAPTURE(writer.name);
    CHECK(not_a_refusal(outcome, 1) == "");
    CHECK_THAT(outcome.err, ContainsSubstring(file.string() + ": cannot write: " + reason));
    CHECK(folder.entry_count() == entries);
  }
}

bool may_mount(const MountedFolder& folder) {
  if (folder.ready()) return true;
  WARN("not tested: this system lets the test mount no file system of its own");
  SUCCEED();
  return false;
}

}  // namespace

TEST_CASE("in a read-only folder every writer says so and the old file stays") {
  MountedFolder folder(4);
  if (!may_mount(folder)) return;
  for (const Writer& writer : writers()) write_file(folder / writer.name, kOld);
  REQUIRE(folder.make_read_only());
  check_refused(folder, "Read-only file system");
  for (const Writer& writer : writers()) CHECK(read_file(folder / writer.name) == kOld);
}

TEST_CASE("every writer refuses a directory, a pipe, a device and links to them") {
  const TemporaryFolder folder;
  const auto clear = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      std::filesystem::remove_all(entry);
  };
  for (const bool linked : {false, true}) {
    const auto at_each = [&](const auto& make) {
      clear();
      for (const Writer& writer : writers()) {
        const std::string name = (linked ? "real-" : "") + writer.name;
        make(folder / name);
        if (linked) std::filesystem::create_symlink(name, folder / writer.name);
      }
    };
    CAPTURE(linked);
    at_each([](const auto& path) { std::filesystem::create_directory(path); });
    check_refused(folder, "Is a directory");
    at_each([](const auto& path) { REQUIRE(::mkfifo(path.c_str(), 0600) == 0); });
    check_refused(folder, "not a regular file");
    // One of our own: as root, a wrong program would replace /dev/full.
    const dev_t full = makedev(1, 7);
    bool made = true;
    at_each(
        [&](const auto& path) { made = made && ::mknod(path.c_str(), S_IFCHR | 0666, full) == 0; });
    if (made) {
      check_refused(folder, "not a regular file");
    } else {
      WARN("devices are not tested: only root may make one");
    }
  }
}

TEST_CASE("a folder that is removed while a file is written makes the writer say so") {
  for (const Situation& situation : situations()) {
    if (situation.writer.name != plain_writer().name) continue;
    const Place place(situation);
    const std::vector<std::string> calls = place.calls();
    for (long at = 1; at <= static_cast<long>(calls.size()); ++at) {
      place.reset();
      RunningProgram program(place.arguments(), place.options({"stop", at}));
      REQUIRE(wait_until_stopped(program));
      const bool done = place.state() == "new";
      std::filesystem::remove_all(place.folder());
      program.send(SIGCONT);
      const Outcome outcome = program.wait();
      CAPTURE(situation.with_old, situation.names_needed, at, calls);
      if (done) {
        CHECK(outcome.exit_code == 0);
      } else {
        CHECK(not_a_refusal(outcome, 1) == "");
        CHECK_THAT(outcome.err, ContainsSubstring(place.file().string() +
                                                  ": cannot write: No such file or directory"));
      }
      CHECK(!std::filesystem::exists(place.folder()));
      std::filesystem::create_directory(place.folder());
    }
  }
}

TEST_CASE("through a link every writer writes the file that it names, and the link stays") {
  for (const Writer& writer : writers()) {
    if (writer.slow) continue;
    const Place place({writer, false});
    for (const bool with_old : {true, false}) {
      place.reset();
      const std::filesystem::path folder = place.folder() / "elsewhere";
      const std::filesystem::path file = folder / ("real-" + writer.name);
      std::filesystem::create_directory(folder);
      if (with_old) write_file(file, kOld);
      std::filesystem::create_symlink(std::filesystem::path("elsewhere") / file.filename(),
                                      place.file());
      CAPTURE(writer.name, with_old);
      CHECK(run_program(place.arguments()).exit_code == 0);
      CHECK(std::filesystem::is_symlink(place.file()));
      CHECK(!std::filesystem::is_symlink(file));
      CHECK(read_file(file) == place.expected());
      CHECK(place.strays() == std::vector<std::string>{"elsewhere"});
    }
  }
}

TEST_CASE("the other names of an old file keep what it held") {
  const Place place({plain_writer(), true});
  std::filesystem::create_hard_link(place.file(), place.folder() / "other");
  CHECK(run_program(place.arguments()).exit_code == 0);
  CHECK(place.state() == "new");
  CHECK(read_file(place.folder() / "other") == kOld);
}

}  // namespace clothbrdf::test
