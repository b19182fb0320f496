// Reading and driving pins of the virtual board through its control socket.
#include <doctest/doctest.h>

#include "host/client/device/control_client.hpp"
#include "host/client/device/error.hpp"
#include "host/client/device/virtual_board.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

TEST_CASE("a pin has the level that the chip drives, and the chip reads a level that is driven from outside") {
  const device::VirtualBoard board({.elf = build_directory() + "/chip-firmware/input_output.elf", .paused = true});
  auto control = board.control();
  CHECK(control.pin("PC10").chip_drives == "floating");
  // The firmware drives PC10 high. After the flash erase, interrupt 40 counts falling edges of PB13.
  control.run(0.3);
  CHECK(control.pin("PC10").chip_drives == "high");
  CHECK(control.pin("PC10").level == "high");
  CHECK(control.drive_pin("PB13", "high").level == "high");
  CHECK(control.pin("PB13").chip_drives == "floating");
  control.run(0.0001);
  const auto interrupts = [&] {
    const auto longest = control.status().all.at("longest_interrupt");
    return longest.at("exception") == 16 + 40 && longest.at("cycles") > 0;
  };
  CHECK_FALSE(interrupts());
  CHECK(control.drive_pin("PB13", "low").level == "low");
  control.run(0.0001);
  CHECK(interrupts());
  CHECK(control.drive_pin("PB13", "floating").level == "high");  // pull-up
}

TEST_CASE("an invalid pin or pin level is refused with a sentence") {
  const device::VirtualBoard board({.elf = build_directory() + "/chip-firmware/input_output.elf", .paused = true});
  auto control = board.control();
  CHECK_THROWS_WITH_AS(control.pin("PA16"), doctest::Contains("\"PA16\" is not a pin"), device::Error);
  CHECK_THROWS_WITH_AS(control.pin(""), doctest::Contains("is not a pin"), device::Error);
  CHECK_THROWS_WITH_AS(control.drive_pin("PA1", "up"), doctest::Contains("\"high\", \"low\" or \"floating\""),
                       device::Error);
}
