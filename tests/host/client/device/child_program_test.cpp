// Tests that no shell interprets the arguments of child programs, and that the output of these programs is returned.
#include <doctest/doctest.h>

#include <sys/stat.h>

#include <csignal>
#include <string>

#include "host/client/device/child_program.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using device::run_child_program;
using tests::contains;
using tests::message_of;

namespace {

struct Ended {
  int exit_code;
  std::string output;
};

Ended run(std::vector<std::string> words, const std::filesystem::path& folder = "/") {
  Ended ended{};
  ended.exit_code = run_child_program({.words = std::move(words), .folder = folder, .advice = "Do without it."},
                                      [&](std::string_view piece) { ended.output += piece; });
  return ended;
}

}  // namespace

TEST_CASE("a child program gets its arguments unchanged, its folder, and an empty standard input") {
  const tests::TemporaryDirectory directory;
  const std::string marker = directory.file("marker");
  const auto printed =
      run({"printf", "%s|", "two words", "`touch " + marker + "`", "$(touch " + marker + ")", "'; \""});
  CHECK(printed.exit_code == 0);
  CHECK(printed.output == "two words|`touch " + marker + "`|$(touch " + marker + ")|'; \"|");
  CHECK_FALSE(std::filesystem::exists(marker));
  CHECK(run({"pwd", "-P"}, directory.path()).output == std::filesystem::canonical(directory.path()).string() + "\n");
  CHECK(run({"cat"}).output.empty());
}

TEST_CASE("a child program's errors, exit code and signal come back, and one that is missing is a sentence") {
  const auto failed = run({"ls", "/no such file"});
  CHECK(failed.exit_code != 0);
  CHECK(contains(failed.output, "no such file"));
  CHECK(run({"sh", "-c", "exit 7"}).exit_code == 7);
  CHECK(run({"sh", "-c", "kill -TERM $$"}).exit_code == 128 + SIGTERM);
  CHECK(run({"sh", "-c", "head -c 300000 /dev/zero"}).output.size() == 300'000);
  const auto said = message_of<device::Error>([] { run({"no-such-program"}); });
  CHECK(contains(said, "no-such-program cannot be started: "));
  CHECK(contains(said, ". Do without it."));
}

TEST_CASE("a private folder is empty, belongs to this user only, and is removed with its files") {
  std::filesystem::path path;
  {
    const auto folder = device::make_private_folder();
    path = folder.path();
    struct stat about {};
    REQUIRE(stat(path.c_str(), &about) == 0);
    CHECK((about.st_mode & 0777) == 0700);
    CHECK(std::filesystem::is_empty(path));
    run({"touch", "file"}, path);
    CHECK(std::filesystem::exists(path / "file"));
  }
  CHECK_FALSE(std::filesystem::exists(path));
}
