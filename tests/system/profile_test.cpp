// Tests the instruction profile of the longest interrupt, and the flame graph of this profile.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "boards/omni_driver/facts.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

TEST_CASE("a profile holds the whole control interrupt, and tools/docs/flame-graph draws it") {
  const TemporaryDirectory directory;
  const std::string elf = build_directory() + "/../board/inkwell.elf", profile = directory.file("profile");
  const auto board = run_program("virtual-board", {"--elf", elf, "--seconds", "0.1", "--profile", profile});
  CAPTURE(board.err);
  REQUIRE(board.exit_code == 0);
  unsigned long cycles = 0, count = 0, instructions = 0;
  std::string address;
  for (std::ifstream lines(profile); lines >> address >> count; ++instructions) cycles += count;
  CHECK(instructions > 500);
  CHECK(cycles > instructions / 2);  // an IT instruction may take no cycle
  CHECK(cycles < board::servo_cycles);

  const std::string tool = build_directory() + "/../../tools/docs/flame-graph", picture = directory.file("picture.svg");
  REQUIRE(run_program(tool, {elf, profile, picture}).exit_code == 0);
  unsigned long drawn = 0;
  std::string stack;
  for (std::ifstream lines(directory.file("picture.folded")); std::getline(lines, stack);) {
    CHECK(stack.starts_with("control_interrupt"));
    drawn += std::stoul(stack.substr(stack.rfind(' ')));
  }
  CHECK(drawn == cycles);
}
