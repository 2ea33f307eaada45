#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using Clock = std::chrono::steady_clock;

const std::string kErase = "\r\x1b[K";

// Some seconds of work in many cells, and in a single one.
const Arguments kManyCells = {"--grid", "inout:8x48x8x48", "--cells", "average:1e-2", "--threads",
                              "1",      "--effects",       "specular"};
const Arguments kSlowCell = {"--grid", "inout:1x1x1x1", "--cells", "average:1e-6", "--components"};
// Far less than the slow cell takes, far more than ending takes.
constexpr std::chrono::seconds kPromptly{20};
constexpr std::chrono::minutes kPatience{4};

Arguments tabulate_silk(const std::filesystem::path& file, const Arguments& options) {
  Arguments arguments = {"tabulate", kSilk, "-o", file.string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

// Polls until it is so; false where that takes too long.
bool comes_true(const std::function<bool()>& condition, Clock::duration limit = kPatience) {
  for (const auto give_up = Clock::now() + limit; !condition();) {
    if (Clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

std::filesystem::path proc_file(const RunningProgram& program, const char* name) {
  return "/proc/" + std::to_string(program.pid()) + "/" + name;
}

// Whether it is the program by now, not the test's own copy that becomes it, and has handlers.
bool handles(const RunningProgram& program, int signal) {
  std::error_code gone;
  if (!std::filesystem::equivalent(proc_file(program, "exe"), CLOTHBRDF_PROGRAM, gone))
    return false;
  const std::string status = read_file(proc_file(program, "status"));
  const std::string key = "SigCgt:";
  const std::size_t at = status.find(key);
  if (at == std::string::npos) return false;
  return (std::stoull(status.substr(at + key.size()), nullptr, 16) >> (signal - 1) & 1U) != 0;
}

// Whether it has spent half a second of processor time: it is amid its cells.
bool has_worked(const RunningProgram& program) {
  std::ifstream stat(proc_file(program, "stat"));
  std::string field;
  for (int k = 1; k <= 14; ++k) stat >> field;  // the 14th is the time in user mode, in ticks
  return stat && 2 * std::stol(field) >= ::sysconf(_SC_CLK_TCK);
}

// Makes a run last over a second, however fast the machine: from where it handles signals on it
// must wait. False where it had ended before.
bool stretch(RunningProgram& program) {
  if (!comes_true([&] { return handles(program, SIGINT) || !program.runs(); })) return false;
  program.send(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  program.send(SIGCONT);
  return program.runs();
}

// The last line drawn before it was taken away; empty where there is none.
std::string last_line(const std::string& text) {
  const std::size_t from = text.rfind("\rsilk");
  return from == std::string::npos ? "" : text.substr(from + 1, text.find('\x1b', from) - from - 1);
}

}  // namespace

TEST_CASE("on a terminal a long run tells per cent, rate and time left, and takes the line away") {
  const TemporaryFolder folder;
  PseudoTerminal terminal;
  RunningProgram program(tabulate_silk(folder / "silk.exr", kManyCells),
                         {.terminal = terminal.end()});
  REQUIRE(stretch(program));
  REQUIRE(comes_true([&] {
    terminal.text();  // a full screen would hold it up
    return !program.runs();
  }));
  CHECK(program.wait().exit_code == 0);
  const std::string& text = terminal.text();
  CAPTURE(text);
  const std::string line = last_line(text);
  CHECK(line.starts_with("silk.exr: "));
  for (const char* const part : {" %, ", " of 147 k cells, ", " cells/s, "}) {
    CHECK_THAT(line, ContainsSubstring(part));
  }
  CHECK(line.ends_with(" left"));
  CHECK(text.find('\n') == std::string::npos);
  CHECK(text.ends_with(kErase));
}

TEST_CASE("on a terminal a short run draws nothing") {
  const TemporaryFolder folder;
  constexpr std::chrono::milliseconds kShort{900};
  // A machine in trouble can take a second for anything: then once more.
  REQUIRE(comes_true([&] {
    PseudoTerminal terminal;
    const auto start = Clock::now();
    RunningProgram program(tabulate_silk(folder / "silk.exr", {"--grid", "inout:1x1x1x1"}),
                           {.terminal = terminal.end()});
    CHECK(program.wait().exit_code == 0);
    if (Clock::now() - start > kShort) return false;
    CHECK(terminal.text().empty());
    return true;
  }));
}

TEST_CASE("where standard error is no terminal a long run draws nothing") {
  const TemporaryFolder folder;
  RunningProgram program(tabulate_silk(folder / "silk.exr", kManyCells));
  REQUIRE(stretch(program));
  const Outcome outcome = program.wait();
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
}

TEST_CASE("a signal ends tabulate promptly, by that signal, and leaves only what was there") {
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const bool with_old : {true, false}) {
      const TemporaryFolder folder;
      const std::filesystem::path file = folder / "silk.exr";
      if (with_old) write_file(file, kOld);
      RunningProgram program(tabulate_silk(file, kSlowCell));
      REQUIRE(comes_true([&] { return handles(program, signal) && has_worked(program); }));
      program.send(signal);
      CHECK(comes_true([&] { return !program.runs(); }, kPromptly));
      program.kill();
      const Outcome outcome = program.wait();
      CAPTURE(signal, with_old);
      CHECK(outcome.signal == signal);
      CHECK(outcome.err == "clothbrdf: stopped; " + file.string() + " is as it was\n");
      CHECK(folder.entry_count() == (with_old ? 1 : 0));
      if (with_old) CHECK(read_file(file) == kOld);
    }
  }
}

TEST_CASE("files finished before the signal stay and are reported, and the others are named") {
  const TemporaryFolder folder;
  const std::filesystem::path finished = folder / "first.binary";
  const std::string second = (folder / "second.exr").string();
  const std::string third = (folder / "third.exr").string();
  // The second one takes four times as long as the first: seconds.
  RunningProgram program({"tabulate", kSilk, "-o", finished.string(), "-o", second, "-o", third,
                          "--cells", "average:1e-1", "--threads", "1"});
  REQUIRE(comes_true([&] { return std::filesystem::exists(finished); }));
  program.send(SIGINT);
  const std::optional<std::string> report =
      program.read_line(static_cast<int>(std::chrono::milliseconds(kPromptly).count()));
  const Outcome outcome = program.wait();
  CHECK(outcome.signal == SIGINT);
  CHECK_THAT(report.value_or(""), ContainsSubstring(finished.string() + ": MERL halfdiff3d"));
  CHECK(outcome.err == "clothbrdf: stopped; " + second + ", " + third + " are as they were\n");
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("on a terminal the line is gone before the program says that it was stopped") {
  const TemporaryFolder folder;
  PseudoTerminal terminal;
  RunningProgram program(tabulate_silk(folder / "silk.exr", kSlowCell),
                         {.terminal = terminal.end()});
  REQUIRE(comes_true([&] { return terminal.text().find("0 of 1 cells") != std::string::npos; }));
  program.send(SIGINT);
  CHECK(program.wait().signal == SIGINT);
  CHECK(terminal.text().ends_with(kErase + "clothbrdf: stopped; " + (folder / "silk.exr").string() +
                                  " is as it was\r\n"));
}

TEST_CASE("a second signal ends tabulate at once, whichever it is") {
  for (const int second : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "silk.exr";
    write_file(file, kOld);
    PseudoTerminal terminal;
    RunningProgram program(tabulate_silk(file, kSlowCell), {.terminal = terminal.end()});
    REQUIRE(comes_true([&] { return !terminal.text().empty(); }));
    // On a screen that stands still the program hangs while it draws, and could never end cleanly.
    terminal.hold();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    program.send(SIGINT);
    REQUIRE(comes_true([&] { return !handles(program, SIGINT); }));
    program.send(second);
    CHECK(comes_true([&] { return !program.runs(); }, kPromptly));
    program.kill();
    CHECK(program.wait().signal == second);
    CHECK(read_file(file) == kOld);
    CHECK(folder.entry_count() == 1);
  }
}

TEST_CASE("a signal that was ignored stays ignored") {
  const TemporaryFolder folder;
  RunningProgram program(tabulate_silk(folder / "silk.exr", kManyCells),
                         {.ignored_signal = SIGINT});
  REQUIRE(comes_true([&] { return handles(program, SIGTERM); }));
  CHECK_FALSE(handles(program, SIGINT));
  program.send(SIGINT);
  CHECK(program.wait().exit_code == 0);
}

}  // namespace clothbrdf::test
