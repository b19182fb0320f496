// Firmware that locks the processor up: a run in the background ends, and says where it went wrong.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace inkwell::tests;

TEST_CASE("with --seconds a lock-up ends the virtual board with exit code 3 and the way to the first fault") {
  const auto result =
      run_program("virtual-board", {"--elf", build_directory() + "/chip-firmware/lock_up.elf", "--seconds", "0.01"});
  CAPTURE(result.err);
  CHECK(result.exit_code == 3);
  for (const char* part : {"locked up", "0x60000000", "read_too_far", "sum_up"})
    CHECK(result.err.find(part) != std::string::npos);
}

TEST_CASE("with --seconds a watchdog still ends a lock-up") {
  const auto result = run_program(
      "virtual-board", {"--elf", build_directory() + "/chip-firmware/lock_up_watched.elf", "--seconds", "0.1"});
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.find("locked up") != std::string::npos);
  CHECK(result.err.find("watchdog") != std::string::npos);
}
