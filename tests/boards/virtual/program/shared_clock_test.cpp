// Several virtual boards with a shared clock.
#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "boards/virtual/program/shared_clock.hpp"
#include "tests/temporary_directory.hpp"

namespace inkwell::tests {
namespace {

using virtual_board::SharedClock;

TEST_CASE("a board waits indefinitely for boards with an earlier time, but not for boards that have exited") {
  const TemporaryDirectory directory;
  const auto file = directory / "clock";
  SharedClock first(file);
  first.note(40);
  CHECK(first.lets_pass());  // this board is the only board
  {
    SharedClock second(file);  // starts at the time of the first board
    CHECK(first.lets_pass());
    first.note(41);
    CHECK_FALSE(first.lets_pass());
    CHECK(second.lets_pass());
    second.note(1);
    CHECK(first.lets_pass());
    second.note(2);
    CHECK_FALSE(second.lets_pass());
    CHECK(first.lets_pass());
    first.note(43);
  }
  CHECK(first.lets_pass());
}

TEST_CASE("a board whose process was killed holds up no other, and its slot is free again") {
  const TemporaryDirectory directory;
  const auto file = directory / "clock";
  SharedClock first(file);
  int joined[2];
  REQUIRE(pipe(joined) == 0);
  const pid_t other = fork();
  if (other == 0) {
    const SharedClock second(file);
    [[maybe_unused]] const auto written = write(joined[1], "", 1);
    for (;;) pause();
  }
  char byte = 0;
  REQUIRE(read(joined[0], &byte, 1) == 1);
  close(joined[0]);
  close(joined[1]);
  first.note(1);
  CHECK_FALSE(first.lets_pass());
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  CHECK(first.lets_pass());
  std::vector<std::unique_ptr<SharedClock>> others;
  for (std::size_t i = 1; i < SharedClock::boards_maximum; ++i) others.push_back(std::make_unique<SharedClock>(file));
  CHECK_THROWS_WITH_AS(SharedClock{file}, doctest::Contains("16 boards use the clock"), std::runtime_error);
}

TEST_CASE("a file that is not a clock is not changed") {
  const TemporaryDirectory directory;
  const auto file = directory / "notes";
  std::ofstream(file) << "mine";
  CHECK_THROWS_WITH_AS(SharedClock{file}, doctest::Contains("the file is not a clock"), std::runtime_error);
  std::string content;
  std::ifstream(file) >> content;
  CHECK(content == "mine");
  CHECK_THROWS_AS(SharedClock{directory / "missing/clock"}, std::runtime_error);
}

}  // namespace
}  // namespace inkwell::tests
