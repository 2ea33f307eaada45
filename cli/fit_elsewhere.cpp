#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "support/errors.h"

// The commands that fit live in a program of their own, clothbrdf-fit, beside this one or in
// libexec: the solver's libraries would cost every other command twice the time to start.

namespace clothbrdf {
namespace {

constexpr const char* kProgram = "clothbrdf-fit";

std::filesystem::path solver_program() {
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  std::filesystem::path beside = folder / kProgram;
  if (std::filesystem::exists(beside, ignored)) return beside;
  return folder.parent_path() / "libexec" / "clothbrdf" / kProgram;
}

[[noreturn]] void hand_over(const std::string& command, std::vector<std::string> arguments) {
  std::string name = solver_program().string();
  arguments.insert(arguments.begin(), {"clothbrdf", command});
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(name.c_str(), argv.data());
  throw WorkError(name + ": cannot be started: " + std::strerror(errno));
}

void add_elsewhere(CLI::App& program, const std::string& name, const char* summary) {
  CLI::App* command = program.add_subcommand(name, summary);
  command->prefix_command();
  command->set_help_flag();
  command->callback([command, name] { hand_over(name, command->remaining()); });
}

}  // namespace

void add_fit_command(CLI::App& program) { add_elsewhere(program, "fit", kFitSummary); }

void add_identify_command(CLI::App& program) {
  add_elsewhere(program, "identify", kIdentifySummary);
}

}  // namespace clothbrdf
