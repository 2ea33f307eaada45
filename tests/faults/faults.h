#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/commands.h"
#include "tests/support/random_inputs.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/writers.h"

namespace clothbrdf::test {

/// The one that stands for all where what is written does not count.
inline const Writer& plain_writer() {
  static const Writer kWriter = [] {
    const std::vector<Writer> all = writers();
    return *std::find_if(all.begin(), all.end(),
                         [](const Writer& writer) { return writer.name == "silk.exr"; });
  }();
  return kWriter;
}

/// What tests/support/faulty_calls.cpp does to a run: to the call of this number among those that
/// write files into the folder, counted from 1.
struct Fault {
  /// "error" (the call and all after it fail), "once" (only this one fails), "short" (a write takes
  /// half of its bytes), "crumbs" (every write is interrupted or short), "disk" (`at` bytes of a
  /// file fit), "kill" (SIGKILL before it), "stop" (SIGSTOP before it), or nothing.
  std::string kind = {};
  long at = 0;
  int error = 0;         ///< what errno shall be
  std::string log = {};  ///< file to list the calls in
  std::filesystem::path folder = {};
  bool names_needed = false;  ///< as on a file system whose files all have names
};

inline RunOptions disturbed(const Fault& fault) {
  return {.environment = {
              "LD_PRELOAD=" CLOTHBRDF_FAULTY_CALLS,
              "CLOTHBRDF_FAULT_FOLDER=" + fault.folder.string(), "CLOTHBRDF_FAULT=" + fault.kind,
              "CLOTHBRDF_FAULT_AT=" + std::to_string(fault.at),
              "CLOTHBRDF_FAULT_ERRNO=" + std::to_string(fault.error),
              std::string("CLOTHBRDF_FAULT_NAMES_NEEDED=") + (fault.names_needed ? "1" : ""),
              "CLOTHBRDF_FAULT_LOG=" + fault.log}};
}

/// Where a file is written.
struct Situation {
  Writer writer;
  bool with_old = true;       ///< there is a file of that name
  bool names_needed = false;  ///< as of Fault
};

/// Every writer over an old file, and one of them in the other situations.
inline std::vector<Situation> situations() {
  std::vector<Situation> all;
  for (const Writer& writer : writers()) all.push_back({writer});
  all.push_back({plain_writer(), false, false});
  all.push_back({plain_writer(), true, true});
  all.push_back({plain_writer(), false, true});
  return all;
}

/// A situation in a folder of its own.
class Place {
 public:
  explicit Place(const Situation& situation)
      : writer_(situation.writer),
        with_old_(situation.with_old),
        names_needed_(situation.names_needed) {
    reset();
    if (const Outcome outcome = run_program(arguments()); outcome.exit_code != 0)
      throw std::runtime_error(outcome.err);
    new_ = read_file(file());
    reset();
  }

  /// Empties the folder but for the old file.
  void reset() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      std::filesystem::remove_all(entry);
    if (with_old_) write_file(file(), kOld);
  }

  Arguments arguments() const {
    Arguments all = writer_.arguments;
    all.push_back(file().string());
    return all;
  }
  std::filesystem::path file() const { return folder_ / writer_.name; }
  const std::filesystem::path& folder() const { return folder_.path(); }
  const std::string& expected() const { return new_; }

  /// Runs the writer disturbed; the folder is as before the first run.
  Outcome run(Fault fault) const {
    reset();
    return run_program(arguments(), options(std::move(fault)));
  }
  RunOptions options(Fault fault = {}) const {
    fault.folder = folder_.path();
    fault.names_needed = names_needed_;
    return disturbed(fault);
  }

  /// "old", also where there was none and is none, "new", or what else is there.
  std::string state() const {
    std::error_code ignored;
    if (!std::filesystem::exists(file(), ignored)) return with_old_ ? "gone" : "old";
    const std::string bytes = read_file(file());
    if (bytes == new_) return "new";
    if (with_old_ && bytes == kOld) return "old";
    return "a part: " + std::to_string(bytes.size()) + " bytes";
  }

