// From the flashed firmware to the boot loader in the chip, and back.
#include <doctest/doctest.h>

#include <string>

#include "firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

TEST_CASE("a detach request starts the chip's boot loader, and a reset the firmware again") {
  FirmwareOnBus bus(flashed_image());
  std::string said;
  bus.chip.on_console = [&](std::uint8_t character) { said += static_cast<char>(character); };
  bus.connect();
  bus.run_for(0.05);
  said.clear();
  constexpr std::uint8_t detach_type = 0x21, detach = 0;
  CHECK(bus.control(detach_type, detach, 1000, 3, 0).status == 0);
  bus.run_for(0.01);
  CHECK(said.find("started the chip's boot loader") != std::string::npos);
  CHECK(bus.violations().empty());
  bus.chip.reset();
  bus.connect();
  CHECK(bus.violations().empty());
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
