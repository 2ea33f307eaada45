#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "support/errors.h"
#include "support/version.h"

namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr const char* kCannotPrint = "cannot write to standard output";

// One line, whatever the names in it hold.
int complain(std::string message, int exit_code) {
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  std::cout.flush();
  std::cerr << "clothbrdf: " << message << '\n';
  return exit_code;
}

std::string command_names(const CLI::App& program) {
  std::string names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return names;
}

// CLI11 complains of the first thing that is missing, even where that follows from a misspelt word
// before it; its own text where there is no better one.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<CLI::App*> given = program.get_subcommands();
  const std::string command = given.empty() ? "" : given.front()->get_name();
  const std::string help = "; see clothbrdf " + command + (command.empty() ? "--help" : " --help");
  const std::vector<std::string> unknown = program.remaining(true);
  if (!unknown.empty()) {
    const std::string& first = unknown.front();
    if (first.starts_with('-')) {
      return "'" + first + "' is not an option" + (command.empty() ? "" : " of " + command) + help;
    }
    if (!command.empty()) return "'" + first + "' is one argument too many for " + command + help;
    return "'" + first + "' is not a command; known: " + command_names(program);
  }
  if (command.empty()) return "a command is required: " + command_names(program) + help;
  const std::string text = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const std::string option = text.substr(0, text.find(':'));
    if (text.ends_with(" missing")) return option + ": a value is required" + help;
    if (text.find(" received ") != std::string::npos) return option + ": allowed only once" + help;
  }
  return text + help;
}

int run(int argc, char** argv) {
  // A limit on file sizes is an error like any other, not a death. (A closed pipe stays one:
  // whoever closed it wants no more.)
  std::signal(SIGXFSZ, SIG_IGN);
  std::ios::sync_with_stdio(false);

  CLI::App program(
      "Turns a description of woven cloth into reflectance tables, and back.\n"
      "Example: clothbrdf tabulate materials/silk.json -o silk.binary -o silk.exr",
      "clothbrdf");
  program.set_version_flag("--version", std::string("clothbrdf ") + clothbrdf::kVersion);
  program.require_subcommand(1);
  clothbrdf::add_new_command(program);
  clothbrdf::add_eval_command(program);
  clothbrdf::add_tabulate_command(program);
  clothbrdf::add_info_command(program);
  clothbrdf::add_preview_command(program);
  clothbrdf::add_check_command(program);
  clothbrdf::add_compare_command(program);
  clothbrdf::add_convert_command(program);
  clothbrdf::add_fit_command(program);
  clothbrdf::add_identify_command(program);
  clothbrdf::add_cost_command(program);
  clothbrdf::add_plan_command(program);

  try {
    program.parse(argc, argv);
    std::cout.flush();
    if (!std::cout) return complain(kCannotPrint, kFailed);
    return 0;
  } catch (const CLI::Success& help_or_version) {
    program.exit(help_or_version);
    std::cout.flush();
    return std::cout ? 0 : complain(kCannotPrint, kFailed);
  } catch (const CLI::ParseError& error) {
    return complain(usage_error(program, error), kBadInput);
  } catch (const clothbrdf::InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const clothbrdf::WorkError& error) {
    return complain(error.what(), kFailed);
  } catch (const clothbrdf::Cancelled&) {
    return complain("stopped; nothing was written", kFailed);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", kFailed);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), kFailed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int exit_code = run(argc, argv);
    // Whoever started the program shall see that a signal stopped it.
    if (const int signal = clothbrdf::ProgressBar::signal(); signal != 0) {
      std::signal(signal, SIG_DFL);
      std::raise(signal);
    }
    return exit_code;
  } catch (...) {  // while complaining
    std::fputs("clothbrdf: internal error\n", stderr);
    return kFailed;
  }
}
