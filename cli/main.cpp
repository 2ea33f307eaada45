#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "cli/commands.h"
#include "support/errors.h"
#include "support/version.h"

namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

int complain(const std::string& message, int exit_code) {
  std::cout.flush();
  std::cerr << "clothbrdf: " << message << '\n';
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // A limit on file sizes or a closed pipe is an error like any other, not a death.
  std::signal(SIGXFSZ, SIG_IGN);
  std::ios::sync_with_stdio(false);

  CLI::App program(
      "Turns a description of woven cloth into reflectance tables.\n"
      "Example: clothbrdf tabulate materials/silk.json -o silk.binary -o silk.exr");
  program.set_version_flag("--version", std::string("clothbrdf ") + clothbrdf::kVersion);
  program.require_subcommand(1);
  clothbrdf::add_eval_command(program);
  clothbrdf::add_tabulate_command(program);
  clothbrdf::add_info_command(program);

  try {
    program.parse(argc, argv);
    std::cout.flush();
    if (!std::cout) return complain("cannot write to standard output", kFailed);
    return 0;
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return complain(std::string(error.what()) + "; see clothbrdf --help", kBadInput);
  } catch (const clothbrdf::InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const clothbrdf::WorkError& error) {
    return complain(error.what(), kFailed);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", kFailed);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), kFailed);
  }
}
