// Tests files that only one program can own at a time.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <thread>

#include "host/client/local/owned_file.hpp"
#include "host/client/local/process_name.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using local::FileInUse;
using local::OwnedFile;
using namespace std::chrono_literals;

namespace {

namespace fs = std::filesystem;

std::string text_in(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void replace(OwnedFile& file, const std::string& text) { file.replace(std::as_bytes(std::span(text))); }

std::string refusal(const fs::path& file) {
  return message_of<FileInUse>([&] { OwnedFile second(file); });
}

std::string of_this_process() { return "(process " + std::to_string(getpid()) + ")"; }

/// The child calls a function and waits until it is killed.
class Child {
 public:
  explicit Child(const std::function<void()>& action) {
    std::array<int, 2> ready{};
    REQUIRE(pipe(ready.data()) == 0);
    process_ = fork();
    if (process_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      action();
      close(ready[1]);
      for (;;) pause();
    }
    close(ready[1]);
    char byte = 0;
    [[maybe_unused]] const auto end = read(ready[0], &byte, 1);
    close(ready[0]);
  }
  ~Child() { end(); }
  void end() {
    if (process_ < 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }
  pid_t process() const { return process_; }

 private:
  pid_t process_ = -1;
};

}  // namespace

TEST_CASE("a file has one owner under any of its names, before and after a replacement") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file", symbolic_link = directory / "link", hard_link = directory / "hard",
                 moved = directory / "moved";
  std::ofstream(file) << "old";
  fs::create_symlink("file", symbolic_link);
  fs::create_hard_link(file, hard_link);
  {
    OwnedFile owned(symbolic_link);
    CHECK(owned.warning().empty());
    for (const auto& name : {file, symbolic_link, hard_link}) CHECK(contains(refusal(name), of_this_process()));
    replace(owned, "new");
    for (const auto& name : {file, symbolic_link, hard_link}) CHECK(contains(refusal(name), of_this_process()));
    CHECK(fs::is_symlink(symbolic_link));
    CHECK(text_in(file) == "new");
    fs::rename(file, moved);
    CHECK(contains(refusal(moved), of_this_process()));
    fs::rename(moved, file);
    replace(owned, "newer");
  }
  CHECK(text_in(file) == "newer");
  CHECK_NOTHROW(OwnedFile{file});
  CHECK_NOTHROW(OwnedFile{hard_link});
  CHECK(std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator()) == 3);
}

TEST_CASE("a file that does not exist has one owner, and is created with its first content") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file";
  {
    const OwnedFile owned(file);
    CHECK_FALSE(owned.exists());
    CHECK(contains(refusal(file), of_this_process()));
  }
  CHECK(fs::is_empty(directory.path()));
  OwnedFile owned(file);
  replace(owned, "new");
  CHECK(owned.exists());
  CHECK(text_in(file) == "new");
  CHECK(contains(refusal(file), of_this_process()));
}

TEST_CASE("the content is read if it has the expected size, and a folder has none") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file") << "four";
  const OwnedFile owned(directory / "file");
  CHECK(owned.content(4).size() == 4);
  CHECK(owned.content(3).empty());
  CHECK(owned.content(5).empty());
  CHECK(OwnedFile(directory.path()).content(4096).empty());
  CHECK_THROWS_AS(OwnedFile(directory / "nowhere/file"), std::system_error);
}

TEST_CASE("a file that replaced the owned one is not overwritten, and one that was removed comes back") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file";
  std::ofstream(file) << "old";
  OwnedFile owned(file);
  std::ofstream(directory / "other") << "of another program";
  fs::rename(directory / "other", file);
  CHECK_THROWS_AS(replace(owned, "new"), FileInUse);
  CHECK(text_in(file) == "of another program");
  fs::remove(file);
  replace(owned, "new");
  CHECK(text_in(file) == "new");
}

TEST_CASE("the temporary file is never a planted link") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file", victim = directory / "victim";
  std::ofstream(file) << "old";
  std::ofstream(victim) << "precious";
  fs::create_symlink(victim, directory / "file.new");
  OwnedFile owned(file);
  CHECK_THROWS_AS(replace(owned, "new"), std::system_error);
  CHECK(text_in(victim) == "precious");
  CHECK(text_in(file) == "old");
}

TEST_CASE("replacing a file keeps its rights") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file";
  std::ofstream(file) << "old";
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  OwnedFile owned(file);
  replace(owned, "new");
  CHECK(fs::status(file).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("the refusal names the owner without commands for the terminal, and a killed owner owns nothing") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file";
  std::ofstream(file) << "old";
  std::unique_ptr<OwnedFile> of_child;
  Child child([&] {
    prctl(PR_SET_NAME, "bad\033[31m\nname");
    of_child = std::make_unique<OwnedFile>(file);
    replace(*of_child, "of the child");
  });
  const std::string sentence = refusal(file);
  CHECK(contains(sentence, "bad?[31m"));
  CHECK(contains(sentence, "(process " + std::to_string(child.process()) + ")"));
  CHECK_FALSE(contains(sentence, "\033"));
  child.end();
  OwnedFile owned(file);
  CHECK(owned.content(12).size() == 12);
}

TEST_CASE("a program that was started later does not retain ownership of the file") {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file";
  std::ofstream(file) << "old";
  pid_t process = 0;
  {
    OwnedFile owned(file);
    replace(owned, "new");
    char program[] = "/bin/sleep", time[] = "1000";
    std::array<char*, 3> words{program, time, nullptr};
    REQUIRE(posix_spawn(&process, program, nullptr, nullptr, words.data(), environ) == 0);
  }
  // The new program's files are closed shortly after posix_spawn returns.
  for (int tries = 0; tries < 1000 && !refusal(file).empty(); ++tries) std::this_thread::sleep_for(10ms);
  CHECK(refusal(file).empty());
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
}

TEST_CASE("a file system without locks causes a warning and no error") {
  const TemporaryDirectory directory;
  OwnedFile owned(directory / "file", [](int, int) {
    errno = ENOLCK;
    return -1;
  });
  CHECK(contains(owned.warning(), "has no locks"));
  replace(owned, "new");
  CHECK(text_in(directory / "file") == "new");
}

TEST_CASE("a process is named with its number") {
  CHECK(local::name_of_process(getpid()).ends_with(of_this_process()));
}
