#include <doctest/doctest.h>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "host/client/local/replaced_file.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  REQUIRE(stat(file.c_str(), &status) == 0);
  return status.st_mode & 07777;
}

auto files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

}  // namespace

TEST_CASE("a file that is replaced through links keeps its links and its mode") {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "dotfiles");
  const fs::path target = directory / "dotfiles/window.toml", link = directory / "window.toml";
  std::ofstream(target) << "old";
  REQUIRE(chmod(target.c_str(), 0600) == 0);
  fs::create_symlink("dotfiles/window.toml", directory / "second.toml");
  fs::create_symlink("second.toml", link);
  local::replace_file(link, "new");
  CHECK(fs::is_symlink(link));
  CHECK(fs::is_symlink(directory / "second.toml"));
  CHECK(text_of(target) == "new");
  CHECK(mode_of(target) == 0600);
  CHECK(files_in(directory / "dotfiles") == 1);
  CHECK(files_in(directory.path()) == 3);
}

TEST_CASE("a new file has the mode that the user's mask allows") {
  const TemporaryDirectory directory;
  const mode_t before = umask(027);
  local::replace_file(directory / "new.toml", "new");
  umask(before);
  CHECK(mode_of(directory / "new.toml") == 0640);
}

TEST_CASE("a device or a pipe is written directly") {
  local::replace_file("/dev/null", "new");
  CHECK(fs::is_character_file("/dev/null"));
  CHECK_THROWS_AS(local::replace_file("/dev/full", "new"), std::system_error);
}

TEST_CASE("a full disk leaves the old file, and no other file") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.toml") << "old";
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      local::replace_file(directory / "a.toml", std::string(2000, 'x'));
    } catch (const std::system_error&) {
      _exit(42);
    }
    _exit(1);
  }
  int result = 0;
  waitpid(child, &result, 0);
  CHECK(WEXITSTATUS(result) == 42);
  CHECK(text_of(directory / "a.toml") == "old");
  CHECK(files_in(directory.path()) == 1);
}
