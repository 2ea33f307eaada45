#include "cli/gnuplot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "support/errors.h"

namespace clothbrdf {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// All three streams are files: no pipe can fill up, and none can break.
File scratch_file() {
  File file(std::tmpfile());
  if (!file) {
    throw WorkError(std::string("gnuplot: cannot make a scratch file: ") + std::strerror(errno));
  }
  return file;
}

std::string content(const File& file) {
  std::rewind(file.get());
  std::string bytes;
  std::array<char, 1U << 16U> block;
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    bytes.append(block.data(), count);
  }
  return bytes;
}

// gnuplot repeats the script's line, with a caret below, before it says what is wrong with it.
std::string complaint(const std::string& errors) {
  const std::size_t place = errors.find(" line ");
  const std::size_t line = place == std::string::npos ? 0 : errors.rfind('\n', place) + 1;
  const std::size_t begin = errors.find_first_not_of(" \t\n", line);
  if (begin == std::string::npos) return "no reason given";
  return errors.substr(begin, errors.find('\n', begin) - begin);
}

int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string run(const char* option, const std::string& script) {
  const File in = scratch_file();
  const File out = scratch_file();
  const File err = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() ||
      std::fflush(in.get()) != 0) {
    throw WorkError(std::string("gnuplot: cannot write its script: ") + std::strerror(errno));
  }
  std::rewind(in.get());
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ::fileno(in.get()), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, ::fileno(out.get()), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, ::fileno(err.get()), STDERR_FILENO);
  // The interface is older than const; the texts are only read.
  const std::array<char*, 3> arguments = {const_cast<char*>("gnuplot"), const_cast<char*>(option),
                                          nullptr};
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, "gnuplot", &actions, nullptr, arguments.data(), ::environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) {
    throw WorkError(
        "gnuplot is needed for pictures; it is in Debian's package gnuplot-nox, elsewhere in "
        "gnuplot; without it leave out the outputs .svg and .png");
  }
  if (error != 0) throw WorkError(std::string("gnuplot cannot be run: ") + std::strerror(error));
  const int status = wait_for(pid);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw WorkError("gnuplot failed: " + complaint(content(err)));
  }
  return content(out);
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
  std::string picture = run("-", script);
  if (picture.empty()) throw WorkError("gnuplot failed: it wrote no picture");
  return picture;
}

void require_gnuplot() { run("--version", ""); }

}  // namespace clothbrdf
