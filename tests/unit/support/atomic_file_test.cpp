#include "support/atomic_file.h"

#include <sys/stat.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/mounted_folder.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using std::filesystem::path;

void write_text(AtomicFile& file, std::string_view text, std::uint64_t offset = 0) {
  file.write_at(offset, std::as_bytes(std::span(text)));
}

// What a file_refusal says; empty where there is none.
std::string file_refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const WorkError& error) {
    return error.what();
  }
  return "";
}

std::string refusal_to_open(const path& target) {
  return file_refusal([&] { const AtomicFile file(target); });
}

// Runs in a child process, where limits and mounts bind nobody else; what it returns.
std::string in_child(const std::function<std::string()>& act) {
  const detail::Descriptor answer = detail::memory_file();
  const pid_t pid = ::fork();
  if (pid == 0) {
    std::string text;
    try {
      text = act();
    } catch (const std::exception& error) {
      text = std::string("thrown: ") + error.what();
    }
    const bool told =
        ::write(answer.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::_exit(told ? 0 : 1);
  }
  REQUIRE(wait_for(pid).exit_code == 0);
  return detail::read_all(answer);
}

// The first of these that does not hold; empty where all do.
class Checks {
 public:
  void operator()(bool holds, const char* what) {
    if (!holds && first_.empty()) first_ = what;
  }
  const std::string& first_failed() const { return first_; }

 private:
  std::string first_;
};

const std::string kNoNamespace = "no namespace";

}  // namespace

TEST_CASE("an atomic file has its name from its commit on, not before") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  AtomicFile file(target);
  write_text(file, "world", 6);
  write_text(file, "hello ");
  CHECK(file.name() == target);
  CHECK(file.size() == 11);
  CHECK(!std::filesystem::exists(target));
  file.commit();
  CHECK(read_file(target) == "hello world");
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("any number of pieces of memory make one piece of the file") {
  const TemporaryFolder folder;
  std::string expected = "start ";
  std::vector<std::string> words;
  for (int i = 0; i < 150; ++i) words.push_back(i % 7 == 3 ? "" : std::to_string(i * i) + ' ');
  std::vector<std::span<const std::byte>> pieces;
  for (const std::string& word : words) {
    pieces.push_back(std::as_bytes(std::span(word)));
    expected += word;
  }
  AtomicFile file(folder / "table");
  write_text(file, "start ");
  file.write_at(6, pieces);
  CHECK(file.size() == expected.size());
  file.commit();
  CHECK(read_file(folder / "table") == expected);
}

TEST_CASE("an old file of the name is whole until the commit, then gone") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  write_file(target, "an old file, longer than the new one");
  AtomicFile file(target);
  write_text(file, "new");
  CHECK(read_file(target) == "an old file, longer than the new one");
  file.commit();
  CHECK(read_file(target) == "new");
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("without a commit nothing is left") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  for (const bool old : {false, true}) {
    if (old) write_file(target, "old");
    {
      AtomicFile file(target);
      write_text(file, "new");
    }
    CHECK(folder.entry_count() == (old ? 1 : 0));
  }
  CHECK(read_file(target) == "old");
}

TEST_CASE("a moved atomic file goes on where it was, and what it left is harmless") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  write_file(target, "old");
  std::optional<AtomicFile> first(target);
  write_text(*first, "one ");
  AtomicFile second(std::move(*first));
  first.reset();
  write_text(second, "two", 4);
  CHECK(second.size() == 7);
  second.commit();
  CHECK(read_file(target) == "one two");
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("a symbolic link is followed, whether or not there is a file yet") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "inner");
  std::filesystem::create_symlink("inner/second", folder / "first");
  std::filesystem::create_symlink("../file", folder / "inner/second");
  for (const char* text : {"new", "newer"}) {
    AtomicFile file(folder / "first");
    CHECK(file.name() == folder / "first");
    write_text(file, text);
    file.commit();
    CHECK(std::filesystem::is_symlink(folder / "first"));
    CHECK(std::filesystem::is_symlink(folder / "inner/second"));
    CHECK(read_file(folder / "file") == text);
  }
  std::filesystem::create_symlink("loop", folder / "loop");
  CHECK_THAT(refusal_to_open(folder / "loop"), ContainsSubstring("symbolic links"));
}

TEST_CASE("a target that is no regular file is refused by its name") {
  const TemporaryFolder folder;
  const path directory = folder / "directory";
  std::filesystem::create_directory(directory);
  CHECK(refusal_to_open(directory) == directory.string() + ": cannot write: Is a directory");
  const path fifo = folder / "fifo";
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  CHECK(refusal_to_open(fifo) == fifo.string() + ": cannot write: not a regular file");
  const path missing = folder / "missing" / "table";
  CHECK(refusal_to_open(missing) == missing.string() + ": cannot write: No such file or directory");
  write_file(folder / "file", "");
  CHECK_THAT(refusal_to_open(folder / "file/table"), ContainsSubstring("Not a directory"));
  CHECK(folder.entry_count() == 3);
}

