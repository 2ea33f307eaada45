#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "formats/format.h"
#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/mounted_folder.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

// A name of each format; a compressed file's space cannot be reserved beforehand.
struct Target {
  std::string name;
  Arguments options;
};
const Target kTargets[] = {{"silk.binary", {}}, {"silk.exr", {}}, {"silk.exr", {"--compress"}}};

Outcome run_tabulate(const std::filesystem::path& file, const Arguments& options,
                     const RunOptions& run = {}) {
  Arguments arguments = {"tabulate", kSilk, "-o", file.string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run_program(arguments, run);
}

// That each format fails with these words in the folder, and leaves there only the old file as it
// was, or nothing.
template <class Folder>
void check_fails(const Folder& folder, const std::string& words, const RunOptions& run = {},
                 bool with_old = true) {
  for (const Target& target : kTargets) {
    const std::filesystem::path file = folder / target.name;
    if (with_old) write_file(file, kOld);
    const Outcome outcome = run_tabulate(file, target.options, run);
    CAPTURE(target.name, target.options);
    CHECK(not_a_refusal(outcome, 1) == "");
    CHECK_THAT(outcome.err, ContainsSubstring(file.string() + ": cannot write: " + words));
    CHECK(folder.entry_count() == (with_old ? 1 : 0));
    if (with_old) {
      CHECK(read_file(file) == kOld);
      std::filesystem::remove(file);
    }
  }
}

bool mounted(const MountedFolder& folder) {
  if (folder.ready()) return true;
  WARN("not tested: this system lets the test mount no file system of its own");
  SUCCEED();
  return false;
}

// Bytes that a process has written so far.
long written_bytes(pid_t pid) {
  std::ifstream counters("/proc/" + std::to_string(pid) + "/io");
  for (std::string key; counters >> key;) {
    long value = 0;
    counters >> value;
    if (key == "wchar:") return value;
  }
  return 0;
}

}  // namespace

TEST_CASE("a missing output folder is told before any work is done") {
  const TemporaryFolder folder;
  const std::string file = (folder / "missing" / "silk.exr").string();
  for (const char* more : {"--json", "--dry-run"}) {
    const Outcome outcome =
        run_program({"tabulate", kSilk, more, "-o", (folder / "good.exr").string(), "-o", file});
    CHECK(not_a_refusal(outcome, 1) == "");
    CHECK_THAT(outcome.err, ContainsSubstring(file + ": cannot write: No such file or directory"));
    CHECK(folder.entry_count() == 0);
  }
}

TEST_CASE("an output that is a directory or no regular file stays as it is") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "silk.exr";
  std::filesystem::create_directory(file);
  Outcome outcome = run_tabulate(file, {});
  CHECK(not_a_refusal(outcome, 1) == "");
  CHECK_THAT(outcome.err, ContainsSubstring(file.string() + ": cannot write: Is a directory"));
  CHECK(std::filesystem::is_directory(file));

  std::filesystem::remove(file);
  const std::filesystem::path pipe =
      folder / "pipe";  // never a device: as root, a wrong program would replace it
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::filesystem::create_symlink(pipe, file);
  outcome = run_tabulate(file, {});
  CHECK(not_a_refusal(outcome, 1) == "");
  CHECK_THAT(outcome.err, ContainsSubstring("not a regular file"));
  CHECK(std::filesystem::is_symlink(file));
  CHECK(std::filesystem::is_fifo(pipe));
  CHECK(folder.entry_count() == 2);
}

TEST_CASE("a table takes the place of an older one") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "silk.exr";
  write_file(file, kOld);
  CHECK(run_tabulate(file, {"--grid", "inout"}).exit_code == 0);
  CHECK(folder.entry_count() == 1);
  CHECK(format_for(file).read(file).spec().grid() == inout());
}

TEST_CASE("in a read-only folder tabulate fails and the old file stays") {
  MountedFolder folder(4);
  if (!mounted(folder)) return;
  for (const char* name : {"silk.exr", "silk.binary"}) write_file(folder / name, kOld);
  REQUIRE(folder.make_read_only());
  for (const Target& target : kTargets) {
    const std::filesystem::path file = folder / target.name;
    const Outcome outcome = run_tabulate(file, target.options);
    CHECK(not_a_refusal(outcome, 1) == "");
    CHECK_THAT(outcome.err,
               ContainsSubstring(file.string() + ": cannot write: Read-only file system"));
    CHECK(read_file(file) == kOld);
  }
  CHECK(folder.entry_count() == 2);
}

TEST_CASE("on a full disk tabulate fails and leaves only what was there") {
  const MountedFolder folder(4);
  if (!mounted(folder)) return;
  for (const bool with_old : {true, false})
    check_fails(folder, "No space left on device", {}, with_old);
  CHECK(run_tabulate(folder / "silk.exr", {"--grid", "inout"}).exit_code == 0);
}

TEST_CASE("beyond the limit on file sizes tabulate fails and leaves only what was there") {
  const TemporaryFolder folder;
  for (const bool with_old : {true, false})
    check_fails(folder, "File too large", {.file_size_limit = 1 << 20}, with_old);
}

TEST_CASE("killed while it writes, tabulate leaves only what was there") {
  // Compressing 300 MB takes seconds; the first of them are written at once.
  const Arguments slow = {"--grid", "halfdiff4d:90x36x90x90", "--compress"};
  constexpr long kSurelyWriting = 100'000;
  const TemporaryFolder folder;
  for (const bool with_old : {true, false}) {
    const std::filesystem::path file = folder / "silk.exr";
    if (with_old) write_file(file, kOld);
    Arguments arguments = {"tabulate", kSilk, "-o", file.string()};
    arguments.insert(arguments.end(), slow.begin(), slow.end());
    RunningProgram program(arguments);
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(4);
    while (written_bytes(program.pid()) < kSurelyWriting) {
      REQUIRE(std::chrono::steady_clock::now() < give_up);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    program.kill();
    const Outcome outcome = program.wait();
    INFO(outcome.err);
    CHECK(outcome.signal == SIGKILL);
    CHECK(folder.entry_count() == (with_old ? 1 : 0));
    if (with_old) {
      CHECK(read_file(file) == kOld);
      std::filesystem::remove(file);
    }
  }
}

TEST_CASE("without a standard output tabulate still writes whole tables or none") {
  const TemporaryFolder folder;
  const Arguments options = {"--grid", "inout"};
  REQUIRE(run_tabulate(folder / "expected.exr", options).exit_code == 0);
  const std::string expected = read_file(folder / "expected.exr");

  const std::filesystem::path closed = folder / "closed.exr";
  const Outcome outcome = run_tabulate(closed, options, {.output_closed = true});
  CHECK(not_a_refusal(outcome, 1) == "");
  CHECK_THAT(outcome.err, ContainsSubstring("standard output"));
  if (std::filesystem::exists(closed)) CHECK(read_file(closed) == expected);

  const std::filesystem::path unread = folder / "unread.exr";
  RunningProgram program({"tabulate", kSilk, "-o", unread.string(), "--grid", "inout"});
  program.close_output();
  CHECK(program.wait().err.empty());
  if (std::filesystem::exists(unread)) CHECK(read_file(unread) == expected);
  CHECK(folder.entry_count() <= 3);
}

}  // namespace clothbrdf::test