  /// Names of all that is in the folder beside the file.
  std::vector<std::string> strays() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path() != file()) names.push_back(entry.path().filename().string());
    }
    return names;
  }

  /// The calls of an undisturbed run.
  std::vector<std::string> calls() const {
    const TemporaryFolder aside;
    const std::string log = (aside / "log").string();
    if (const Outcome outcome = run({.log = log}); outcome.exit_code != 0)
      throw std::runtime_error(outcome.err);
    reset();
    std::vector<std::string> lines;
    std::istringstream text(read_file(log));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }

 private:
  Writer writer_;
  bool with_old_;
  bool names_needed_;
  TemporaryFolder folder_;
  std::string new_;
};

/// Numbers of calls to disturb: all, or the first and the last ones and some between them.
inline std::vector<long> chosen_calls(std::size_t count, RandomInputs& random) {
  constexpr std::size_t kFirst = 5;
  constexpr std::size_t kLast = 6;  // from the last write on
  constexpr std::size_t kBetween = 5;
  std::vector<long> chosen(std::min(count, kFirst + kBetween + kLast));
  std::iota(chosen.begin(), chosen.end(), 1);
  if (count == chosen.size()) return chosen;
  for (std::size_t k = 0; k < kBetween; ++k) {
    chosen[kFirst + k] = random.integer(kFirst + 1, static_cast<int>(count - kLast));
  }
  for (std::size_t k = 0; k < kLast; ++k) {
    chosen[kFirst + kBetween + k] = static_cast<long>(count - kLast + 1 + k);
  }
  return chosen;
}

/// How a run that a fault made fail must have ended: as a refusal that names the file and the
/// reason, with the old file whole and nothing beside it. Empty, or what is wrong.
inline std::string not_a_clean_failure(const Outcome& outcome, const Place& place,
                                       const std::string& reason) {
  if (const std::string why = not_a_refusal(outcome, 1); !why.empty()) return why;
  if (outcome.err.find(place.file().string() + ": ") == std::string::npos ||
      outcome.err.find(reason) == std::string::npos) {
    return "said: " + outcome.err;
  }
  if (place.state() != "old") return "the file is " + place.state();
  return place.strays().empty() ? "" : "left: " + place.strays().front();
}

/// How a run that a fault did not keep from its work must have ended. Empty, or what is wrong.
inline std::string not_a_clean_success(const Outcome& outcome, const Place& place) {
  if (outcome.exit_code != 0 || !outcome.err.empty()) {
    return "exit code " + std::to_string(outcome.exit_code) + ", signal " +
           std::to_string(outcome.signal) + ": " + outcome.err;
  }
  if (place.state() != "new") return "the file is " + place.state();
  return place.strays().empty() ? "" : "left: " + place.strays().front();
}

/// Whether this is a name of what AtomicFile hides.
inline bool is_hidden_name(const std::string& name) {
  const std::string start = ".clothbrdf-";
  const std::string end = ".part";
  if (name.size() != start.size() + 16 + end.size()) return false;
  return name.starts_with(start) && name.ends_with(end) &&
         name.find_first_not_of("0123456789abcdef", start.size()) == name.size() - end.size();
}

/// Waits until a fault "stop" holds a program; false where it ended before.
inline bool wait_until_stopped(const RunningProgram& program) {
  siginfo_t change{};
  const auto id = static_cast<id_t>(program.pid());
  while (::waitid(P_PID, id, &change, WSTOPPED | WEXITED | WNOWAIT) != 0) {
    if (errno != EINTR) throw std::runtime_error("waitid");
  }
  return change.si_code == CLD_STOPPED;
}

/// The shortest of a few undisturbed runs, which is over sooner than most.
inline std::chrono::duration<double> duration_of(const Place& place) {
  std::chrono::duration<double> shortest = std::chrono::hours(1);
  for (int k = 0; k < 5; ++k) {
    place.reset();
    const auto start = std::chrono::steady_clock::now();
    run_program(place.arguments());
    shortest =
        std::min<std::chrono::duration<double>>(shortest, std::chrono::steady_clock::now() - start);
  }
  return shortest;
}

}  // namespace clothbrdf::test