TEST_CASE("a commit that fails leaves nothing") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  {
    AtomicFile file(target);
    std::filesystem::create_directory(target);
    CHECK_THAT(file_refusal([&] { file.commit(); }), ContainsSubstring("cannot write: "));
  }
  CHECK(std::filesystem::is_directory(target));
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("a file that another process left does not stand in the way") {
  const TemporaryFolder folder;
  const path left = folder / (".table." + std::to_string(::getpid()) + ".0.part");
  write_file(left, "left");
  write_file(folder / "table", "old");
  AtomicFile file(folder / "table");
  write_text(file, "new");
  file.commit();
  CHECK(read_file(folder / "table") == "new");
  CHECK(read_file(left) == "left");
  CHECK(folder.entry_count() == 2);
}

TEST_CASE("a new file's permissions are the user's usual ones") {
  const TemporaryFolder folder;
  const mode_t usual = ::umask(027);
  AtomicFile file(folder / "table");
  file.commit();
  ::umask(usual);
  CHECK(std::filesystem::status(folder / "table").permissions() == std::filesystem::perms(0640));
}

TEST_CASE("space that cannot be had is told when it is set aside, and when it is written") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  const std::string probe = (folder / "probe").string();
  const detail::Descriptor fd(::open(probe.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  const bool can_reserve = ::fallocate(fd.get(), 0, 0, 1) == 0;
  const auto limited = [&](const std::function<void(AtomicFile&)>& act) {
    return in_child([&] {
      const rlimit limit{1000, 1000};
      std::signal(SIGXFSZ, SIG_IGN);
      ::setrlimit(RLIMIT_FSIZE, &limit);
      AtomicFile file(target);
      return file_refusal([&] { act(file); });
    });
  };
  const std::string too_large = target.string() + ": cannot write: File too large";
  if (can_reserve) {
    CHECK(limited([](AtomicFile& file) { file.reserve(4096); }) == too_large);
    CHECK(limited([](AtomicFile& file) { file.reserve(1000); }) == "");
  } else {
    WARN("reserve is not tested: this file system cannot set space aside");
  }
  const std::string text(600, 'x');
  CHECK(limited([&](AtomicFile& file) { write_text(file, text); }) == "");
  CHECK(limited([&](AtomicFile& file) { write_text(file, text + text); }) == too_large);
  const std::vector<std::span<const std::byte>> pieces(2, std::as_bytes(std::span(text)));
  CHECK(limited([&](AtomicFile& file) { file.write_at(0, pieces); }) == too_large);
  CHECK(folder.entry_count() == 1);
}

TEST_CASE("a full disk is told when space is set aside") {
  const MountedFolder folder(1);
  if (!folder.ready()) {
    WARN("not tested: this system lets the test mount no file system of its own");
    SUCCEED();
    return;
  }
  {
    AtomicFile file(folder / "table");
    CHECK_THAT(file_refusal([&] { file.reserve(2 << 20); }),
               ContainsSubstring("cannot write: No space left on device"));
  }
  CHECK(folder.entry_count() == 0);
}

TEST_CASE("where files must have names, a hidden one is written and renamed") {
  const TemporaryFolder folder;
  const path target = folder / "table";
  const std::string failed = in_child([&]() -> std::string {
    // Without /proc a file that has no name could never get one.
    if (!enter_own_namespace() || ::mount("tmpfs", "/proc", "tmpfs", 0, nullptr) != 0)
      return kNoNamespace;
    Checks check;
    {
      const AtomicFile dropped(target);
      check(folder.entry_count() == 1, "the hidden file is there");
      check(!std::filesystem::exists(target), "the name is not, before the commit");
    }
    check(folder.entry_count() == 0, "nothing is left without a commit");
    for (const char* text : {"new", "newer"}) {
      AtomicFile file(target);
      AtomicFile other(target);  // hidden under another name
      write_text(file, text);
      file.commit();
      check(read_file(target) == text, "the file is there after the commit");
    }
    check(folder.entry_count() == 1, "no hidden file is left");
    {
      std::optional<AtomicFile> file(target);
      const AtomicFile moved(std::move(*file));
      file.reset();
      check(folder.entry_count() == 2, "what was moved keeps its hidden file");
    }
    check(folder.entry_count() == 1, "the moved file is removed");
    return check.first_failed();
  });
  if (failed == kNoNamespace) {
    WARN("not tested: this system lets the test mount no file system of its own");
    SUCCEED();
  } else {
    CHECK(failed == "");
  }
}

}  // namespace clothbrdf::test
