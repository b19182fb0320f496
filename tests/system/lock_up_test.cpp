// After a core lock-up, a board with --seconds stops and reports the location of the error.
#include <doctest/doctest.h>

#include "host/client/device/control_client.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
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

TEST_CASE("a processor that is locked up cannot be led astray") {
  const device::VirtualBoard board({.elf = build_directory() + "/chip-firmware/lock_up.elf", .paused = true});
  device::ControlClient control = board.control();
  CHECK_NOTHROW(control.inject({.fault = "program_astray", .of = "0x08000200", .after_s = 1.0}));
  CHECK_THROWS_WITH_AS(control.run(0.01), doctest::Contains("locked up"), device::Error);
  REQUIRE(control.status().all.contains("locked_up"));
  CHECK_THROWS_WITH_AS(control.inject({.fault = "program_astray", .of = "0x08000200"}),
                       doctest::Contains("the processor is locked up; reset the board first"), device::Error);
  CHECK_NOTHROW(control.inject({.fault = "motor_open", .of = "1"}));
}
