#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace clothbrdf::test {

/// How a program ended and what it said.
struct Outcome {
  int exit_code = -1;  ///< -1 where a signal ended it
  int signal = 0;      ///< 0 where it exited
  std::string out;
  std::string err;
};

/// A command line of the program under test; the program itself is added.
using Arguments = std::vector<std::string>;

namespace detail {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }
  void reset() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

inline Descriptor memory_file() {
  Descriptor file(::memfd_create("test", MFD_CLOEXEC));
  if (file.get() < 0) throw std::runtime_error("memfd_create");
  return file;
}

inline std::pair<Descriptor, Descriptor> make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe2");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

inline std::string read_all(const Descriptor& file) {
  std::string text;
  char block[1 << 16];
  ::lseek(file.get(), 0, SEEK_SET);
  for (ssize_t count = 0; (count = ::read(file.get(), block, sizeof block)) > 0;) {
    text.append(block, static_cast<std::size_t>(count));
  }
  return text;
}

}  // namespace detail

/// What a run may be given beside its arguments.
struct RunOptions {
  std::string input = {};                       ///< of standard input
  std::optional<rlim_t> file_size_limit = {};   ///< RLIMIT_FSIZE
  std::optional<std::string> output_file = {};  ///< for standard output, instead of keeping it
  bool output_closed = false;                   ///< no standard output at all
  std::optional<int> terminal = {};             ///< for standard error, instead of keeping it
  std::optional<int> ignored_signal = {};       ///< as nohup does
  std::vector<std::string> environment = {};    ///< NAME=value, more of it
};

/// Starts the program with these as its standard streams; a program that hangs is ended.
inline pid_t start_program(const Arguments& arguments, int in, int out, int err,
                           const RunOptions& options = {}) {
  // Under the sanitizers no test comes near it.
  constexpr unsigned kLongestRunSeconds = 300;
  std::vector<char*> argv = {const_cast<char*>(CLOTHBRDF_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error("fork");
  if (pid == 0) {
    if (options.file_size_limit) {
      const rlimit limit{*options.file_size_limit, *options.file_size_limit};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    if (options.output_closed) ::close(STDOUT_FILENO);
    std::signal(SIGPIPE, SIG_DFL);
    if (options.ignored_signal) std::signal(*options.ignored_signal, SIG_IGN);
    for (const std::string& variable : options.environment)
      ::putenv(const_cast<char*>(variable.c_str()));
    ::alarm(kLongestRunSeconds);
    ::execv(argv.front(), argv.data());
    ::_exit(127);
  }
  return pid;
}

/// Waits for the end; `out` and `err` stay empty.
inline Outcome wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  Outcome outcome;
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  return outcome;
}

/// Runs the program to its end.
inline Outcome run_program(const Arguments& arguments, const RunOptions& options = {}) {
  const detail::Descriptor in = detail::memory_file();
  const detail::Descriptor err = detail::memory_file();
  const detail::Descriptor out =
      options.output_file
          ? detail::Descriptor(::open(options.output_file->c_str(), O_WRONLY | O_CLOEXEC))
          : detail::memory_file();
  for (std::size_t written = 0; written < options.input.size();) {
    const ssize_t count =
        ::write(in.get(), options.input.data() + written, options.input.size() - written);
    if (count < 0) throw std::runtime_error("cannot set the input aside");
    written += static_cast<std::size_t>(count);
  }
  ::lseek(in.get(), 0, SEEK_SET);
  Outcome outcome = wait_for(start_program(arguments, in.get(), out.get(), err.get(), options));
  if (!options.output_file) outcome.out = detail::read_all(out);
  outcome.err = detail::read_all(err);
  return outcome;
}

/// The program at work, its standard input and output on pipes.
class RunningProgram {
 public:
  explicit RunningProgram(const Arguments& arguments, const RunOptions& options = {})
      : err_(detail::memory_file()) {
    std::signal(SIGPIPE, SIG_IGN);  // a program that died must fail its test, not end all of them
    auto [in_read, in_write] = detail::make_pipe();
    auto [out_read, out_write] = detail::make_pipe();
    pid_ = start_program(arguments, in_read.get(), out_write.get(),
                         options.terminal.value_or(err_.get()), options);
    in_ = std::move(in_write);
    out_ = std::move(out_read);
  }
  ~RunningProgram() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    wait_for(pid_);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  pid_t pid() const { return pid_; }
  void write(const std::string& text) {
    if (::write(in_.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      throw std::runtime_error("cannot write to the program");
  }
  void close_input() { in_.reset(); }
  void close_output() { out_.reset(); }
  void kill() { send(SIGKILL); }
  void send(int signal) { ::kill(pid_, signal); }

  /// Whether it has not ended yet.
  bool runs() const {
    siginfo_t ended{};
    const auto id = static_cast<id_t>(pid_);
    return ::waitid(P_PID, id, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0;
  }

  /// The next line of standard output without its end; none where it does not come in time.
  std::optional<std::string> read_line(int timeout_ms) {
    std::string line;
    for (char c = 0;; line += c) {
      pollfd ready{out_.get(), POLLIN, 0};
      if (::poll(&ready, 1, timeout_ms) <= 0 || ::read(out_.get(), &c, 1) != 1) return std::nullopt;
      if (c == '\n') return line;
    }
  }

  /// The end of it; `out` stays empty.
  Outcome wait() {
    Outcome outcome = wait_for(std::exchange(pid_, -1));
    outcome.err = detail::read_all(err_);
    return outcome;
  }

 private:
  detail::Descriptor in_;
  detail::Descriptor out_;
  detail::Descriptor err_;
  pid_t pid_ = -1;
};

/// Why an outcome is not a clean refusal: exactly one line on standard error that starts with the
/// program's name, nothing on standard output. Empty where it is one.
inline std::string not_a_refusal(const Outcome& outcome, int exit_code) {
  const auto lines = std::count(outcome.err.begin(), outcome.err.end(), '\n');
  const bool one_line = lines == 1 && outcome.err.back() == '\n';
  if (outcome.exit_code == exit_code && outcome.out.empty() && one_line &&
      outcome.err.starts_with("clothbrdf: ")) {
    return "";
  }
  return "exit code " + std::to_string(outcome.exit_code) + ", signal " +
         std::to_string(outcome.signal) + ", output:\n" + outcome.out + "\nerrors:\n" + outcome.err;
}

}  // namespace clothbrdf::test
