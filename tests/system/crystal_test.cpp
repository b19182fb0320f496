// Tests a board with a crystal of the wrong frequency.
#include <doctest/doctest.h>

#include "tests/system/program.hpp"

using namespace inkwell::tests;

TEST_CASE("--crystal sets the input frequency of the PLL") {
  const std::string elf = build_directory() + "/chip-firmware/input_output.elf";
  const auto as_built = run_program("virtual-board", {"--elf", elf, "--seconds", "0.002"});
  CAPTURE(as_built.err);
  CHECK(as_built.exit_code == 0);
  CHECK(as_built.err.find("PLL") == std::string::npos);
  const auto twice = run_program("virtual-board", {"--elf", elf, "--seconds", "0.002", "--crystal", "16000000"});
  CAPTURE(twice.err);
  CHECK(twice.err.find("RCC_PLLCFGR") != std::string::npos);
  CHECK(run_program("virtual-board", {"--elf", elf, "--crystal", "32768"}).exit_code == 2);
}
